// Collider capsule: all points within `radius` of the segment from a to b.
//   q = e clamp(p·e/|e|², 0, 1),  d(p) = |p - q| - r,  n = (p - q)/|p - q|,  e = b - a
#ifdef WEFT_LANES

#include "physics/kernels/collide.h"

namespace weft::WEFT_KERNELS {
namespace {

struct CapsuleSurface {
  static constexpr bool kFlat = false;
  explicit CapsuleSurface(const physics::ShapeConstants& c)
      : radius(wide(c.radius)),
        inverse_square(wide(c.inverse_square)),
        axis(wide3(c.axis[0], c.axis[1], c.axis[2])) {}
  WEFT_INLINE Surface at(Wide3 p) const {
    const Wide t = min(max(dot(p, axis) * inverse_square, Wide{}), wide(1));
    return around(fnma(axis, t, p), radius);
  }
  Wide radius, inverse_square;
  Wide3 axis;
};

}  // namespace
WEFT_COLLIDER(kCapsule, CapsuleSurface)
}  // namespace weft::WEFT_KERNELS

#else

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/contact/colliders/shapes.h"

namespace weft::physics {

ShapeConstants constants_of(const Capsule& capsule) {
  const Vec3 e = minus(capsule.b, capsule.a);
  ShapeConstants c;
  c.radius = float(capsule.radius);
  c.thin = c.radius;
  for (int k = 0; k < 3; ++k) c.axis[k] = float(e[k]);
  c.inverse_square = float(1 / dot(e, e));
  return c;
}

Vec3 place_of(const Capsule& capsule) {
  return capsule.a;
}

void move(Capsule& capsule, const Vec3& by) {
  capsule.a = plus(capsule.a, by);
  capsule.b = plus(capsule.b, by);
}

Core core_of(const Capsule& capsule, const Vec3& p) {
  const Vec3 e = minus(capsule.b, capsule.a);
  return {times(e, std::clamp(dot(p, e) / dot(e, e), 0.0, 1.0)), capsule.radius};
}

Nearest nearest_of(const Capsule& capsule, const Vec3& p) {
  const Vec3 d = minus(p, core_of(capsule, p).nearest);
  const double length = std::hypot(d[0], d[1], d[2]);
  return {length - capsule.radius, length > 0 ? times(d, 1 / length) : Vec3{0, 1, 0}};
}

Vec3 support_of(const Capsule& capsule, const Vec3& way) {
  const Vec3 e = minus(capsule.b, capsule.a);
  return dot(e, way) > 0 ? e : Vec3{};
}

// The axis cuts a triangle when its ends lie on both sides of it, and the point between inside. Out
// is the way of the end that is nearer.
Overlap overlap_of(const Capsule& capsule, const Triangle& t) {
  const Vec3 n = normal_of(t[0], t[1], t[2]);
  const double size = std::sqrt(dot(n, n));
  if (size == 0) return {};
  const Vec3 e = minus(capsule.b, capsule.a);
  const double at_a = -dot(t[0], n), at_b = dot(minus(e, t[0]), n);
  if (at_a * at_b >= 0) return {};
  const Vec3 q = times(e, at_a / (at_a - at_b));
  for (int k = 0; k < 3; ++k) {
    const Vec3 edge = minus(t[(k + 1) % 3], t[k]);
    if (dot(cross(edge, minus(q, t[k])), n) < 0) return {};
  }
  const double nearer = std::abs(at_a) < std::abs(at_b) ? at_a : at_b;
  return {std::abs(nearer) / size, times(n, (nearer > 0 ? 1 : -1) / size)};
}

double feature_of(const Capsule& capsule) {
  return capsule.radius;
}

ShapeMesh mesh_of(const Capsule& capsule) {
  const Vec3 e = minus(capsule.b, capsule.a);
  const Vec3 along = times(e, 1 / std::sqrt(dot(e, e)));
  const Vec3 axis = std::abs(along[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
  const Vec3 s0 = minus(axis, times(along, dot(axis, along)));
  const Vec3 s = times(s0, 1 / std::hypot(s0[0], s0[1], s0[2]));
  // s turned by a quarter about the axis: s, t and `along` are right-handed.
  const Vec3 t{along[1] * s[2] - along[2] * s[1], along[2] * s[0] - along[0] * s[2],
               along[0] * s[1] - along[1] * s[0]};
  constexpr int kCap = 16;  // rings of each cap; one more band joins the two
  const auto normal = [&](double u, double v) {
    const double ring = v * (2 * kCap + 1);
    const double step = ring <= kCap ? ring : ring - 1;
    const double rise = std::numbers::pi / 2 * (step / kCap - 1), turn = 2 * std::numbers::pi * u;
    return plus(times(along, std::sin(rise)),
                times(plus(times(s, std::cos(turn)), times(t, std::sin(turn))), std::cos(rise)));
  };
  ShapeMesh mesh;
  add_patch(
      mesh, 48, 2 * kCap + 1,
      [&](double u, double v) {
        const Vec3 off = times(normal(u, v), capsule.radius);
        return v > 0.5 ? plus(e, off) : off;
      },
      normal);
  return mesh;
}

}  // namespace weft::physics

#endif
