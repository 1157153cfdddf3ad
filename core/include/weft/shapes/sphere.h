#pragma once

#include "weft/shapes/value.h"

namespace weft {

// All points within `radius` of the center.
struct Sphere {
  Vec3 center{};
  double radius = 0.1;  // m

  double half_thickness() const { return radius; }
  static Sphere of_size(double size) { return {{}, size / 2}; }
  template <class Self, class Visit>
  static void values(Self& self, Visit&& visit) {
    visit("center", self.center, ShapeValue::place);
    visit("radius", self.radius, ShapeValue::radius);
  }
  friend bool operator==(const Sphere&, const Sphere&) = default;
};

}  // namespace weft
