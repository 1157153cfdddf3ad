// What the kernel of self-collision among surfaces takes (surface.cpp).
#pragma once

#include "physics/kernels/kernels.h"

namespace weft::physics {

// A square of a sheet: its corners A (its number's particle), B beyond A along the row, C below A, D
// below B. It owns the vertex A, the edges AB, AC and BC, and the triangles ABC and BDC. At a
// sheet's end corners beyond it are those before them: what has no length or area there is of no
// account.
struct alignas(64) Square {
  float x[4][3], v[4][3];  // m, m/s
  float w[4];              // 1/kg
  float place[3];  // column and row of A; columns of different sheets are far apart; thickness [m]
  float friction;
  std::int32_t corner[4];  // numbers of the particles, over all sheets
};

// What others want of a square's corners.
struct SquareSum {
  float nearest;  // distance of what it owns from what others own, at most the range [m]
  // Sums of weights times displacements [m] and velocities [m/s], and of weights.
  float push[4][3], gain[4][3], weight[4];
};

// Box about a square; the fourth values are 0.
struct SquareBox {
  float low[4], high[4];  // m
};

// One square against those that may be in range of it.
struct SurfaceSquare {
  const Square* squares;
  const SquareBox* boxes;
  int owner;
  std::int32_t* others;   // gone over: those whose boxes are in range come first
  int count;              // of them; there is room for 16 more
  std::int32_t far_away;  // a square out of reach of all
  float range;            // m
  float close;  // m: pairs of one sheet that are next to each other are kept only so far apart
  SquareSum* out;
};

}  // namespace weft::physics
