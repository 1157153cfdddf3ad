// A strip that is clamped level at one end and hangs by its own weight: the elastica, by shooting.
#pragma once

#include <vector>

namespace bench {

struct Strip {
  double length = 1;     // m
  double weight = 1;     // N/m², of an area
  double rigidity = 1;   // N·m, of bending about the width
  double stretch = 1e9;  // N/m, C11: energy stretch e²/2 of Green's strain e
};

// Where the strip is at some of its points in the plane that it bends in: `along` from the clamp, and `up`.
struct StripPoint {
  double along = 0, up = 0;  // m
};

// The strip at rest at the material distances `s` from the clamp [m, ascending, at most the length]; below 0 it is
// straight and level. Its equilibrium is that of the energy
//   ∫ D λ² θ'² / 2 + C (λ² - 1)² / 8 - λ N·t ds,   N(s) = weight (length - s) downward,
// of the angle θ and the stretch λ (the energy of changes of stretch is left out: its share is of the square of
// the strain's boundary layer). θ'(0) is found by bisection so that the end bears no moment; for
// weight length³/rigidity up to 500: the way back from the end is long in boundary layers of the root.
std::vector<StripPoint> strip_at_rest(const Strip& strip, const std::vector<double>& s);

}  // namespace bench
