// Strips of lines (strips.h).
#include "physics/stages/strips.h"

namespace weft::physics {

std::size_t Strips::bytes() const {
  std::size_t sum = 0;
  for (const StripMemory& m : memory_)
    sum += m.tile.bytes() + (m.scratch.size() + m.w.size()) * sizeof(float);
  return sum;
}

StripMemory Strips::make_memory() const {
  // Transposing reads and writes whole tiles of four columns.
  const int columns = lattice_.columns + 3;
  return {AlignedArray<float>(std::size_t(std::max(lattice_.rows, lattice_.columns)) * scratch_),
          Rows(columns, kStripLines), AlignedArray<float>(std::size_t(columns) * kStripLines)};
}

void Strips::turn(int begin, int rows, StripMemory& memory, bool there) {
  for (int half = 0; half < rows; half += 16) {
    const Row3 x = lattice_.x.row(begin + half), tile = memory.tile.row(0);
    TransposeRows t{};
    t.stride = lattice_.stride;
    t.pitch = kStripLines;
    t.row_count = std::min(16, rows - half);
    t.columns = lattice_.columns;
    float* const arrays[4][2] = {{x.x, tile.x},
                                 {x.y, tile.y},
                                 {x.z, tile.z},
                                 {lattice_.w(begin + half), memory.w.data()}};
    // The inverse masses do not change: only positions are turned back.
    for (int k = 0; k < (there ? 4 : 3); ++k) {
      t.rows = arrays[k][0];
      t.lanes = arrays[k][1] + half;
      there ? kernels_.rows_to_lanes(t) : kernels_.lanes_to_rows(t);
    }
  }
}

}  // namespace weft::physics
