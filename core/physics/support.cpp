#include "physics/support.h"

#include <algorithm>
#include <cmath>

#include "physics/colliders/shapes.h"
#include "physics/path.h"

namespace weft::physics {
namespace {

constexpr double kRounding = 1e-6;  // m, and of the distance from zero
constexpr double kAtRest = 1e-2;    // of what a substep adds to the velocity into the surface

// What is left of an acceleration `a` into a surface with normal n.
Vec3 supported(const Friction& friction, const Vec3& a, const Vec3& n) {
  const double into = dot(a, n);
  const Vec3 along = minus(a, times(n, into));
  if (friction.model == FrictionModel::course) return times(along, 1 - friction.dynamic);
  const double size = std::sqrt(dot(along, along));
  if (size <= friction.statik * -into) return {};
  return times(along, std::max(0.0, 1 + friction.dynamic * into / size));
}

}  // namespace

void support(const Scene& scene, double time, double dt, const Lattice& l, std::vector<Vec3>& a) {
  for (const Collider& c : scene.colliders) {
    if (c.cuts) continue;
    const Vec3 place = c.keys.empty() ? place_of(c.shape) : position_at(c.keys, time);
    const Vec3 u = c.keys.empty() ? Vec3{} : velocity_over(c.keys, time, dt);
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i) {
        if (l.w(j, i) <= 0) continue;
        const auto now = [&](const Rows& rows) {
          return Vec3{rows.at(0, j, i), rows.at(1, j, i), rows.at(2, j, i)};
        };
        const Vec3 x = now(l.x);
        const Nearest nearest = std::visit(
            [&](const auto& shape) { return nearest_of(shape, minus(x, place)); }, c.shape);
        Vec3& own = a[std::size_t(j) * l.columns + i];
        // A substep ends on the surface, or off a curved one by what it went into it before.
        const double gained = -dot(own, nearest.normal) * dt;
        const double rounding =
            kRounding * std::max({1.0, std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
        const double off = std::abs(dot(minus(now(l.v), u), nearest.normal));
        if (gained > 0 && nearest.distance < c.offset + rounding + gained * dt &&
            off <= kAtRest * gained)
          own = supported(c.friction, own, nearest.normal);
      }
  }
}

}  // namespace weft::physics
