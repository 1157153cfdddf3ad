// A point or a direction, and the arithmetic of them, in double precision.
#pragma once

#include <array>
#include <cmath>

namespace weft {

using Vec3 = std::array<double, 3>;

inline Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3 plus(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3 times(const Vec3& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// For what is within 1e-150 … 1e150, beyond which squares are not finite or 0.
inline double length(const Vec3& a) {
  return std::sqrt(dot(a, a));
}
inline double distance(const Vec3& a, const Vec3& b) {
  return length(minus(a, b));
}

// The length whatever its size: of what is read and not yet checked.
inline double hypot(const Vec3& a) {
  return std::hypot(a[0], a[1], a[2]);
}

// Of a triangle, counter-clockwise seen from its tip: its normal times twice its area.
inline Vec3 normal_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return cross(minus(b, a), minus(c, a));
}

}  // namespace weft
