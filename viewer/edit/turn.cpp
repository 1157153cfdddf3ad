// Turns (turn.h).
#include "edit/turn.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace weft::viewer {

namespace {

constexpr double kDegree = std::numbers::pi / 180;

}  // namespace

Matrix rotation(std::size_t axis, double angle) {
  Matrix m{};
  const std::size_t a = (axis + 1) % 3, b = (axis + 2) % 3;
  m[axis][axis] = 1;
  m[a][a] = m[b][b] = std::cos(angle);
  m[b][a] = std::sin(angle);
  m[a][b] = -m[b][a];
  return m;
}

Vec3 times(const Matrix& m, const Vec3& v) {
  Vec3 out{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) out[r] += m[r][c] * v[c];
  return out;
}

Matrix times(const Matrix& m, const Matrix& n) {
  Matrix out{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k) out[r][c] += m[r][k] * n[k][c];
  return out;
}

Matrix matrix_of(const Vec3& degrees) {
  return times(rotation(2, degrees[2] * kDegree),
               times(rotation(1, degrees[1] * kDegree), rotation(0, degrees[0] * kDegree)));
}

Vec3 angles_of(const Matrix& m) {
  const double sine = std::clamp(-m[2][0], -1.0, 1.0);
  if (std::abs(sine) > 1 - 1e-9)
    return {std::atan2(-m[1][2], m[1][1]) / kDegree, std::asin(sine) / kDegree, 0};
  return {std::atan2(m[2][1], m[2][2]) / kDegree, std::asin(sine) / kDegree,
          std::atan2(m[1][0], m[0][0]) / kDegree};
}

}  // namespace weft::viewer
