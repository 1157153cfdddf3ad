// Stage "grab": a particle is drawn to a target by a critically damped spring, taken implicitly, so
// that any stiffness is stable. It is never much stiffer than the cloth's own links, nor stronger
// than they are at twice their length, so that the substeps can follow what it does to them:
//
//   Δv = dt w (k (target - x - dt v) - c v)/(1 + dt² w k + dt w c),  c = 2 √(k/w)
#include "physics/stages/grab.h"

#include <algorithm>
#include <cmath>

namespace weft::physics {

constexpr double kStiffer = 4;  // than the cloth's links, at most

void Grab::run(int j, const Substep& s) {
  if (j != row) return;
  Lattice& l = parts_.lattice;
  const double w = l.w(row, column), dt = s.dt;
  if (w <= 0) return;
  double stiffest = 0, strongest = 0;  // N/m, N
  for (const Family& f : parts_.families) {
    stiffest = std::max(stiffest, f.stiffness);
    strongest = std::max(strongest, 2 * f.stiffness * f.rest);
  }
  const double k_held = stiffest > 0 ? std::min(stiffness, kStiffer * stiffest) : stiffness;
  const double c = 2 * std::sqrt(k_held / w);
  const double share = dt * w / (1 + dt * dt * w * k_held + dt * w * c);
  double gains[3], square = 0;
  for (int k = 0; k < 3; ++k) {
    const double x = l.x.at(k, row, column), v = l.v.at(k, row, column);
    gains[k] = share * (k_held * (target[k] - x - dt * v) - c * v);
    square += gains[k] * gains[k];
  }
  const double most = strongest > 0 ? dt * w * strongest : 1e300;
  const double cut = std::min(1.0, most / std::max(std::sqrt(square), 1e-300));
  for (int k = 0; k < 3; ++k) {
    float &x = l.x.at(k, row, column), &v = l.v.at(k, row, column);
    const double gained = cut * gains[k];
    v = float(v + gained);
    x = float(x + dt * gained);
  }
}

}  // namespace weft::physics
