// Collider capsule: all points within `radius` of the segment from a to b.
//   q = e clamp(p·e/|e|², 0, 1),  d(p) = |p - q| - r,  n = (p - q)/|p - q|,  e = b - a
// On the segment itself, to rounding, n is one direction across it.
#include "physics/kernels/colliders.h"

namespace weft::physics {
namespace {

struct CapsuleNumbers {
  float axis[3];         // from a to b [m]
  float inverse_square;  // 1/|axis|² [1/m²]
  float aside[3];        // a unit vector across
};

}  // namespace
}  // namespace weft::physics

#ifdef WEFT_LANES

#include "physics/kernels/collide_faces.h"

namespace weft::WEFT_KERNELS {
namespace {

struct CapsuleSurface {
  static constexpr bool kFlat = false;
  explicit CapsuleSurface(const physics::ShapeConstants& c) : radius(wide(c.radius)) {
    const auto own = c.get<physics::CapsuleNumbers>();
    inverse_square = wide(own.inverse_square);
    axis = wide3(own.axis[0], own.axis[1], own.axis[2]);
    aside = wide3(own.aside[0], own.aside[1], own.aside[2]);
  }
  WEFT_INLINE Surface at(Wide3 p) const {
    const Wide t = min(max(dot(p, axis) * inverse_square, Wide{}), wide(1));
    return around(fnma(axis, t, p), radius, rounding_across(p), aside);
  }
  Wide radius, inverse_square;
  Wide3 axis, aside;
};

}  // namespace
WEFT_COLLIDER(kCapsule, CapsuleSurface)
}  // namespace weft::WEFT_KERNELS

#else

#include <algorithm>
#include <cmath>

#include "physics/contact/colliders/least_overlap.h"

namespace weft::physics {
namespace {

// A unit vector across e.
Vec3 aside_of(const Vec3& e) {
  return across(times(e, 1 / std::sqrt(dot(e, e))))[0];
}

}  // namespace

ShapeConstants constants_of(const Capsule& capsule) {
  const Vec3 e = minus(capsule.b, capsule.a), aside = aside_of(e);
  ShapeConstants c;
  c.radius = float(capsule.radius);
  c.thin = float(capsule.half_thickness());
  c.set(CapsuleNumbers{{float(e[0]), float(e[1]), float(e[2])},
                       float(1 / dot(e, e)),
                       {float(aside[0]), float(aside[1]), float(aside[2])}});
  return c;
}

Core core_of(const Capsule& capsule, const Vec3& p) {
  const Vec3 e = minus(capsule.b, capsule.a);
  return {times(e, std::clamp(dot(p, e) / dot(e, e), 0.0, 1.0)), capsule.radius};
}

Nearest nearest_of(const Capsule& capsule, const Vec3& p) {
  const Vec3 d = minus(p, core_of(capsule, p).nearest);
  if (is_rounding(d, p)) return {-capsule.radius, aside_of(minus(capsule.b, capsule.a))};
  const double length = std::hypot(d[0], d[1], d[2]);
  return {length - capsule.radius, times(d, 1 / length)};
}

Vec3 support_of(const Capsule& capsule, const Vec3& way) {
  const Vec3 e = minus(capsule.b, capsule.a);
  return dot(e, way) > 0 ? e : Vec3{};
}

// The axis and the triangle are polytopes: the least lies along the normal or across axis and edge.
Overlap overlap_of(const Capsule& capsule, const Triangle& t) {
  const Vec3 e = minus(capsule.b, capsule.a);
  LeastOverlap least(t, [&](const Vec3& way) { return support_of(capsule, way); });
  for (std::size_t k = 0; k < 3; ++k) least.along(cross(e, minus(t[(k + 1) % 3], t[k])));
  return least.found();
}

double feature_of(const Capsule& capsule) {
  return capsule.radius;
}

ShapeMesh mesh_of(const Capsule& capsule) {
  return mesh_of(TaperedCapsule{capsule.a, capsule.b, capsule.radius, capsule.radius});
}

}  // namespace weft::physics

#endif
