// Random scenes of two to five free sheets that meet, and whether they keep the laws of contact: linear
// and angular momentum are kept, energy is not gained, nothing passes through. Every feature that bears
// on contact is drawn at once: mode, method, order, sizes, places, thickness, speed, friction.
#pragma once

#include <cstdint>
#include <string>

#include "weft/scene.h"

namespace bench {

// The scene of a number, the same on every machine. Sheets lie above each other, clear of each other,
// turned and tilted at random; `velocity` of each has them meet.
weft::Scene random_meeting(std::uint64_t number);

// Method, mode, thickness, speed and friction of such a scene, in one line.
std::string meeting_name(const weft::Scene& scene);

// What came of it. Parts of the start's energy, of Σ m |v| and of Σ m |v| times the greatest side; greatest
// of all frames.
struct Meeting {
  bool finite = true;    // and the simulation's status is ok
  bool clamped = false;  // whether motion was cut so that nothing passes
  bool met = false;      // whether impulses were given
  double gain = 0;       // of energy; of motion alone where the method projects
  double linear = 0;     // change of momentum
  double angular = 0;    // change of angular momentum
  double strain = 0;     // of structural constraints
  std::int64_t crossings = 0;
};
Meeting run_meeting(const weft::Scene& scene, int threads);

// The bounds of docs/accuracy.md that it breaks, each with its figure; empty where it keeps them.
std::string broken_laws(const weft::Scene& scene, const Meeting& meeting);

}  // namespace bench
