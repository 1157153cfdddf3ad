// The scenes that `scaling` runs.
#pragma once

#include <string>
#include <vector>

#include "weft/scene.h"

namespace bench {

// Gains that others have measured on more threads than this machine may have.
struct MeasuredElsewhere {
  int threads;
  double gain;
};

struct ScalingScene {
  std::string name, about;
  weft::Scene scene;
  int first = 1;                             // the frame that is looked at comes after so many
  double asked_16 = 0;                       // predicted gain on 16 threads; 0: none asked
  double asked_2 = 0;                        // measured on two
  std::vector<MeasuredElsewhere> elsewhere;  // on an Intel server of 16 cores, an older build
};

// `quick`: small ones alone.
std::vector<ScalingScene> scaling_scenes(bool quick);

}  // namespace bench
