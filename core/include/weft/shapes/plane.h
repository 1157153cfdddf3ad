#pragma once

#include <limits>

#include "weft/shapes/value.h"

namespace weft {

// The half-space below a plane.
struct Plane {
  Vec3 point{};
  Vec3 normal{0, 1, 0};  // need not be a unit vector; the cloth stays on its side

  double half_thickness() const { return std::numeric_limits<double>::infinity(); }
  static Plane of_size(double size) { return {{0, -size / 2, 0}, {0, 1, 0}}; }
  template <class Self, class Visit>
  static void values(Self& self, Visit&& visit) {
    visit("point", self.point, ShapeValue::place);
    visit("normal", self.normal, ShapeValue::direction);
  }
  friend bool operator==(const Plane&, const Plane&) = default;
};

}  // namespace weft
