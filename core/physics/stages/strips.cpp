// Strips of lines (strips.h).
#include "physics/stages/strips.h"

namespace weft::physics {

std::size_t Strips::bytes() const {
  std::size_t sum = 0;
  for (const StripMemory& m : memory_)
    sum += m.tile.bytes() + m.gained.bytes() + (m.scratch.size() + m.w.size()) * sizeof(float);
  return sum;
}

StripMemory Strips::make_memory() const {
  // Transposing reads and writes whole tiles of four columns.
  const int columns = lattice_.columns + 3;
  return {AlignedArray<float>(std::size_t(std::max(lattice_.rows, lattice_.columns)) * scratch_),
          Rows(columns, kStripLines), Rows(columns, kStripLines),
          AlignedArray<float>(std::size_t(columns) * kStripLines)};
}

void Strips::turn_there(int begin, int rows, StripMemory& memory) {
  for (int half = 0; half < rows; half += 16) {
    const Row3 x = lattice_.x.row(begin + half), tile = memory.tile.row(0);
    TransposeRows t = turning(half, rows);
    for (const auto& [from, to] : {std::pair(x.x, tile.x), std::pair(x.y, tile.y),
                                   std::pair(x.z, tile.z),
                                   std::pair(lattice_.w(begin + half), memory.w.data())}) {
      t.rows = from;
      t.lanes = to + half;
      kernels_.rows_to_lanes(t);
    }
  }
}

void Strips::turn_back(int begin, int rows, StripMemory& memory, bool velocities) {
  for (int half = 0; half < rows; half += 16)
    for (const bool add : {false, true}) {
      if (add && !velocities) continue;
      const Row3 to = (add ? lattice_.v : lattice_.x).row(begin + half);
      const Row3 from = (add ? memory.gained : memory.tile).row(0);
      TransposeRows t = turning(half, rows);
      t.add = add;
      for (const auto& [lanes, row] :
           {std::pair(from.x, to.x), std::pair(from.y, to.y), std::pair(from.z, to.z)}) {
        t.rows = row;
        t.lanes = lanes + half;
        kernels_.lanes_to_rows(t);
      }
    }
}

TransposeRows Strips::turning(int half, int rows) const {
  TransposeRows t{};
  t.stride = lattice_.stride;
  t.pitch = kStripLines;
  t.row_count = std::min(16, rows - half);
  t.columns = lattice_.columns;
  return t;
}

}  // namespace weft::physics
