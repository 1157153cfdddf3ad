// Collider cylinder: a core of radius R and half-length H about its middle m, grown by the rounding r.
//   q = (|p - m - z n| - R, |z| - H), z = (p - m)·n
//   d(p) = |max(q, 0)| + min(max(q_1, q_2), 0) - r
// n is the unit axis. The normal is that of the nearest point outside the core, and of the nearer of
// side and end inside it.
#include "physics/kernels/colliders.h"

namespace weft::physics {
namespace {

struct CylinderNumbers {
  float across, along;                 // the core's radius and half-length [m]
  float axis[3], middle[3], aside[3];  // unit axis; middle seen from a [m]; a unit vector across
};

}  // namespace
}  // namespace weft::physics

#ifdef WEFT_LANES

#include "physics/kernels/collide_faces.h"

namespace weft::WEFT_KERNELS {
namespace {

struct CylinderSurface {
  static constexpr bool kFlat = false;
  explicit CylinderSurface(const physics::ShapeConstants& c) : radius(wide(c.radius)) {
    const auto own = c.get<physics::CylinderNumbers>();
    across = wide(own.across);
    along = wide(own.along);
    axis = wide3(own.axis[0], own.axis[1], own.axis[2]);
    middle = wide3(own.middle[0], own.middle[1], own.middle[2]);
    aside = wide3(own.aside[0], own.aside[1], own.aside[2]);
  }
  WEFT_INLINE Surface at(Wide3 p) const {
    const Wide3 local = p - middle;
    const Wide z = dot(local, axis);
    const Wide3 radial = fnma(axis, z, local);
    const Wide square = dot(radial, radial);
    const WideInt off_axis = square > rounding_across(local);
    const Wide inverse = reciprocal_root(select(off_axis, square, wide(1)));
    const Wide3 side = select(off_axis, radial * inverse, aside);
    const Wide q1 = select(off_axis, square * inverse, Wide{}) - across, q2 = abs(z) - along;
    const Wide out1 = max(q1, Wide{}), out2 = max(q2, Wide{});
    const Wide squared = fma(out1, out1, out2 * out2);
    const WideInt outside = squared > kTinySquare;
    const Wide reciprocal = reciprocal_root(select(outside, squared, wide(1)));
    const WideInt by_side = q1 >= q2;
    const Wide n1 = select(outside, out1 * reciprocal, select(by_side, wide(1), Wide{}));
    const Wide n2 = select(outside, out2 * reciprocal, select(by_side, Wide{}, wide(1)));
    return {select(outside, squared * reciprocal, min(max(q1, q2), Wide{})) - radius,
            fma(axis, select(z < 0.0f, -n2, n2), side * n1)};
  }
  Wide radius, across, along;
  Wide3 axis, middle, aside;
};

}  // namespace
WEFT_COLLIDER(kCylinder, CylinderSurface)
}  // namespace weft::WEFT_KERNELS

#else

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/contact/colliders/least_overlap.h"

namespace weft::physics {
namespace {

// About the middle of the axis.
struct Frame {
  Vec3 middle, axis, aside, third;  // seen from a; unit vectors, right-handed
  double radius, along;             // the core's radius and half-length [m]

  explicit Frame(const Cylinder& c) {
    const Vec3 e = minus(c.b, c.a);
    const double length = std::sqrt(dot(e, e));
    middle = times(e, 0.5);
    axis = times(e, 1 / length);
    aside = across(axis)[0];
    third = across(axis)[1];
    radius = c.radius - c.rounding;
    along = length / 2 - c.rounding;
  }
};

// A vector from the middle, or a direction, in its plane with the axis: how much of it lies along the axis, how
// much across, and to which side; to any where it lies along the axis to rounding.
struct Polar {
  double z, distance;
  Vec3 side;
};
Polar polar_of(const Frame& f, const Vec3& v) {
  const double z = dot(v, f.axis);
  const Vec3 radial = minus(v, times(f.axis, z));
  const double distance = std::sqrt(dot(radial, radial));
  return {z, distance, is_rounding(radial, v) ? f.aside : times(radial, 1 / distance)};
}

// Of the core.
Nearest nearest_of(const Frame& f, const Polar& at) {
  const Vec3 end = times(f.axis, at.z < 0 ? -1 : 1);
  const double q1 = at.distance - f.radius, q2 = std::abs(at.z) - f.along;
  const double out1 = std::max(q1, 0.0), out2 = std::max(q2, 0.0), length = std::hypot(out1, out2);
  if (length == 0) return {std::max(q1, q2), q1 >= q2 ? at.side : end};
  return {length, plus(times(at.side, out1 / length), times(end, out2 / length))};
}

// The point of the core that lies furthest along `way`.
Vec3 furthest(const Frame& f, const Vec3& way) {
  const Polar at = polar_of(f, way);
  return plus(f.middle,
              plus(times(f.axis, at.z < 0 ? -f.along : f.along), times(at.side, f.radius)));
}

}  // namespace

ShapeConstants constants_of(const Cylinder& cylinder) {
  const Frame f(cylinder);
  ShapeConstants c;
  c.radius = float(cylinder.rounding);
  c.thin = float(cylinder.half_thickness());
  CylinderNumbers own{};
  own.across = float(f.radius);
  own.along = float(f.along);
  for (int k = 0; k < 3; ++k) {
    own.axis[k] = float(f.axis[k]);
    own.middle[k] = float(f.middle[k]);
    own.aside[k] = float(f.aside[k]);
  }
  c.set(own);
  return c;
}

Core core_of(const Cylinder& cylinder, const Vec3& p) {
  const Frame f(cylinder);
  const Polar at = polar_of(f, minus(p, f.middle));
  const Vec3 along = times(f.axis, std::clamp(at.z, -f.along, f.along));
  return {plus(f.middle, plus(along, times(at.side, std::min(at.distance, f.radius)))),
          cylinder.rounding};
}

Nearest nearest_of(const Cylinder& cylinder, const Vec3& p) {
  const Frame f(cylinder);
  const Nearest core = nearest_of(f, polar_of(f, minus(p, f.middle)));
  return {core.distance - cylinder.rounding, core.normal};
}

Vec3 support_of(const Cylinder& cylinder, const Vec3& way) {
  return furthest(Frame(cylinder), way);
}

// Above a corner the least lies along the axis, straight away from it, or, where that corner is outside, between
// the two.
Overlap overlap_of(const Cylinder& cylinder, const Triangle& t) {
  const Frame f(cylinder);
  LeastOverlap least(t, [&](const Vec3& way) { return furthest(f, way); });
  least.along(f.axis);
  for (const Vec3& corner : t) {
    const Polar at = polar_of(f, minus(corner, f.middle));
    least.towards(at.side);
    least.towards(nearest_of(f, at).normal);
  }
  least.across_edges();
  return least.found();
}

double feature_of(const Cylinder& cylinder) {
  return cylinder.rounding;
}

// The outline, from one end of the axis to the other, turned about it.
ShapeMesh mesh_of(const Cylinder& cylinder) {
  const Frame f(cylinder);
  struct Point {
    double distance, z, rise;  // rise: of the normal above the plane across the axis [rad]
  };
  constexpr double kQuarter = std::numbers::pi / 2;
  const int bands = cylinder.rounding > 0 ? 6 : 0;  // over a rounded edge
  std::vector<Point> outline{{0, -f.along - cylinder.rounding, -kQuarter}};
  for (const double end : {-1.0, 1.0})
    for (int n = 0; n <= std::max(bands, 1); ++n) {
      const double share = double(n) / std::max(bands, 1);
      const double rise = kQuarter * (end < 0 ? share - 1 : share);
      outline.push_back({f.radius + cylinder.rounding * std::cos(rise),
                         end * f.along + cylinder.rounding * std::sin(rise), rise});
    }
  outline.push_back({0, f.along + cylinder.rounding, kQuarter});
  const int rings = int(outline.size()) - 1;
  const auto side = [&](double u) {
    const double turn = 2 * std::numbers::pi * u;
    return plus(times(f.aside, std::cos(turn)), times(f.third, std::sin(turn)));
  };
  const auto at = [&](double v) { return outline[std::size_t(std::lround(v * rings))]; };
  ShapeMesh mesh;
  add_patch(
      mesh, 64, rings,
      [&](double u, double v) {
        return plus(f.middle, plus(times(side(u), at(v).distance), times(f.axis, at(v).z)));
      },
      [&](double u, double v) {
        return plus(times(side(u), std::cos(at(v).rise)), times(f.axis, std::sin(at(v).rise)));
      });
  return mesh;
}

}  // namespace weft::physics

#endif
