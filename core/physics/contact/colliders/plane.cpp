// Collider plane: the half-space below it.  d(p) = p·n
//
// The course's plane differs from the other shapes': a particle whose path crossed it goes to the
// crossing, less the offset along its path (seeds 001 and 004).
#include "physics/kernels/colliders.h"

namespace weft::physics {
namespace {

struct PlaneNumbers {
  float normal[3];
};

}  // namespace
}  // namespace weft::physics

#ifdef WEFT_LANES

#include "physics/kernels/collide_faces.h"

namespace weft::WEFT_KERNELS {
namespace {

struct PlaneSurface {
  static constexpr bool kFlat = true;
  explicit PlaneSurface(const physics::ShapeConstants& c) {
    const auto own = c.get<physics::PlaneNumbers>();
    normal = wide3(own.normal[0], own.normal[1], own.normal[2]);
  }
  WEFT_INLINE Surface at(Wide3 p) const { return {dot(p, normal), normal}; }
  Wide3 normal;
};

RowReach coulomb(const CollideRow& r) {
  return collide_row<PlaneSurface, false>(r);
}
RowReach below_faces(const FacesRow& f) {
  return below_faces_row<PlaneSurface>(f);
}
RowReach damp_sliding(const CollideRow& r) {
  return damp_sliding_row<PlaneSurface>(r);
}

// What something else pushed below is corrected as by other shapes.
RowReach course(const CollideRow& r) {
  const Wide3 point = wide3(r.cx, r.cy, r.cz);
  const Wide3 n = PlaneSurface(r.shape).normal;
  Wide clearance = wide(kFar), fastest{};
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 x = load3(r.x, i), v = load3(r.v, i), path = v * wide(r.dt), before = x - path;
    const Wide height = dot(x - point, n), height_before = dot(before - point, n);
    const WideInt free = free_lanes(r, i);
    clearance = min(clearance, select(free, abs(height), wide(kFar)));
    fastest = max(fastest, select(free, dot(v, v), Wide{}));
    const WideInt crossed = (height * height_before <= 0.0f) & (height != height_before) & free;
    const WideInt sunk = (height < 0.0f) & (height_before < 0.0f) & free;
    if (any(crossed)) {
      const Wide length = max(sqrt(dot(path, path)), wide(kTinySquare));
      const Wide fall = select(crossed, height_before - height, wide(1));
      const Wide reach = height_before / fall - r.offset / length;
      course_correct(r, i, crossed, before + path * reach);
    }
    if (any(sunk)) course_correct(r, i, sunk, x + n * (r.offset - height));
  }
  return {least(clearance), __builtin_sqrtf(greatest(fastest))};
}

}  // namespace
const physics::ColliderKernels kPlane = {{coulomb, course}, below_faces, damp_sliding};
}  // namespace weft::WEFT_KERNELS

#else

#include <cmath>
#include <limits>

#include "physics/contact/colliders/shapes.h"

namespace weft::physics {
namespace {

constexpr double kDrawn = 2;  // m; half the side of the square that is drawn

Vec3 unit_normal(const Plane& plane) {
  const Vec3& n = plane.normal;
  return times(n, 1 / std::hypot(n[0], n[1], n[2]));
}

}  // namespace

ShapeConstants constants_of(const Plane& plane) {
  const Vec3 n = unit_normal(plane);
  ShapeConstants c;
  c.thin = float(plane.half_thickness());
  c.set(PlaneNumbers{{float(n[0]), float(n[1]), float(n[2])}});
  return c;
}

Nearest nearest_of(const Plane& plane, const Vec3& p) {
  const Vec3 n = unit_normal(plane);
  return {dot(p, n), n};
}

Core core_of(const Plane& plane, const Vec3& p) {
  const Nearest n = nearest_of(plane, p);
  return {minus(p, times(n.normal, n.distance)), 0};
}

// Without bounds it has none.
Vec3 support_of(const Plane&, const Vec3&) {
  return {};
}

// Triangles are as deep as their corners.
Overlap overlap_of(const Plane&, const Triangle&) {
  return {};
}

double feature_of(const Plane&) {
  return std::numeric_limits<double>::infinity();
}

ShapeMesh mesh_of(const Plane& plane) {
  const Vec3 n = unit_normal(plane);
  const auto [u, v] = across(n);
  ShapeMesh mesh;
  add_patch(
      mesh, 8, 8,
      [&, u = u, v = v](double a, double b) {
        return plus(times(u, kDrawn * (2 * a - 1)), times(v, kDrawn * (2 * b - 1)));
      },
      [&](double, double) { return n; });
  return mesh;
}

}  // namespace weft::physics

#endif
