// What meshes do not have, or not yet.
#pragma once

#include "scene/schema.h"
#include "weft/scene.h"

namespace weft::text {

// Adds a fault for each value of a cloth, which is a mesh, and of the scene about it that it cannot have.
// `place`: of the cloth.
void check_mesh(const Scene& scene, const Cloth& cloth, const std::string& place, Check& result);

}  // namespace weft::text
