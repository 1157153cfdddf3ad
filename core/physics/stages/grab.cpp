// Stage "grab": a particle is drawn to a target by a critically damped spring, taken implicitly, so
// that any stiffness is stable:
//
//   Δv = dt w (k (target - x - dt v) - c v)/(1 + dt² w k + dt w c),  c = 2 √(k/w)
#include "physics/stages/grab.h"

#include <cmath>

namespace weft::physics {

void Grab::run(int j, const Substep& s) {
  if (j != row) return;
  Lattice& l = parts_.lattice;
  const double w = l.w(row, column), dt = s.dt;
  if (w <= 0) return;
  const double c = 2 * std::sqrt(stiffness / w);
  const double share = dt * w / (1 + dt * dt * w * stiffness + dt * w * c);
  for (int k = 0; k < 3; ++k) {
    float &x = l.x.at(k, row, column), &v = l.v.at(k, row, column);
    const double gained = share * (stiffness * (target[k] - x - dt * v) - c * v);
    v = float(v + gained);
    x = float(x + dt * gained);
  }
}

}  // namespace weft::physics
