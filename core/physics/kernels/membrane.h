// What the kernel of the membrane works on (kernels/membrane.cpp).
#pragma once

#include "physics/kernels/kernels.h"

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
};

}  // namespace weft::physics
