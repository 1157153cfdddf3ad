// Collider sphere: all points within `radius` of its center.  d(p) = |p| - r,  n = p/|p|
#ifdef WEFT_LANES

#include "physics/kernels/collide_faces.h"

namespace weft::WEFT_KERNELS {
namespace {

struct SphereSurface {
  static constexpr bool kFlat = false;
  explicit SphereSurface(const physics::ShapeConstants& c) : radius(wide(c.radius)) {}
  WEFT_INLINE Surface at(Wide3 p) const { return around(p, radius); }
  Wide radius;
};

}  // namespace
WEFT_COLLIDER(kSphere, SphereSurface)
}  // namespace weft::WEFT_KERNELS

#else

#include <cmath>
#include <numbers>

#include "physics/contact/colliders/shapes.h"

namespace weft::physics {

ShapeConstants constants_of(const Sphere& sphere) {
  ShapeConstants c;
  c.radius = float(sphere.radius);
  c.thin = float(sphere.half_thickness());
  return c;
}

Nearest nearest_of(const Sphere& sphere, const Vec3& p) {
  const double length = std::hypot(p[0], p[1], p[2]);
  return {length - sphere.radius, length > 0 ? times(p, 1 / length) : Vec3{0, 1, 0}};
}

Core core_of(const Sphere& sphere, const Vec3&) {
  return {{}, sphere.radius};
}

Vec3 support_of(const Sphere&, const Vec3&) {
  return {};
}

// Its core is a point, which a triangle cannot cut.
Overlap overlap_of(const Sphere&, const Triangle&) {
  return {};
}

double feature_of(const Sphere& sphere) {
  return sphere.radius;
}

ShapeMesh mesh_of(const Sphere& sphere) {
  ShapeMesh mesh;
  const auto normal = [](double u, double v) {
    const double turn = 2 * std::numbers::pi * u, rise = std::numbers::pi * (v - 0.5);
    return Vec3{std::cos(rise) * std::sin(turn), std::sin(rise), std::cos(rise) * std::cos(turn)};
  };
  add_patch(
      mesh, 64, 32, [&](double u, double v) { return times(normal(u, v), sphere.radius); }, normal);
  return mesh;
}

}  // namespace weft::physics

#endif
