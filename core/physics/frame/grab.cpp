// Stage "grab": a particle is drawn to a target by a critically damped spring, taken implicitly, so
// that any stiffness is stable. It is never much stiffer than the cloth's own links, nor stronger
// than they are at twice their length, so that the substeps can follow what it does to them:
//
//   Δv = dt w (k (target - x - dt v) - c v)/(1 + dt² w k + dt w c),  c = 2 √(k/w)
#include "physics/frame/grab.h"

#include <algorithm>
#include <cmath>

#include "physics/model/push.h"
#include "physics/step/keeper.h"

namespace weft::physics {

constexpr double kStiffer = 4;  // than the cloth's links, at most

double Grab::held_stiffness() const {
  const double stiffest = parts_.model.pull().stiffness;
  return stiffest > 0 ? std::min(stiffness, kStiffer * stiffest) : stiffness;
}

void Grab::keep(Keeper& keeper) {
  keeper(place);
  keeper(target);
  keeper(stiffness);
}

double Grab::energy() const {
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const double e = target[k] - parts_.particles.x.at(k, place.j, place.i);
    square += e * e;
  }
  return 0.5 * held_stiffness() * square;
}

void Grab::run(int j, const Substep& s) {
  if (j != place.j) return;
  Particles& p = parts_.particles;
  const double w = p.w(j, place.i), dt = push_time(parts_, s.dt);
  if (w <= 0) return;
  const double strongest = parts_.model.pull().force;
  const double k_held = held_stiffness();
  const double c = 2 * std::sqrt(k_held / w);
  const double share = dt * w / (1 + dt * dt * w * k_held + dt * w * c);
  double gains[3], square = 0;
  for (int k = 0; k < 3; ++k) {
    const double x = p.x.at(k, j, place.i), v = p.v.at(k, j, place.i);
    gains[k] = share * (k_held * (target[k] - x - dt * v) - c * v);
    square += gains[k] * gains[k];
  }
  const double most = strongest > 0 ? dt * w * strongest : 1e300;
  const double cut = std::min(1.0, most / std::max(std::sqrt(square), 1e-300));
  for (int k = 0; k < 3; ++k) {
    float &x = p.x.at(k, j, place.i), &v = p.v.at(k, j, place.i);
    const double gained = cut * gains[k];
    v = float(v + gained);
    x = float(x + dt * gained);
  }
}

}  // namespace weft::physics
