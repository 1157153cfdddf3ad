// Where the path of a point meets a triangle.
#pragma once

#include "physics/contact/triangle_shape.h"

namespace weft::physics {

struct Met {
  double at = 2;  // share of the path; beyond 1: nowhere
  Weights weights{};
};

// A triangle that stands (Moller and Trumbore 1997).
Met meets(const Vec3& from, const Vec3& to, const Triangle& triangle);

// One whose corners move straight from `begin` to `end` meanwhile: where the point comes into its plane, which
// is a root of a cubic, within its sides (Provot 1997). Of what is met an odd number of times none is lost.
Met meets_moving(const Vec3& from, const Vec3& to, const Triangle& begin, const Triangle& end);

}  // namespace weft::physics
