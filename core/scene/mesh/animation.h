// Animations of bodies: read, and checked.
#pragma once

#include "scene/validate.h"
#include "weft/mesh.h"

namespace weft::text {

// Whether the motion of a body, which is read, can be that of its mesh: counts, size, edges, in every sample.
std::optional<Fault> fault_of_motion(const MeshBody& body, const std::string& place);

// Reads the animation of a body whose mesh is read; false where it is faulty. `place`: in the scene.
bool read_motion(const std::string& name, const std::string& folder, MeshBody& body,
                 const std::string& place, std::vector<Fault>& faults,
                 std::vector<std::string>& notes);

// What is wrong with the animation of a collider.
void check_animation(const Collider& collider, const std::string& place, Check& result);

}  // namespace weft::text
