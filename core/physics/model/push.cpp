// How forces and corrections reach velocities (push.h).
#include "physics/model/push.h"

#include <algorithm>

#include "physics/model/path.h"

namespace weft::physics {

float velocity_gain(const Solver& solver, double dt) {
  return float(1 / (dt * implicit_share(solver)));
}

double push_time(const ClothParts& parts, double dt) {
  return is_explicit(parts.method) ? dt : dt * implicit_share(parts.scene.solver);
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
          float(g[2] * s.kick),
          float(std::min(1.0, s.kick * parts.cloth.drag))};
}

}  // namespace weft::physics
