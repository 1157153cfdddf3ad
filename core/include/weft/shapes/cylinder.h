#pragma once

#include <algorithm>
#include <cmath>

#include "weft/shapes/value.h"

namespace weft {

// All points within `radius` of the axis from a to b, between its ends: a disc where it is short. Its
// edges are rounded by `rounding` [m] (0 <= rounding <= radius and half of the length).
struct Cylinder {
  Vec3 a{}, b{0, 1, 0};  // ends of the axis
  double radius = 0.1;   // m
  double rounding = 0;

  double half_thickness() const {
    return std::min(radius, 0.5 * std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]));
  }
  static Cylinder of_size(double size) {
    return {{0, -size / 2, 0}, {0, size / 2, 0}, size / 2, size / 20};
  }
  template <class Self, class Visit>
  static void values(Self& self, Visit&& visit) {
    visit("a", self.a, ShapeValue::place);
    visit("b", self.b, ShapeValue::point);
    visit("radius", self.radius, ShapeValue::length);
    visit("rounding", self.rounding, ShapeValue::rounding);
  }
  friend bool operator==(const Cylinder&, const Cylinder&) = default;
};

}  // namespace weft
