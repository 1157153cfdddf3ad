// Scene files with one body, and what is wrong with them.
#pragma once

#include <string>

#include "weft/read_scene.h"

namespace weft {

inline std::string scene_with(const std::string& collider) {
  return R"({"weft": 1, "cloths": [{"grid": {"points": [8, 8], "origin": [-0.5, 0.5, -0.5]}}],
             "colliders": [)" +
         collider + "]}";
}

inline std::string first_fault(const SceneFile& file) {
  return file.faults.empty() ? "" : file.faults[0].place + ": " + file.faults[0].what;
}

}  // namespace weft
