// What the kernels of self-collision among surfaces take (surface.cpp).
#pragma once

#include "physics/kernels/kernels.h"

namespace weft::physics {

// A particle of a sheet, as squares know it.
struct alignas(32) Vertex {
  float x[3], w;       // m, 1/kg
  float v[3], unused;  // m/s
};

// A square of a sheet: its corners A (its number's particle), B beyond A along the row, C below A, D
// below B. It owns the vertex A, the edges AB, AC and BC, and the triangles ABC and BDC. At a
// sheet's end corners beyond it are those before them: what has no length or area there is of no
// account.
struct alignas(32) Square {
  std::int32_t corner[4];  // numbers of the particles, over all sheets
  float place[2];          // column and row of A; columns of different sheets are far apart
  float thickness;         // m
  float friction;
};

// Box about a square.
struct SquareBox {
  float low[3], asked;    // m; 1 where all pairs of the square are asked for, else 0
  float high[3], unused;  // m
};

// Pairs of squares, and where those of them go whose boxes are within a range, and one of which is
// asked for.
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

constexpr float kOutOfReach = 1e18f;  // m²

// Pairs of squares to be measured, each against each.
struct SurfacePairs {
  const Vertex* vertices;
  const Square* squares;
  int pairs;
  const std::int32_t *owner, *neighbour;  // and 16 lanes of numbers of squares
  // m: what pairs are kept apart by, beside the thickness: those of one sheet that are next to each
  // other; and how much farther apart than that they are of account.
  float close, beyond;
  // Out: squared distance of what one owns from what the other does, or kOutOfReach [m²]; and 16
  // lanes of padding.
  float* near_squared;
  SquaresTouching* touching;  // out; there is room for all; null: distances alone
};

}  // namespace weft::physics
