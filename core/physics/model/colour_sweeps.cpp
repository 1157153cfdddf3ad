#include "physics/model/colour_sweeps.h"

#include <algorithm>

#include "physics/model/remainders.h"

namespace weft::physics {
namespace {

// By the method's order: substeps that take little of what moves [s], and from which rate dt² what they solve is stiff.
// Measured on 150 sheets and meshes of the second order: in two seconds, 2 to 5 sweeps make more than a tenth of the
// motion at 5 and above in substeps of 1/1920 s and below, in others hardly any. Of the first order, where one sweep
// keeps no multipliers, at 0.9 in substeps of 1e-5 s, not at 0.3.
struct Limits {
  double substep, stiff;
};
constexpr Limits kFirst{Remainders::kFine, 0.3}, kSecond{6e-4, 3};

}  // namespace

// Of the second order, one sweep stays one. (Automatic substeps are fine only where frames are.)
ColourSweeps colour_sweeps(const Scene& scene, double rate) {
  const Solver& solver = scene.solver;
  const Limits& limits = solver.order == 2 ? kSecond : kFirst;
  const double dt = scene.time.frame / std::max(scene.time.substeps, 1);
  const bool back = dt < limits.substep && rate * dt * dt > limits.stiff;
  return {solver.iterations + (back && solver.order == 1 ? solver.iterations % 2 : 0), back};
}

}  // namespace weft::physics
