// What the kernels of the membrane work on (kernels/membrane.cpp, membrane_squares.cpp,
// membrane_sweep.cpp).
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
  ConstRow3 x, u;  // row 0; particles are at x + u; no u: it is zero [m]
  // Of the cells between each row and the next, row 0; those that lean to the left may share the array of the others,
  // if nothing is damped [m²].
  float *diagonals, *antidiagonals;
  // Of edges along rows and between them; null: there is neither coupling nor damping.
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
  float rate;                    // damping over the substep, over 1 more; 0: nothing is damped
  SubstepStart start;
};

// A Gauss-Seidel sweep over a membrane's cells (kernels/membrane_sweep.cpp), those between rows j and j+1 for the j of
// begin … end-1 with j % 2 == colour. The component arrays of x, u and v lie equally far apart.
struct MembraneSweep {
  int begin, end, rows;
  int columns, stride;
  int colour;
  Row3 x, u;           // row 0; particles are at x + u, and u receives what moves them [m]
  const float* w;      // inverse mass of row 0 [1/kg]
  float per_u, per_v;  // one over the spacings along and across rows [1/m]
  // Of the cells after each row: their area, times the row's share of the stiffness and the square of the time that
  // forces have [m² s²].
  const float* scale;
  // One over stiffnesses [m/N]: of edges along and across, and in cells where something is torn; of γ; and with
  // coupling, of the sum of strains along and across, `sum` times those of each edge, and of their differences. No sum:
  // there is no coupling.
  float give_edge[2], give_torn[2], give_shear;
  float sum[2], give_sum, give_difference[2];
  float* stress;  // multipliers [N/m]: planes laid out as the lattice; null: a single sweep
  std::ptrdiff_t stress_plane;
  float rate;  // > 0: the sweep of damping, by so many substeps; 0: of strains
  SubstepStart start;
  // As the membrane's; null: cannot tear. Squared lengths past which they end, by stencil, or 0: the sweep ends none
  // [m²]; and how many have ended, added up by row.
  std::int32_t* alive[4];
  float longest_square[4];
  std::int32_t* ended;
};

}  // namespace weft::physics
