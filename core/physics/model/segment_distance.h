// How far two segments are apart.
#pragma once

#include <algorithm>
#include <cmath>

#include "weft/vec3.h"

namespace weft::physics {

// Least distance between segments p + s d and q + t e, 0 <= s, t <= 1 (Ericson 5.1.9).
inline double segment_distance(const Vec3& p, const Vec3& d, const Vec3& q, const Vec3& e) {
  const Vec3 r = minus(p, q);
  const double a = dot(d, d), b = dot(d, e), c = dot(d, r), f = dot(e, r);
  const double h = std::max(dot(e, e), 1e-300), denominator = a * h - b * b;
  double s = denominator > 1e-12 * a * h ? std::clamp((b * f - c * h) / denominator, 0.0, 1.0) : 0;
  double t = (b * s + f) / h;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / std::max(a, 1e-300), 0.0, 1.0);
  }
  const Vec3 apart = minus(plus(p, times(d, s)), plus(q, times(e, t)));
  return length(apart);
}

}  // namespace weft::physics
