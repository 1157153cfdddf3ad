// How forces and corrections reach velocities (push.h).
#include "physics/model/push.h"

#include <algorithm>

#include "physics/model/path.h"

namespace weft::physics {

bool velocity_from_positions(const Solver& solver, double dt) {
  // Rounding of a position of 1 m over 0.5 ms is 1e-4 m/s, two percent of what gravity adds. Measured:
  // no error gained down to here; at 0.26 ms none on hanging sheets, but cantilevers miss the elastica.
  constexpr double kLeastSubstep = 5e-4;  // s
  return solver.sweep == Sweep::line && dt >= kLeastSubstep;
}

float velocity_gain(const Solver& solver, double dt) {
  if (velocity_from_positions(solver, dt)) return 0;
  return float(1 / (dt * implicit_share(solver)));
}

Push push_of(const ClothParts& parts, double dt) {
  const Solver& solver = parts.scene.solver;
  if (is_explicit(parts.method)) return {dt, true};
  return {dt * implicit_share(solver), !velocity_from_positions(solver, dt)};
}

double implicit_share(const Solver& solver) {
  return solver.order == 2 ? 2.0 / 3.0 : 1.0;
}

Advance advance_of(const ClothParts& parts, const Substep& s) {
  // Explicit forces are those at the start of the substep, where they are symmetric about the velocity.
  const double back = is_explicit(parts.method) ? s.dt : s.dt / 2;
  const Vec3 g = gravity_at(parts.scene, s.time - back);
  return {float(s.dt),
          float(s.kick),
          float(std::max(0.0, 1 - s.kick * parts.cloth.drag)),
          float(g[0] * s.kick),
          float(g[1] * s.kick),
          float(g[2] * s.kick)};
}

}  // namespace weft::physics
