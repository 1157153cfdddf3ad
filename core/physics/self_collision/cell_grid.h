// Particles in the cells of a grid as wide as a range, so that all within the range of a particle
// are in the 27 cells about its own.
//
// Cell (a,b,c) is bucket (a + b s + c s t) modulo the table's size, with s and t the box's true
// strides: cells that follow each other along x are neighbours in memory, and the 27 are nine runs
// of three. Particles are put in order of bucket, then of number, by a counting sort: no locks, and
// the same order however it is done. (Teschner et al. 2003 hash the three indices instead.)
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "physics/lattice.h"

namespace weft::physics {

class CellGrid {
 public:
  // Makes room for this many particles.
  void reserve(std::size_t particles);
  // Sorts particles into cells of `size` [m]; all lie in the box from low to high.
  void build(ConstRow3 x, std::size_t particles, const float low[3], const float high[3],
             float size);

  std::size_t particles() const { return count_; }
  // Numbers of the particles in sorted order.
  std::int32_t number(std::size_t sorted) const { return number_[sorted]; }
  // Positions in sorted order.
  ConstRow3 sorted(std::size_t first) const {
    return {x_.data() + first, y_.data() + first, z_.data() + first};
  }
  // One past the last particle of the bucket that starts at `sorted`.
  std::size_t bucket_end(std::size_t sorted) const {
    return std::size_t(start_[std::size_t(key_of_sorted(sorted)) + 1]);
  }
  // The first start of a bucket at or after `sorted`.
  std::size_t bucket_start_from(std::size_t sorted) const;

  // The runs of the 27 cells about the bucket of a sorted particle, at most 18; returns how many.
  int runs_about(std::size_t sorted, Run* runs) const;
  std::size_t bytes() const;

 private:
  std::int32_t key_of_sorted(std::size_t sorted) const {
    return key_[std::size_t(number_[sorted])];
  }
  void choose_strides(const int cells[3]);
  std::int64_t offset_[9] = {};  // from a bucket to the first of each of the nine runs about it

  std::size_t count_ = 0;
  std::int64_t table_ = 1, stride_y_ = 1, stride_z_ = 1;
  std::vector<std::int32_t> key_, number_, start_;
  AlignedArray<float> x_, y_, z_;  // 16 more than particles
};

}  // namespace weft::physics
