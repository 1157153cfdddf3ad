// LineBatches of lines (batches.h).
#include "physics/model/lattice/line_batches.h"

#include <tuple>

namespace weft::physics {

LineBatches::LineBatches(Lattice& lattice, const KernelTable& kernels, int scratch)
    : lattice_(lattice), kernels_(kernels), scratch_(scratch), masses_(masses_at(row_groups())) {
  turn_masses();
}

void LineBatches::turn_masses() {
  for (int group = 0; group < row_groups(); ++group) turn_masses(group);
}

std::size_t LineBatches::bytes() const {
  std::size_t sum = masses_.size() * sizeof(float);
  for (const BatchMemory& m : memory_)
    sum += m.tile.bytes() + m.moved.bytes() + m.scratch.size() * sizeof(float);
  return sum;
}

BatchMemory LineBatches::make_memory() const {
  const int columns = turned_columns(lattice_.columns);
  return {AlignedArray<float>(std::size_t(std::max(lattice_.rows, lattice_.columns)) * scratch_),
          Rows(columns, kBatchLines), Rows(columns, kBatchLines)};
}

void LineBatches::turn_there(int group, BatchMemory& memory) {
  if (masses_change_) turn_masses(group);
  const Row3 x = lattice_.x.row(0), tile = memory.tile.row(0);
  turn(x.x, group, tile.x);
  turn(x.y, group, tile.y);
  turn(x.z, group, tile.z);
}

void LineBatches::turn_masses(int group) {
  turn(lattice_.w(0), group, masses_.data() + masses_at(group));
}

void LineBatches::turn(const float* from, int group, float* lanes) const {
  const int rows = rows_of(group);
  for (int half = 0; half < rows; half += 16) {
    TransposeRows t = turning(half, rows);
    // Rows are only read on the way there.
    t.rows =
        const_cast<float*>(from) + std::ptrdiff_t(group * kBatchLines + half) * lattice_.stride;
    t.lanes = lanes + half;
    kernels_.lines.rows_to_lanes(t);
  }
}

// Where velocities gain what particles move by, positions do so at once: both from the same lanes.
void LineBatches::turn_back(int begin, int rows, BatchMemory& memory, float inverse_dt) {
  const Row3 from = (inverse_dt > 0 ? memory.moved : memory.tile).row(0);
  for (int half = 0; half < rows; half += 16) {
    const Row3 x = lattice_.x.row(begin + half), v = lattice_.v.row(begin + half);
    TransposeRows t = turning(half, rows);
    t.rate = inverse_dt;
    for (const auto& [lanes, row, rates] :
         {std::tuple(from.x, x.x, v.x), std::tuple(from.y, x.y, v.y),
          std::tuple(from.z, x.z, v.z)}) {
      t.lanes = lanes + half;
      t.rows = row;
      t.rates = inverse_dt > 0 ? rates : nullptr;
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
