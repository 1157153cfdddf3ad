// Turns in double precision: matrices, and the angles that scenes give them by.
#pragma once

#include <array>

#include "weft/scene.h"

namespace weft::viewer {

using Matrix = std::array<Vec3, 3>;  // rows

Vec3 times(const Matrix& m, const Vec3& v);
Matrix times(const Matrix& m, const Matrix& n);

// A turn about a coordinate axis [0 … 2, rad].
Matrix rotation(std::size_t axis, double angle);
// Of turns about x, then y, then z [degrees]: Rz Ry Rx.
Matrix matrix_of(const Vec3& degrees);
// The angles again. Where y is a quarter turn, x and z turn about one axis, and z is taken as 0.
Vec3 angles_of(const Matrix& m);

}  // namespace weft::viewer
