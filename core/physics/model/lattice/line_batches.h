// What stages share that solve whole lines of a lattice: batches of lines given out to threads, the
// memory of each thread, and rows turned into lanes and back.
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "physics/kernels/line.h"
#include "physics/kernels/transpose.h"
#include "physics/model/lattice/lattice.h"
#include "physics/model/lattice/tearing.h"
#include "physics/step/threads.h"

namespace weft::physics {

// The memory of one thread.
struct BatchMemory {
  AlignedArray<float> scratch;
  Rows
      tile;  // where the particles of kBatchLines rows are, as lanes: [column][kBatchLines] of x, y, z
  Rows corrections;  // that they gain there, laid out as the tile
};

// What is left of the links along the rows, turned into lanes as the tiles are: [column][kBatchLines]
// for every group of rows, turned anew only where some have died.
template <class T>
class TurnedLinks {
 public:
  TurnedLinks() = default;
  TurnedLinks(const Lattice& l, int groups)
      : columns_(l.columns), lanes_(std::size_t(groups) * size()), torn_(std::size_t(groups), -1) {}

  // The group's lanes, from `links`, laid out as the lattice; those of bending change at the end of a frame.
  const T* follow(int group, const LatticeTearing& tearing, const T* links) {
    const int begin = group * kBatchLines, end = std::min(begin + kBatchLines, tearing.rows());
    std::int64_t torn = 0;
    for (int j = begin; j < end; ++j)
      torn += std::is_same_v<T, float> ? tearing.followed(j) : tearing.torn(j);
    T* lanes = lanes_.data() + std::size_t(group) * size();
    if (torn == torn_[std::size_t(group)]) return lanes;
    torn_[std::size_t(group)] = torn;
    for (int j = begin; j < end; ++j)
      for (int i = 0; i < columns_; ++i)
        lanes[i * kBatchLines + j - begin] = links[std::size_t(j) * tearing.stride() + i];
    return lanes;
  }
  // The links were set anew: all groups are to be turned again.
  void forget() { std::fill(torn_.begin(), torn_.end(), -1); }
  std::size_t bytes() const { return lanes_.size() * sizeof(T); }

 private:
  std::size_t size() const { return std::size_t(columns_ + 3) * kBatchLines; }
  int columns_ = 0;
  AlignedArray<T> lanes_;
  std::vector<std::int64_t> torn_;  // of each group, when it was turned
};

class LineBatches {
 public:
  // `positions`: where particles are without their corrections. `corrections`: where solutions go, laid out as the
  // lattice; `scratch`: floats for each particle of a batch.
  LineBatches(const Lattice& lattice, Rows& positions, Rows& corrections,
              const KernelTable& kernels, int scratch);

  int row_groups() const { return (lattice_.rows + kBatchLines - 1) / kBatchLines; }
  std::size_t bytes() const;

  // Before share_out: for which threads.
  void begin(Threads& threads) {
    threads_ = &threads;
    while (int(memory_.size()) < threads.count()) memory_.push_back(make_memory());
  }

  // Calls solve(n, memory) for n = 0 … count-1, each worth about `nanoseconds`, in any order.
  template <class Solve>
  void share_out(int count, double nanoseconds, const Solve& solve) {
    if (threads_->count() == 1 || count * nanoseconds < kSharedNanoseconds) {
      for (int n = 0; n < count; ++n) solve(n, memory_[0]);
      return;
    }
    threads_->share(std::size_t(count), false,
                    [&](std::size_t n) { solve(int(n), memory_[std::size_t(Threads::index())]); });
  }

  // Turns a group's rows of an array that is laid out as the lattice, from row 0 on, into lanes, with those of
  // another added, if given.
  void turn(const float* rows, const float* added, int group, float* lanes) const;

  // Inverse masses of a group's rows as lanes, laid out as the tile.
  const float* masses(int group) const { return masses_.data() + masses_at(group); }
  // They are turned once, again when told so, or every time where they may change.
  void turn_masses();
  void follow_masses() { masses_change_ = true; }

  // Turns the rows of a group, corrected, into the lanes of a tile, solves, and turns back the corrections that
  // they gain there, which are zero before. solve gets the number of rows.
  template <class Solve>
  void turned(int group, BatchMemory& memory, const Solve& solve) {
    turn_there(group, memory);
    solve(rows_of(group));
    turn_back(group, memory);
  }

 private:
  // The least work worth sharing out [ns].
  static constexpr double kSharedNanoseconds = 40000;

  BatchMemory make_memory() const;
  TransposeRows turning(int half, int rows) const;
  int rows_of(int group) const {
    return std::min(kBatchLines, lattice_.rows - group * kBatchLines);
  }
  void turn_there(int group, BatchMemory& memory);
  std::size_t masses_at(int group) const {
    return std::size_t(group) * turned_columns(lattice_.columns) * kBatchLines;
  }
  void turn_masses(int group);
  void turn_back(int group, BatchMemory& memory);

  const Lattice& lattice_;
  Rows &positions_, &corrections_;
  const KernelTable& kernels_;
  int scratch_;
  AlignedArray<float> masses_;
  bool masses_change_ = false;
  Threads* threads_ = nullptr;
  std::vector<BatchMemory> memory_;  // of every thread
};

}  // namespace weft::physics
