// Collider tapered capsule: the convex hull of two balls, of radius R about the end a and of R + g about b.
// The normal at its side leans to the smaller ball by k = -g/|e|, so that the ball through whose centre it runs
// is
//   t = clamp((p·e - k/√(1-k²) |e| |p - e p·e/|e|²|)/|e|², 0, 1),  e = b - a
//   d(p) = |p - t e| - (R + t g),  n = (p - t e)/|p - t e|
// On the segment itself, to rounding, n is one normal of the side.
#include "physics/kernels/colliders.h"

namespace weft::physics {
namespace {

struct TaperedNumbers {
  float from[3], axis[3];  // the first ball; from there to the second [m]
  float inverse_square;    // 1/|axis|² [1/m²]
  float lean;              // k/(√(1-k²) |e|) [1/m]
  float radius, growth;    // R, g [m]
  float aside[3];          // a unit normal of the side
};

}  // namespace
}  // namespace weft::physics

#ifdef WEFT_LANES

#include "physics/kernels/collide_faces.h"

namespace weft::WEFT_KERNELS {
namespace {

struct TaperedSurface {
  static constexpr bool kFlat = false;
  explicit TaperedSurface(const physics::ShapeConstants& c) {
    const auto own = c.get<physics::TaperedNumbers>();
    from = wide3(own.from[0], own.from[1], own.from[2]);
    axis = wide3(own.axis[0], own.axis[1], own.axis[2]);
    inverse_square = wide(own.inverse_square);
    lean = wide(own.lean);
    radius = wide(own.radius);
    growth = wide(own.growth);
    aside = wide3(own.aside[0], own.aside[1], own.aside[2]);
  }
  WEFT_INLINE Surface at(Wide3 p) const {
    const Wide3 d = p - from;
    const Wide along = dot(d, axis) * inverse_square;
    const Wide3 radial = fnma(axis, along, d);
    const Wide t = min(max(fnma(sqrt(dot(radial, radial)), lean, along), Wide{}), wide(1));
    return around(fnma(axis, t, d), fma(growth, t, radius), rounding_across(d), aside);
  }
  Wide3 from, axis, aside;
  Wide inverse_square, lean, radius, growth;
};

}  // namespace
WEFT_COLLIDER(kTaperedCapsule, TaperedSurface)
}  // namespace weft::WEFT_KERNELS

#else

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/contact/colliders/least_overlap.h"

namespace weft::physics {
namespace {

// The hull, seen from a. Of two balls of which one holds the other, that one twice.
struct Hull {
  Vec3 from{}, axis{};
  double radius, growth = 0;
  double inverse_square = 0, lean = 0;
  double rise = 0;      // of the side's normal above the plane across the axis [rad]
  Vec3 aside{0, 1, 0};  // one such normal

  explicit Hull(const TaperedCapsule& c) : radius(std::max(c.radius_a, c.radius_b)) {
    const Vec3 e = minus(c.b, c.a);
    const double square = dot(e, e), length = std::sqrt(square), change = c.radius_b - c.radius_a;
    if (std::abs(change) >= length) {
      if (change > 0) from = e;
      return;
    }
    axis = e;
    radius = c.radius_a;
    growth = change;
    inverse_square = 1 / square;
    rise = std::asin(-change / length);
    lean = std::tan(rise) / length;
    const Vec3 along = times(e, 1 / length);
    aside = plus(times(across(along)[0], std::cos(rise)), times(along, std::sin(rise)));
  }
  double least() const { return std::min(radius, radius + growth); }
};

// The centre of the ball that p is nearest to, and its radius.
Core ball_near(const Hull& hull, const Vec3& p) {
  const Vec3 d = minus(p, hull.from);
  const double along = dot(d, hull.axis) * hull.inverse_square;
  const Vec3 radial = minus(d, times(hull.axis, along));
  const double t = std::clamp(along - hull.lean * length(radial), 0.0, 1.0);
  return {plus(hull.from, times(hull.axis, t)), hull.radius + t * hull.growth};
}

Nearest nearest_of(const Hull& hull, const Vec3& p) {
  const Core ball = ball_near(hull, p);
  const Vec3 d = minus(p, ball.nearest);
  if (is_rounding(d, minus(p, hull.from))) return {-ball.radius, hull.aside};
  const double length = std::hypot(d[0], d[1], d[2]);
  return {length - ball.radius, times(d, 1 / length)};
}

// The point of the core that lies furthest along `way`.
Vec3 furthest(const Hull& hull, const Vec3& way) {
  const double size = length(way);
  const double reach = hull.radius - hull.least(), reach_b = reach + hull.growth;
  const bool second = dot(hull.axis, way) + hull.growth * size > 0;
  const Vec3 center = second ? plus(hull.from, hull.axis) : hull.from;
  return size > 0 ? plus(center, times(way, (second ? reach_b : reach) / size)) : center;
}

}  // namespace

ShapeConstants constants_of(const TaperedCapsule& capsule) {
  const Hull hull(capsule);
  ShapeConstants c;
  c.radius = float(hull.least());
  c.thin = float(capsule.half_thickness());
  TaperedNumbers own{};
  own.inverse_square = float(hull.inverse_square);
  own.lean = float(hull.lean);
  own.radius = float(hull.radius);
  own.growth = float(hull.growth);
  for (int k = 0; k < 3; ++k) {
    own.from[k] = float(hull.from[k]);
    own.axis[k] = float(hull.axis[k]);
    own.aside[k] = float(hull.aside[k]);
  }
  c.set(own);
  return c;
}

Nearest nearest_of(const TaperedCapsule& capsule, const Vec3& p) {
  return nearest_of(Hull(capsule), p);
}

// The core is the hull of the balls less the smaller one's radius: a cone from a point to a ball.
Core core_of(const TaperedCapsule& capsule, const Vec3& p) {
  const Hull hull(capsule);
  const Nearest n = nearest_of(hull, p);
  return {minus(p, times(n.normal, std::max(n.distance + hull.least(), 0.0))), hull.least()};
}

Vec3 support_of(const TaperedCapsule& capsule, const Vec3& way) {
  return furthest(Hull(capsule), way);
}

// Above a corner one direction alone can be the least.
Overlap overlap_of(const TaperedCapsule& capsule, const Triangle& t) {
  const Hull hull(capsule);
  LeastOverlap least(t, [&](const Vec3& way) { return furthest(hull, way); });
  for (const Vec3& corner : t) least.towards(nearest_of(hull, corner).normal);
  least.across_edges();
  return least.found();
}

double feature_of(const TaperedCapsule& capsule) {
  return Hull(capsule).least();
}

ShapeMesh mesh_of(const TaperedCapsule& capsule) {
  const Hull hull(capsule);
  const bool ball = hull.inverse_square == 0;
  const Vec3 along = ball ? Vec3{0, 1, 0} : times(hull.axis, std::sqrt(hull.inverse_square));
  const auto [s, t] = across(along);
  constexpr int kCap = 16;  // rings of each cap; one more band joins the two
  constexpr double kQuarter = std::numbers::pi / 2;
  const auto normal = [&, s = s, t = t](double u, double v) {
    const double ring = v * (2 * kCap + 1);
    const double rise = ring <= kCap
                            ? -kQuarter + (hull.rise + kQuarter) * ring / kCap
                            : hull.rise + (kQuarter - hull.rise) * (ring - 1 - kCap) / kCap;
    const double turn = 2 * std::numbers::pi * u;
    return plus(times(along, std::sin(rise)),
                times(plus(times(s, std::cos(turn)), times(t, std::sin(turn))), std::cos(rise)));
  };
  ShapeMesh mesh;
  add_patch(
      mesh, 48, 2 * kCap + 1,
      [&](double u, double v) {
        const double end = v > 0.5 ? 1 : 0;
        return plus(plus(hull.from, times(hull.axis, end)),
                    times(normal(u, v), hull.radius + end * hull.growth));
      },
      normal);
  return mesh;
}

}  // namespace weft::physics

#endif
