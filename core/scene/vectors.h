// Vectors of a scene, in double precision.
#pragma once

#include <cmath>

#include "weft/scene.h"

namespace weft::text {

inline double length(const Vec3& a) {
  return std::hypot(a[0], a[1], a[2]);
}

inline double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vec3 minus(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

// Where particle (i, j) of a grid starts, but for jitter.
inline Vec3 place_on(const Grid& grid, int i, int j) {
  Vec3 p = grid.origin;
  for (std::size_t k = 0; k < 3; ++k)
    p[k] += grid.u[k] * (i / double(grid.nx - 1)) + grid.v[k] * (j / double(grid.ny - 1));
  return p;
}

inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace weft::text
