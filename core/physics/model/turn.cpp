// Turns (weft/turn.h).
#include "weft/turn.h"

#include <cmath>
#include <numbers>

namespace weft {

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

// sin a [n] + (1 - cos a) [n]², where [n] v = n × v.
Matrix rotation_less_one(const Vec3& axis, double angle) {
  const Vec3 n = times(axis, 1 / length(axis));
  const double half = std::sin(angle / 2), sine = std::sin(angle), rest = 2 * half * half;
  Matrix m{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) m[r][c] = rest * (n[r] * n[c] - (r == c ? 1 : 0));
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
    m[b][a] += sine * n[k];
    m[a][b] -= sine * n[k];
  }
  return m;
}

Matrix rotation(const Vec3& axis, double angle) {
  Matrix m = rotation_less_one(axis, angle);
  for (std::size_t k = 0; k < 3; ++k) m[k][k] += 1;
  return m;
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

// z from the first column; what is left without it is Ry Rx, whose second row has x. So x makes up for what
// rounding does to z where the first column is nearly along z.
Vec3 angles_of(const Matrix& m) {
  constexpr double kNone = 1e-12;  // of a cosine, beyond rounding
  const double cosine = std::hypot(m[0][0], m[1][0]);
  const double z = cosine > kNone ? std::atan2(m[1][0], m[0][0]) : 0;
  const double c = std::cos(z), s = std::sin(z);
  const double x = std::atan2(s * m[0][2] - c * m[1][2], c * m[1][1] - s * m[0][1]);
  const double y = std::atan2(-m[2][0], cosine);
  return {x / kDegree, y / kDegree, z / kDegree};
}

}  // namespace weft
