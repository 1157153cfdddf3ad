// The truth that errors are measured against: a double-precision integration of
//
//   m x'' = -∇E + m g - m·drag·x',   E = Σ ½ k (|xᵢ - xⱼ| - l)², or of a membrane, and of curvatures
//
// by velocity Verlet, written independently of the library (whole arrays, no rows in flight, no
// floats). The substep is halved until two successive runs agree; Verlet being of second order, a
// third of their distance is the error of the finer one. Pins move by their keys. Contact with fixed spheres and
// planes and Coulomb friction follow the law that the library's colliders converge to.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "weft/scene.h"

namespace bench {

struct Reference {
  std::vector<double> positions;  // x,y,z in scene order [m]
  double error = 0;               // m; RMS, estimated from the last halving of the substep
  std::int64_t steps = 0;         // of the finest run; 0 when rest was looked for
  double seconds = 0;             // s of wall time that it took to compute
  bool cached = false;            // read from the cache
};

// What the reference is asked for.
struct Question {
  weft::Scene scene;        // one cloth; see unsupported()
  double seconds = 0;       // s of motion
  bool at_rest = false;     // follow the motion for `seconds`, then go on to the equilibrium
  double tolerance = 1e-6;  // m; RMS error at which halving may stop
  int most_halvings = 5;    // and where it stops in any case
};

// Why the reference cannot integrate a scene; "" when it can.
std::string unsupported(const weft::Scene& scene);

// Computes, or reads from the folder `cache` what was computed before for the same question.
Reference reference(const Question& question, const std::string& cache);

struct Distance {
  double rms = 0;       // m, over particles
  double greatest = 0;  // m
};
Distance distance(const std::vector<double>& a, const std::vector<double>& b);

}  // namespace bench
