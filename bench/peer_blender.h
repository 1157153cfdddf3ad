// Blender's cloth on one sheet, run headless by a script of its own (bench/blender_cloth.py).
#pragma once

#include <string>
#include <vector>

#include "weft/scene.h"

namespace bench {

// Frames that a run is cut into, and substeps of each, 1 … 64, a power of two (Blender calls them quality steps).
struct BlenderSetting {
  int frames = 16, substeps = 16;
};

struct BlenderRun {
  double ms = 0;                  // of stepping through all frames, without start and setup
  std::vector<double> positions;  // x,y,z in scene order; empty where Blender gave none
};

// Why there is no Blender to run; "" when there is one.
std::string without_blender();

// The first cloth of the scene, a grid of springs with pins that hold or turn, at most one ball, after `seconds`;
// a run for each setting. Throws std::runtime_error where Blender fails.
std::vector<BlenderRun> run_blender(const weft::Scene& scene, double seconds,
                                    const std::vector<BlenderSetting>& settings);

}  // namespace bench
