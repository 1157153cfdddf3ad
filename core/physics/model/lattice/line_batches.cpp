// LineBatches of lines (batches.h).
#include "physics/model/lattice/line_batches.h"

#include <utility>

namespace weft::physics {

LineBatches::LineBatches(const Lattice& lattice, Rows& positions, Rows& corrections,
                         const KernelTable& kernels, int scratch)
    : lattice_(lattice),
      positions_(positions),
      corrections_(corrections),
      kernels_(kernels),
      scratch_(scratch),
      masses_(masses_at(row_groups())) {
  turn_masses();
}

void LineBatches::turn_masses() {
  for (int group = 0; group < row_groups(); ++group) turn_masses(group);
}

std::size_t LineBatches::bytes() const {
  std::size_t sum = masses_.size() * sizeof(float);
  for (const BatchMemory& m : memory_)
    sum += m.tile.bytes() + m.corrections.bytes() + m.scratch.size() * sizeof(float);
  return sum;
}

BatchMemory LineBatches::make_memory() const {
  const int columns = turned_columns(lattice_.columns);
  return {AlignedArray<float>(std::size_t(std::max(lattice_.rows, lattice_.columns)) * scratch_),
          Rows(columns, kBatchLines), Rows(columns, kBatchLines)};
}

void LineBatches::turn_there(int group, BatchMemory& memory) {
  if (masses_change_) turn_masses(group);
  const Row3 x = positions_.row(0), u = corrections_.row(0), tile = memory.tile.row(0);
  turn(x.x, u.x, group, tile.x);
  turn(x.y, u.y, group, tile.y);
  turn(x.z, u.z, group, tile.z);
  memory.corrections.clear();
}

void LineBatches::turn_masses(int group) {
  turn(lattice_.w(0), nullptr, group, masses_.data() + masses_at(group));
}

void LineBatches::turn(const float* from, const float* added, int group, float* lanes) const {
  const int rows = rows_of(group);
  for (int half = 0; half < rows; half += 16) {
    TransposeRows t = turning(half, rows);
    const std::ptrdiff_t first = std::ptrdiff_t(group * kBatchLines + half) * lattice_.stride;
    t.rows = const_cast<float*>(from) + first;  // on the way there they are only read
    if (added) t.added = added + first;
    t.lanes = lanes + half;
    kernels_.lines.rows_to_lanes(t);
  }
}

void LineBatches::turn_back(int group, BatchMemory& memory) {
  const int rows = rows_of(group), begin = group * kBatchLines;
  const Row3 from = memory.corrections.row(0);
  for (int half = 0; half < rows; half += 16) {
    const Row3 to = corrections_.row(begin + half);
    TransposeRows t = turning(half, rows);
    for (const auto& [lanes, row] :
         {std::pair(from.x, to.x), std::pair(from.y, to.y), std::pair(from.z, to.z)}) {
      t.lanes = lanes + half;
      t.rows = row;
      kernels_.lines.lanes_to_rows(t);
    }
  }
}

TransposeRows LineBatches::turning(int half, int rows) const {
  TransposeRows t{};
  t.stride = lattice_.stride;
  t.pitch = kBatchLines;
  t.row_count = std::min(16, rows - half);
  t.columns = lattice_.columns;
  return t;
}

}  // namespace weft::physics
