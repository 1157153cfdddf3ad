// What the kernels of the membrane work on (kernels/membrane.cpp, membrane_squares.cpp).
#pragma once

#include "physics/kernels/bending.h"
#include "physics/kernels/lattice.h"

namespace weft::physics {

// A row's edges and the cells between it and the next row (kernels/membrane.cpp).
struct MembraneConstants {
  float warp, weft;     // stiffness of an edge along the row, and of one to the next row [N/m]
  float along, across;  // coupling: what a cell's strains across and along add to them [N/m]
  float shear;          // pull of a cell's diagonals, of their squared lengths' difference [N/m³]
};

struct MembraneRows : LeapfrogRows {
  const MembraneConstants* constants;  // of each row; zero but for `warp` where no row follows
  const float* share;                  // of `weft`, of each column: half at both sides
  float half_u, half_v;                // 1/(2 h²) of the spacings along and across rows [1/m²]
  float damping;                       // s
  // Of each row, as bend_row's; zero where no row follows that a term needs. Null: the sheet does not bend [N/m].
  const BendStiffness* bend;
  float bend_damping;  // s
  // Terms of bending that are left, 1 or 0, of row 0; null: all.
  const float *along, *across, *twist;
};

// What line sweeps are to make of squared lengths (kernels/membrane_squares.cpp), of rows begin … end-1.
struct MembraneSquares {
  int begin, end, rows;
  int columns, stride;
  ConstRow3 x, u;    // row 0; particles are at x + u; no u: it is zero [m]
  float* diagonals;  // of the cells between each row and the next, row 0 [m²]
  // Of edges along rows and between them; null: there is no coupling.
  float *along, *across;
  float square_u, square_v;  // of the rest lengths [m²]
  float keep_u, keep_v;      // share of its own present square that an edge keeps
  // What squares of edges across add to one along, from the cells before each row and after it; and, times
  // the column's share, those along to one across.
  struct Coupling {
    float before, after, across;
  };
  const Coupling* coupling;      // of each row
  const float* share;            // of each column: half, 1 at both sides
  const std::int32_t* alive[4];  // of row 0, as the membrane's; or null
  std::int32_t* sheared;         // then: -1 for cells with both diagonals, 0 for others
};

}  // namespace weft::physics
