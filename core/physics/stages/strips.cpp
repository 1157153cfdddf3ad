// Strips of lines (strips.h).
#include "physics/stages/strips.h"

namespace weft::physics {

Strips::Strips(Lattice& lattice, const KernelTable& kernels, int scratch)
    : lattice_(lattice),
      kernels_(kernels),
      scratch_(scratch),
      // Transposing reads and writes whole tiles of four columns.
      masses_(std::size_t(row_groups()) * (lattice.columns + 3) * kStripLines) {
  turn_masses();
}

void Strips::turn_masses() {
  for (int group = 0; group < row_groups(); ++group)
    turn_masses(group, std::min(kStripLines, lattice_.rows - group * kStripLines));
}

std::size_t Strips::bytes() const {
  std::size_t sum = masses_.size() * sizeof(float);
  for (const StripMemory& m : memory_)
    sum += m.tile.bytes() + m.gained.bytes() + m.scratch.size() * sizeof(float);
  return sum;
}

StripMemory Strips::make_memory() const {
  const int columns = lattice_.columns + 3;
  return {AlignedArray<float>(std::size_t(std::max(lattice_.rows, lattice_.columns)) * scratch_),
          Rows(columns, kStripLines), Rows(columns, kStripLines)};
}

void Strips::turn_there(int group, int rows, StripMemory& memory) {
  if (masses_change_) turn_masses(group, rows);
  for (int half = 0; half < rows; half += 16) {
    const Row3 x = lattice_.x.row(group * kStripLines + half), tile = memory.tile.row(0);
    TransposeRows t = turning(half, rows);
    for (const auto& [from, to] :
         {std::pair(x.x, tile.x), std::pair(x.y, tile.y), std::pair(x.z, tile.z)}) {
      t.rows = from;
      t.lanes = to + half;
      kernels_.rows_to_lanes(t);
    }
  }
}

void Strips::turn_masses(int group, int rows) {
  for (int half = 0; half < rows; half += 16) {
    TransposeRows t = turning(half, rows);
    t.rows = lattice_.w(group * kStripLines + half);
    t.lanes = masses_.data() + std::size_t(group) * (lattice_.columns + 3) * kStripLines + half;
    kernels_.rows_to_lanes(t);
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
