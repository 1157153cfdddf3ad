// Who is within a range of whom: points sorted into cells (cell_grid.h) and searched in shares of the
// sorted order, so that the result is the same for any threads. Points have a place on a sheet; those
// that are neighbours there are no pairs.
#pragma once

#include <algorithm>
#include <vector>

#include "physics/self_collision/cell_grid.h"

namespace weft::physics {

// One particle: which of the sheets, row and column.
struct Site {
  std::uint16_t cloth, row, column;
};

// A flat sheet: two at (i, j) and (i + a, j + b) are neighbours there, and no pair, when
// a² uu + 2 a b uv + b² vv < range².
struct RestMetric {
  int columns, rows;
  float uu, uv, vv, range_squared;  // m²
};

class PairSearch {
 public:
  static constexpr std::size_t kChunk = 128;  // points

  // `metrics`: of every sheet; `once`: each pair is listed by the first of the two alone, else by both.
  PairSearch(std::size_t most_points, const std::vector<RestMetric>& metrics, bool once,
             const KernelTable& kernels);

  // Where to put the points, and what they are.
  Row3 points() { return {x_.data(), y_.data(), z_.data()}; }
  std::vector<Site>& sites() { return sites_; }

  // Sorts the first `count` points, all in the box, for searches within `range` [m].
  void sort(std::size_t count, const Spread& box, float range, Threads& threads);
  // Finds the pairs within a range [m]. They are listed by the sorted points' numbers, or by `names`
  // of these, padded as those of a grid.
  void find(float range, Threads& threads, const std::int32_t* names = nullptr);

  // Sorted points are cut into chunks: chunk k has those from begin(k) to begin(k + 1), and the pairs
  // that they list, one point's after another's.
  std::size_t count() const { return count_; }
  std::size_t chunks() const { return (count_ + kChunk - 1) / kChunk; }
  std::size_t begin(std::size_t k) const { return std::min(k * kChunk, count_); }
  struct Pairs {
    const std::int32_t *owner, *neighbour;  // and 16 more of any
    std::size_t count;
  };
  Pairs pairs(std::size_t k) const {
    const Chunk& c = chunks_[k];
    return {c.owner.data(), c.neighbour.data(), c.found};
  }
  const Site& site(std::size_t sorted) const { return sorted_sites_[sorted]; }
  // Whether one thread is faster.
  bool few() const { return count_ < 2048; }
  std::size_t bytes() const;

 private:
  struct Chunk {
    std::vector<std::int32_t> owner, neighbour;  // as long as each other
    std::size_t found = 0;
  };
  struct Room {  // of one thread, for the candidates of a cell
    std::vector<std::int32_t> number;
    std::vector<float> place;  // five arrays as long as `number`
  };
  void find_chunk(std::size_t k, float range, Room& room, const std::int32_t* names);

  // Where a particle lies on its flat sheet: u = column + shear row, w = height row, in spacings of
  // its columns; and below which distance squared two of them are no pair.
  struct FlatSheet {
    float begin, shear, height, apart_squared;
  };

  const KernelTable& kernels_;
  const bool once_;
  std::size_t count_ = 0;
  std::vector<FlatSheet> flat_;
  std::vector<Site> sites_, sorted_sites_;
  AlignedArray<float> x_, y_, z_;
  CellGrid grid_;
  AlignedArray<float> u_, w_, apart_squared_;  // as sorted
  std::vector<Chunk> chunks_;
  std::vector<Room> rooms_;
};

}  // namespace weft::physics
