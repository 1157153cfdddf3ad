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

#include "physics/kernels/collide.h"

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
    const WideInt off_axis = square > kTinySquare;
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

#include "physics/contact/colliders/shapes.h"

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

// A point in the plane of axis and point: how far along the axis, how far from it, and to which side.
struct Polar {
  double z, distance;
  Vec3 side;
};
Polar polar_of(const Frame& f, const Vec3& p) {
  const Vec3 local = minus(p, f.middle);
  const double z = dot(local, f.axis);
  const Vec3 radial = minus(local, times(f.axis, z));
  const double distance = std::sqrt(dot(radial, radial));
  return {z, distance, distance > 0 ? times(radial, 1 / distance) : f.aside};
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
  const Polar at = polar_of(f, p);
  const Vec3 along = times(f.axis, std::clamp(at.z, -f.along, f.along));
  return {plus(f.middle, plus(along, times(at.side, std::min(at.distance, f.radius)))),
          cylinder.rounding};
}

Nearest nearest_of(const Cylinder& cylinder, const Vec3& p) {
  const Frame f(cylinder);
  const Polar at = polar_of(f, p);
  const Vec3 end = times(f.axis, at.z < 0 ? -1 : 1);
  const double q1 = at.distance - f.radius, q2 = std::abs(at.z) - f.along;
  const double out1 = std::max(q1, 0.0), out2 = std::max(q2, 0.0), length = std::hypot(out1, out2);
  if (length == 0) return {std::max(q1, q2) - cylinder.rounding, q1 >= q2 ? at.side : end};
  return {length - cylinder.rounding,
          plus(times(at.side, out1 / length), times(end, out2 / length))};
}

Vec3 support_of(const Cylinder& cylinder, const Vec3& way) {
  const Frame f(cylinder);
  const double along = dot(way, f.axis);
  const Vec3 across = minus(way, times(f.axis, along));
  const double size = std::sqrt(dot(across, across));
  const Vec3 rim = size > 0 ? times(across, f.radius / size) : Vec3{};
  return plus(f.middle, plus(times(f.axis, along < 0 ? -f.along : f.along), rim));
}

// Directions along which the two may be apart: the axis, the triangle's normal, and across the axis
// those to its sides and corners, seen along the axis. The one of least overlap leads out. Two that
// touch only between such directions count as overlapping, and are moved out a little too far.
Overlap overlap_of(const Cylinder& cylinder, const Triangle& t) {
  const Frame f(cylinder);
  Overlap best{1e300, {}};
  const auto separates = [&](const Vec3& direction) {
    const double size = std::sqrt(dot(direction, direction));
    if (size < 1e-12) return false;
    const Vec3 n = times(direction, 1 / size);
    const double along = dot(n, f.axis);
    const double reach =
        f.along * std::abs(along) + f.radius * std::sqrt(std::max(0.0, 1 - along * along));
    double low = 1e300, high = -1e300;
    for (const Vec3& x : t) {
      low = std::min(low, dot(n, minus(x, f.middle)));
      high = std::max(high, dot(n, minus(x, f.middle)));
    }
    const double up = reach - low, down = reach + high;  // to leave along n, or against it
    if (std::min(up, down) < best.depth)
      best = up < down ? Overlap{up, n} : Overlap{down, times(n, -1)};
    return up <= 0 || down <= 0;
  };
  if (separates(f.axis) || separates(normal_of(t[0], t[1], t[2]))) return {};
  for (int k = 0; k < 3; ++k) {
    const Vec3 edge = minus(t[(k + 1) % 3], t[k]);
    if (separates(cross(f.axis, edge)) || separates(polar_of(f, t[k]).side)) return {};
  }
  return best;
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
