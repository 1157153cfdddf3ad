#pragma once

#include <algorithm>

#include "weft/shapes/value.h"

namespace weft {

// A box of half-sizes `half` about `center`, turned by `rotation` [degrees, about x then y then z],
// its edges rounded by `rounding` [m] (0 <= rounding <= the smallest half-size).
struct Box {
  Vec3 center{};
  Vec3 half{0.1, 0.1, 0.1};
  Vec3 rotation{};
  double rounding = 0;

  double half_thickness() const { return std::min({half[0], half[1], half[2]}); }
  static Box of_size(double size) { return {{}, {size / 2, size / 2, size / 2}, {}, size / 20}; }
  template <class Self, class Visit>
  static void values(Self& self, Visit&& visit) {
    visit("center", self.center, ShapeValue::place);
    visit("half", self.half, ShapeValue::length);
    visit("rotation", self.rotation, ShapeValue::angles);
    visit("rounding", self.rounding, ShapeValue::rounding);
  }
  friend bool operator==(const Box&, const Box&) = default;
};

}  // namespace weft
