// Turns in double precision: matrices, and the angles that scenes give them by.
#pragma once

#include <array>

#include "weft/vec3.h"

namespace weft {

using Matrix = std::array<Vec3, 3>;  // rows

inline Vec3 times(const Matrix& m, const Vec3& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}
// By the transpose, which is the inverse of a turn.
inline Vec3 times_transpose(const Matrix& m, const Vec3& v) {
  return plus(plus(times(m[0], v[0]), times(m[1], v[1])), times(m[2], v[2]));
}
Matrix times(const Matrix& m, const Matrix& n);

// A turn about a coordinate axis [0 … 2, rad].
Matrix rotation(std::size_t axis, double angle);
// About an axis that is not zero, of any length, right-handed (Rodrigues) [rad].
Matrix rotation(const Vec3& axis, double angle);
// The same less the identity, without its rounding where the angle is small.
Matrix rotation_less_one(const Vec3& axis, double angle);
// Of turns about x, then y, then z [degrees]: Rz Ry Rx.
Matrix matrix_of(const Vec3& degrees);
// The angles again [degrees]. Where y is a quarter turn, x and z turn about one axis, and z is taken as 0.
Vec3 angles_of(const Matrix& m);

}  // namespace weft
