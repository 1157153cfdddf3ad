// Transforms of glTF nodes.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "weft/vec3.h"

namespace weft::text {

// x -> columns x + translation.
struct Affine {
  std::array<Vec3, 3> columns{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 translation{};

  Vec3 turned(const Vec3& x) const {
    Vec3 y{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t n = 0; n < 3; ++n) y[k] += columns[n][k] * x[n];
    return y;
  }
  Vec3 operator()(const Vec3& x) const {
    Vec3 y = turned(x);
    for (std::size_t k = 0; k < 3; ++k) y[k] += translation[k];
    return y;
  }
  Affine operator*(const Affine& inner) const {
    Affine both;
    for (std::size_t n = 0; n < 3; ++n) both.columns[n] = turned(inner.columns[n]);
    both.translation = (*this)(inner.translation);
    return both;
  }
  bool mirrors() const { return dot(cross(columns[0], columns[1]), columns[2]) < 0; }
};

using Quaternion = std::array<double, 4>;  // x, y, z, w

// Whether it is one after division by its length.
inline bool is_rotation(const Quaternion& q) {
  const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  return square > 1e-12 && square < 1e12;
}

// From `a` to `b` the shorter way at a steady rate, `share` of it: spherical linear interpolation (Shoemake 1985)
// of quaternions of length 1.
Quaternion slerp(const Quaternion& a, const Quaternion& b, double share);

// Of a node, below its parent: translation rotation scale, or a matrix that no channel moves.
struct LocalTransform {
  Vec3 translation{};
  Quaternion rotation{0, 0, 0, 1};
  Vec3 scale{1, 1, 1};
  std::optional<Affine> matrix{};

  Affine affine() const;
};

}  // namespace weft::text
