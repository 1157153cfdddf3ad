#pragma once

#include "weft/shapes/value.h"

namespace weft {

// All points within `radius` of the axis from a to b.
struct Capsule {
  Vec3 a{}, b{0, 1, 0};  // ends of the axis
  double radius = 0.1;   // m

  double half_thickness() const { return radius; }
  static Capsule of_size(double size) { return {{0, -size / 2, 0}, {0, size / 2, 0}, size / 4}; }
  template <class Self, class Visit>
  static void values(Self& self, Visit&& visit) {
    visit("a", self.a, ShapeValue::place);
    visit("b", self.b, ShapeValue::point);
    visit("radius", self.radius, ShapeValue::radius);
  }
  friend bool operator==(const Capsule&, const Capsule&) = default;
};

}  // namespace weft
