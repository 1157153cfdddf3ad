// Particles in the cells of a grid as wide as a range, so that all within the range of a particle
// are in the 27 cells about its own.
//
// Cell (a,b,c) is bucket (a + b s + c s t) modulo the table's size, with s and t the box's true
// strides: cells that follow each other along x are neighbours in memory, and the 27 are nine runs
// of three. (Teschner et al. 2003 hash the three indices instead.)
//
// Particles are put in order of bucket, then of number, by a stable counting sort in two rounds
// without locks: shares of the particles count and deal them out to parts of the table, share after
// share within a part; then every part sorts its own. The order is the same for any threads.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/kernels/contact.h"
#include "physics/model/lattice/lattice.h"
#include "physics/step/threads.h"

namespace weft::physics {

class SpatialHash {
 public:
  static constexpr std::size_t kPadding = 16;

  explicit SpatialHash(const KernelTable& kernels) : kernels_(kernels) {}
  // Makes room for this many particles.
  void reserve(std::size_t particles);
  // Sorts particles, which have any names, into cells of `size` [m]; all lie in the box. (Positions of
  // kPadding more are read.)
  void build(ConstRow3 x, const std::int32_t* names, std::size_t particles, const Spread& box,
             float size, Threads& threads);

  std::size_t particles() const { return count_; }
  // Of the particles in sorted order: their buckets, names and positions (of these two kPadding lanes
  // before them and after, too).
  const std::int32_t* buckets() const { return bucket_.data(); }
  const std::int32_t* names() const { return name_.data() + kPadding; }
  ConstRow3 sorted() const {
    return {x_.data() + kPadding, y_.data() + kPadding, z_.data() + kPadding};
  }
  // Where the buckets start, one more than table().
  const std::int32_t* starts() const { return start_.data(); }
  std::int64_t table() const { return table_; }
  // From a bucket to the first of each of the nine runs about it, modulo the table.
  const std::int64_t* offsets() const { return offset_; }
  std::size_t bytes() const;

 private:
  static constexpr int kShares = 16, kParts = 64;  // of the particles, of the table

  void choose_strides(const int cells[3]);
  std::size_t share_begin(std::size_t share) const;
  void count(ConstRow3 x, int share);
  void deal(int share);
  void sort_part(ConstRow3 x, const std::int32_t* names, int part);

  const KernelTable& kernels_;
  std::size_t count_ = 0;
  std::int64_t table_ = 1, stride_y_ = 1, stride_z_ = 1;
  std::int64_t offset_[9] = {};
  bool wraps_ = false;
  int shift_ = 0;  // of a bucket to its part
  float low_[3] = {}, last_[3] = {}, inverse_ = 1;
  std::int32_t dealt_to_[kParts + 1][kShares] = {};  // where a share's particles of a part begin
  std::vector<std::int32_t> key_, dealt_, bucket_, start_;
  AlignedArray<std::int32_t> name_;  // padded
  AlignedArray<float> x_, y_, z_;    // padded
};

}  // namespace weft::physics
