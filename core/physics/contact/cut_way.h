// Whether a constraint reaches a collider that cuts.
#pragma once

#include "physics/contact/triangle_shape.h"

namespace weft::physics {

// Whether a point of the way e from a place comes inside the shape's offset surface. Points are looked at as densely
// as the shape is near: by sphere tracing, each step as long as nothing can be nearer.
template <class Shape>
bool comes_inside(const Shape& shape, double offset, const Vec3& from, const Vec3& e) {
  const double length = std::sqrt(dot(e, e));
  for (double t = 0;;) {
    const double left = nearest_of(shape, plus(from, times(e, t))).distance - offset;
    if (left <= 0) return true;
    if (t >= 1) return false;
    t = std::min(1.0, t + std::max(left, 0.01 * length) / std::max(length, 1e-12));
  }
}

}  // namespace weft::physics
