// What a run of a scene needs, told before it starts. The figures are rough: memory within a factor
// of 1.5, time within a factor of three on a machine of 2020 or later with AVX2 or AVX-512. How much
// contact there will be, and what the energy guard will ask for, nobody knows ahead.
#pragma once

#include <cstdint>
#include <string>

#include "weft/scene.h"

namespace weft {

class Simulation;  // weft/simulation.h

struct Estimate {
  std::int64_t particles = 0;
  std::int64_t constraints = 0;
  int substeps = 0;          // a frame, as the run begins
  double bytes = 0;          // the most that the program takes while it simulates
  double frame_seconds = 0;  // wall time of a frame on one thread
  double frames = 0;         // of the scene's own length
  // Of a whole run of the scene's own length on one thread [s].
  double run_seconds() const { return frames * frame_seconds; }
};

inline constexpr double kMemoryWithin = 1.5;  // factor within which Estimate::bytes is right
inline constexpr double kTimeWithin = 3;      // the same of Estimate::frame_seconds

// Takes a moment however large the scene is: where springs give the substeps, it looks at a cutting
// of each cloth. Throws SceneError (weft/simulation.h) for a scene that a Simulation refuses.
Estimate estimate(const Scene& scene);

// The same of a simulation that is made and has not run: from its own substeps, which count where it is pinned.
Estimate estimate(const Simulation& simulation);

// "1.2 GB", "850 MB"; of powers of ten.
std::string bytes_words(double bytes);

// "0.3 ms", "12 s", "5 min", "3 h", "9 days", "2.1 years".
std::string time_words(double seconds);

// Bytes that this process may still take: of what the system has free (swap included), what its
// control groups allow, and what is left of its own limit on address space, the least. Infinite
// where the system does not tell.
double free_memory();

}  // namespace weft
