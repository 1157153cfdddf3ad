#pragma once

#include <algorithm>
#include <cmath>

#include "weft/shapes/value.h"

namespace weft {

// The convex hull of two balls, about a and about b: a limb, a cone with round ends. Where one ball holds the
// other, it is that ball.
struct TaperedCapsule {
  Vec3 a{}, b{0, 1, 0};   // centers of the balls
  double radius_a = 0.1;  // m
  double radius_b = 0.05;

  double half_thickness() const {
    const double length = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    const bool one_holds_other = std::abs(radius_b - radius_a) >= length;
    return one_holds_other ? std::max(radius_a, radius_b) : std::min(radius_a, radius_b);
  }
  static TaperedCapsule of_size(double size) {
    return {{0, -size / 4, 0}, {0, size / 2, 0}, size / 4, size / 8};
  }
  template <class Self, class Visit>
  static void values(Self& self, Visit&& visit) {
    visit("a", self.a, ShapeValue::place);
    visit("b", self.b, ShapeValue::point);
    visit("radius_a", self.radius_a, ShapeValue::radius);
    visit("radius_b", self.radius_b, ShapeValue::radius);
  }
  friend bool operator==(const TaperedCapsule&, const TaperedCapsule&) = default;
};

}  // namespace weft
