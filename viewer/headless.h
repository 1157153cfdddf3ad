// One picture without a window.
#pragma once

#include "command_line.h"

namespace weft::viewer {

// Simulates to the frame asked for and writes its picture. Throws Failure.
void render_picture(const Arguments& arguments);

// The path or name of the scene asked for; the first shipped one where none is.
std::string scene_name(const Arguments& arguments);

// The scene of the arguments; throws Failure that names every fault.
SceneFile load_scene(const Arguments& arguments);

// How the scene is seen, as the arguments ask, else as the scene says.
Sight sight_of(const Arguments& arguments, const Scene& scene);
// Turns the camera so, and frames the bounds.
void aim(const Sight& sight, const Bounds& bounds, float aspect, float clear, Camera& camera);

}  // namespace weft::viewer
