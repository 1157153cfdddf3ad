// What the kernels of bending work on (kernels/bending.cpp).
#pragma once

#include <cstddef>

#include "physics/kernels/rows.h"

namespace weft::physics {

// Lines side by side, and floats of scratch for each particle of a batch.
inline constexpr int kBendLines = 16;
inline constexpr int kBendScratch = 5 * kBendLines;

// Stiffnesses of the second differences along u and v and of the twist of a cell [N/m].
struct BendStiffness {
  float along, across, twist;
};

// Rows j, j+1 and j+2; of the last rows of a sheet `rows` exist.
struct BendRow {
  int columns;
  int rows;  // 1 … 3
  ConstRow3 x[3];
  Row3 v[3];
  const float* w[3];
  // Terms that are left of row j, 1 or 0; null: all.
  const float *along, *across, *twist;
  BendStiffness k;
  const float* width;  // that each column stands for, of an inner one's
  float dt;            // s, over what the force takes of the velocity that follows
};

// kBendLines lines of particles, `step` floats from one to the next.
struct BendLine {
  ConstRow3 x;  // they are at x + u [m]
  Row3 u;       // receives corrections, laid out as x
  const float* w;
  std::ptrdiff_t step;
  int particles;
  const float* compliance;  // 1/(k dt²) of each line [1/kg]
  const float* left;  // 1 for second differences that are left, else 0, laid out as w; null: all
  float* scratch;     // particles * kBendScratch floats
};

// The cells between two rows of particles whose left column is even, or odd.
struct TwistRow {
  int columns;
  ConstRow3 x, below;  // they are at x + u [m]
  Row3 u, u_below;     // receive corrections
  const float* w;
  const float* w_below;
  bool odd;
  const float* left;  // 1 for twists that are left, else 0; null: all
  float compliance;
};

}  // namespace weft::physics
