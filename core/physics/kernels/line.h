// What the kernels of line sweeps work on (kernels/line.cpp, membrane_line.cpp).
#pragma once

#include <cstddef>
#include <cstdint>

#include "physics/kernels/kernel_list.h"
#include "physics/kernels/rows.h"

namespace weft::physics {

// Lines solved side by side: two blocks of the widest registers, so that one block's division hides
// behind the other's.
inline constexpr int kBatchLines = 32;
// Floats of scratch for each particle of a batch.
inline constexpr int kBatchScratch = 3 * kBatchLines;

// A batch of neighbouring lines of one stencil, each a chain of particles. Particle m of line n lies
// `n + m*step` floats behind lane 0 of the first row, in lane n + m*lean of its row. Where that is
// beyond a side of the sheet, the line is cut and goes on at the other side, `columns` lanes from
// there, and so every line passes through all rows.
struct LineBatch {
  // Lane 0 of the row where lines start. Particles are at x + u: a line's corrections go into u, so that
  // positions do not round them.
  ConstRow3 x;
  Row3 u;                  // laid out as x [m]
  bool first_corrections;  // u is still zero
  const float* w;          // inverse mass, laid out as x [1/kg]
  std::ptrdiff_t step;
  int particles;  // rows that lines pass through
  int lean;
  int columns;
  int first;   // number of the batch's first line, a multiple of 16; it has up to kBatchLines
  float rest;  // m
  // Of constraint m of each line, [m][kBatchLines]; null: `rest` for all.
  const float* rests;
  // membrane_line_batch: squares of the rest lengths, laid out as x; null: those of `rest` [m²].
  const float* squares;
  // membrane_line_batch: steps of Newton's. A square is steeper than a length: large moves take two.
  int steps;
  float share;  // factor on the correction
  const float*
      compliance;  // [m][kBatchLines] of constraint m of each line [1/kg; of squares m²/kg]
  std::ptrdiff_t compliance_step;  // kBatchLines, or 0 when all rows are alike
  // -1 where constraint m of line n holds, 0 where it is cut, laid out as x; or null.
  const std::int32_t* alive;
  float* lambda;   // multipliers, laid out as x; null for a single sweep [kg·m; of squares kg]
  bool fresh;      // the multipliers are still zero, whatever the memory says
  float* scratch;  // particles * kBatchScratch floats
};

struct TransposeRows;  // kernels/transpose.h

// A batch of lines, each solved as a whole: of lengths, or of squared lengths; rows that become lanes for that,
// and rows again.
#define WEFT_LINE_KERNELS(KERNEL)                       \
  KERNEL(void, line_batch, (const LineBatch&))          \
  KERNEL(void, membrane_line_batch, (const LineBatch&)) \
  KERNEL(void, rows_to_lanes, (const TransposeRows&))   \
  KERNEL(void, lanes_to_rows, (const TransposeRows&))

struct LineKernels {
  WEFT_LINE_KERNELS(WEFT_KERNEL_MEMBER)
};

}  // namespace weft::physics
