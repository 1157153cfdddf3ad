// Collider box: a core of half-sizes h about its center, turned, and grown by the rounding r.
//   q = |Rᵀp| - h,  d(p) = |max(q, 0)| + min(max(q_x, q_y, q_z), 0) - r
// The normal is that of the nearest point outside the core, and of the nearest face inside it.
#include "physics/kernels/colliders.h"

namespace weft::physics {
namespace {

struct BoxNumbers {
  float half[3];     // of the core [m]
  float axes[3][3];  // its own, unit
};

}  // namespace
}  // namespace weft::physics

#ifdef WEFT_LANES

#include "physics/kernels/collide_faces.h"

namespace weft::WEFT_KERNELS {
namespace {

struct BoxSurface {
  static constexpr bool kFlat = false;
  explicit BoxSurface(const physics::ShapeConstants& c) : radius(wide(c.radius)) {
    const auto own = c.get<physics::BoxNumbers>();
    half = wide3(own.half[0], own.half[1], own.half[2]);
    for (int k = 0; k < 3; ++k) axis[k] = wide3(own.axes[k][0], own.axes[k][1], own.axes[k][2]);
  }
  WEFT_INLINE Surface at(Wide3 p) const {
    const Wide3 local{dot(p, axis[0]), dot(p, axis[1]), dot(p, axis[2])};
    const Wide3 q = Wide3{abs(local.x), abs(local.y), abs(local.z)} - half;
    const Wide3 out{max(q.x, Wide{}), max(q.y, Wide{}), max(q.z, Wide{})};
    const Wide squared = dot(out, out);
    const WideInt outside = squared > kTinySquare;
    const Wide reciprocal = reciprocal_root(select(outside, squared, wide(1)));
    const Wide deepest = max(max(q.x, q.y), q.z);
    const WideInt by_x = q.x == deepest, by_y = ~by_x & (q.y == deepest);
    const Wide3 face{select(by_x, wide(1), Wide{}), select(by_y, wide(1), Wide{}),
                     select(by_x | by_y, Wide{}, wide(1))};
    const Wide3 n = signed_as(select(outside, out * reciprocal, face), local);
    return {select(outside, squared * reciprocal, min(deepest, Wide{})) - radius,
            fma(axis[2], n.z, fma(axis[1], n.y, axis[0] * n.x))};
  }
  WEFT_INLINE static Wide3 signed_as(Wide3 n, Wide3 local) {
    return {select(local.x < 0.0f, -n.x, n.x), select(local.y < 0.0f, -n.y, n.y),
            select(local.z < 0.0f, -n.z, n.z)};
  }
  Wide radius;
  Wide3 half, axis[3];
};

}  // namespace
WEFT_COLLIDER(kBox, BoxSurface)
}  // namespace weft::WEFT_KERNELS

#else

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/contact/colliders/least_overlap.h"

namespace weft::physics {

std::array<Vec3, 3> axes_of(const Box& box) {
  std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
  if (box.rotation == Vec3{}) return axes;
  for (int k = 0; k < 3; ++k) {
    const double angle = box.rotation[k] * std::numbers::pi / 180;
    const double c = std::cos(angle), s = std::sin(angle);
    const int a = (k + 1) % 3, b = (k + 2) % 3;
    for (Vec3& axis : axes) {
      const double before = axis[a];
      axis[a] = c * before - s * axis[b];
      axis[b] = s * before + c * axis[b];
    }
  }
  return axes;
}

ShapeConstants constants_of(const Box& box) {
  const std::array<Vec3, 3> axes = axes_of(box);
  ShapeConstants c;
  c.radius = float(box.rounding);
  c.thin = float(box.half_thickness());
  BoxNumbers own{};
  for (int k = 0; k < 3; ++k) {
    own.half[k] = float(box.half[k] - box.rounding);
    for (int m = 0; m < 3; ++m) own.axes[k][m] = float(axes[k][m]);
  }
  c.set(own);
  return c;
}

Core core_of(const Box& box, const Vec3& p) {
  Core core{{}, box.rounding};
  if (box.rotation == Vec3{}) {
    for (int k = 0; k < 3; ++k) {
      const double h = box.half[k] - box.rounding;
      core.nearest[k] = std::clamp(p[k], -h, h);
    }
    return core;
  }
  const std::array<Vec3, 3> axes = axes_of(box);
  for (int k = 0; k < 3; ++k) {
    const double h = box.half[k] - box.rounding;
    core.nearest = plus(core.nearest, times(axes[k], std::clamp(dot(p, axes[k]), -h, h)));
  }
  return core;
}

Nearest nearest_of(const Box& box, const Vec3& p) {
  const std::array<Vec3, 3> axes = axes_of(box);
  Vec3 q, out, side;
  for (int k = 0; k < 3; ++k) {
    const double along = dot(p, axes[k]);
    side[k] = along < 0 ? -1 : 1;
    q[k] = std::abs(along) - (box.half[k] - box.rounding);
    out[k] = std::max(q[k], 0.0);
  }
  const double length = std::hypot(out[0], out[1], out[2]);
  if (length == 0) {
    const std::size_t face = std::size_t(std::max_element(q.begin(), q.end()) - q.begin());
    return {q[face] - box.rounding, times(axes[face], side[face])};
  }
  Vec3 normal{};
  for (int k = 0; k < 3; ++k) normal = plus(normal, times(axes[k], side[k] * out[k] / length));
  return {length - box.rounding, normal};
}

namespace {

Vec3 furthest(const Box& box, const std::array<Vec3, 3>& axes, const Vec3& way) {
  Vec3 furthest{};
  for (int k = 0; k < 3; ++k) {
    const double h = box.half[k] - box.rounding;
    furthest = plus(furthest, times(axes[k], dot(axes[k], way) < 0 ? -h : h));
  }
  return furthest;
}

}  // namespace

Vec3 support_of(const Box& box, const Vec3& way) {
  return furthest(box, axes_of(box), way);
}

// Separating axes of a box and a triangle (Gottschalk et al. 1996): the triangle's normal, the faces' three
// normals, and the nine products of their edges.
Overlap overlap_of(const Box& box, const Triangle& t) {
  const std::array<Vec3, 3> axes = axes_of(box);
  LeastOverlap least(t, [&](const Vec3& way) { return furthest(box, axes, way); });
  for (const Vec3& axis : axes) least.along(axis);
  for (const Vec3& axis : axes)
    for (std::size_t k = 0; k < 3; ++k) least.along(cross(axis, minus(t[(k + 1) % 3], t[k])));
  return least.found();
}

double feature_of(const Box& box) {
  return box.rounding;
}

// Each side is a patch of the cube's side, mapped onto the rounded box by its normals: a point on
// the inner box plus the rounding along the direction in which the cube's point lies beyond it.
ShapeMesh mesh_of(const Box& box) {
  const std::array<Vec3, 3> axes = axes_of(box);
  const int bands = box.rounding > 0 ? 6 : 0;  // quads over a rounded edge
  const int quads = 2 * bands + 1;
  ShapeMesh mesh;
  for (int side = 0; side < 6; ++side) {
    const int k = side / 2;
    const double sign = side % 2 ? -1 : 1;
    const int a = sign > 0 ? (k + 1) % 3 : (k + 2) % 3, b = sign > 0 ? (k + 2) % 3 : (k + 1) % 3;
    // Along one direction: which end of the core, and the tangent of the angle past it.
    const auto bend = [&](double u) {
      const double n = u * quads;
      if (bands == 0) return std::pair{2 * u - 1, 0.0};
      const double past = n <= bands ? n - bands : n >= bands + 1 ? n - bands - 1 : 0;
      return std::pair{n <= bands ? -1.0 : 1.0, std::tan(past / bands * std::numbers::pi / 4)};
    };
    const auto normal_local = [&](double u, double v) {
      Vec3 n{};
      n[k] = sign;
      n[a] = bend(u).second;
      n[b] = bend(v).second;
      return times(n, 1 / std::hypot(n[0], n[1], n[2]));
    };
    const auto turned = [&](const Vec3& p) {
      return plus(plus(times(axes[0], p[0]), times(axes[1], p[1])), times(axes[2], p[2]));
    };
    add_patch(
        mesh, quads, quads,
        [&](double u, double v) {
          Vec3 p = times(normal_local(u, v), box.rounding);
          p[k] += sign * (box.half[k] - box.rounding);
          p[a] += bend(u).first * (box.half[a] - box.rounding);
          p[b] += bend(v).first * (box.half[b] - box.rounding);
          return turned(p);
        },
        [&](double u, double v) { return turned(normal_local(u, v)); });
  }
  return mesh;
}

}  // namespace weft::physics

#endif
