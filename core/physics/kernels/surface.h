// What the kernels of self-collision among surfaces take (surface.cpp).
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

// Box about a square; the fourth values are 0.
struct SquareBox {
  float low[4], high[4];  // m
};

// Pairs of squares, and where those of them go whose boxes are within a range.
struct SquaresWithin {
  const SquareBox* boxes;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  float range;                            // m
  // out, and 16 lanes of padding
  std::int32_t *within_owner, *within_neighbour;
};

// Sums of weights times displacements [m] and velocities [m/s], and of weights, of four corners.
struct SquareChange {
  float push[4][3], gain[4][3], weight[4];
};

// A pair that touches, and what it wants of the corners of its owner and of its neighbour.
struct SquaresTouching {
  std::int32_t pair;
  SquareChange change[2];
};

// Pairs of squares to be measured, each against each.
struct SurfacePairs {
  const Square* squares;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  float range;                            // m
  float close;  // m: pairs of one sheet that are next to each other are kept only so far apart
  // Out: squared distance of what one owns from what the other does, range² at most [m²]; and 16
  // lanes of padding.
  float* near_squared;
  SquaresTouching* touching;  // out; there is room for all
};

}  // namespace weft::physics
