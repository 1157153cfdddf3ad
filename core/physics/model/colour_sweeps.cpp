#include "physics/model/colour_sweeps.h"

#include "physics/model/remainders.h"

namespace weft::physics {
namespace {

// Substeps that take little of what moves [s], and from which rate dt² what they solve is stiff.
struct Limits {
  double substep, stiff;
};
// Of the second order, measured on 150 sheets and meshes: in two seconds, 2 to 5 sweeps that go one way make more than a
// tenth of the motion at 5 and above in substeps of 1/1920 s and below, in others hardly any; one sweep does from 2 on.
constexpr Limits kSecond{6e-4, 3}, kSecondAlone{6e-4, 1};
// Of the first, where one sweep keeps no multipliers, at 0.9 in substeps of 1e-5 s, not at 0.3.
constexpr Limits kFirst{Remainders::kFine, 0.3};

}  // namespace

ColourSweeps colour_sweeps(const Solver& solver, double dt, double rate) {
  const bool first = solver.order == 1, alone = solver.iterations == 1;
  const Limits& limits = first ? kFirst : alone ? kSecondAlone : kSecond;
  const bool back = dt < limits.substep && rate * dt * dt > limits.stiff;
  const int odd = back && (first || alone) ? solver.iterations % 2 : 0;
  return {solver.iterations + odd, back};
}

void note_sweeps(const ColourSweeps& sweeps, const Solver& solver,
                 std::vector<std::string>& notes) {
  if (sweeps.count == solver.iterations) return;
  notes.push_back(
      "an odd number of gauss_seidel sweeps over what is this stiff makes motion in substeps this "
      "short; " +
      std::to_string(sweeps.count) + " run in place of " + std::to_string(solver.iterations));
}

}  // namespace weft::physics
