// Who is within a range of whom: points sorted into cells (spatial_hash.h) and searched in shares of the
// sorted order, so that the result is the same for any threads. Points have names. Those of a sheet are
// named row after row, so that the difference of two names tells whether they lie beside each other there.
#pragma once

#include <algorithm>
#include <vector>

#include "physics/contact/self/spatial_hash.h"

namespace weft::physics {

// A flat sheet of points, where two at (i, j) and (i + a, j + b) are left out of the search when
// a² uu + 2 a b uv + b² vv < range².
struct NamedSheet {
  int columns, rows;
  float uu, uv, vv, range_squared;  // m²
  std::int32_t stride, first;
  std::int32_t name(int row, int column) const { return first + row * stride + column; }
};
// The steps of which that holds, but not with so much less a range [m²].
std::vector<SheetStep> steps_beyond(const NamedSheet& sheet, float range_squared);
// Chooses the first names, and makes the strides greater where need be, so that names differ by as much
// as those of neighbours for no others. Returns how many names there are, unused ones included.
std::size_t give_names(std::vector<NamedSheet>& sheets);

class PairSearch {
 public:
  static constexpr std::size_t kChunk = 256;  // points

  // With no sheets, none are left out.
  PairSearch(std::size_t most_points, const std::vector<NamedSheet>& sheets,
             const KernelTable& kernels);

  // Where to put the points, and their names.
  Row3 points() { return {x_.data(), y_.data(), z_.data()}; }
  std::int32_t* names() { return name_.data(); }

  // Sorts the first `count` points, all in the box, for searches within `range` [m].
  void sort(std::size_t count, const Spread& box, float range, Threads& threads);
  // Finds the pairs within a range [m], each listed once, by the first of the two in sorted order.
  // Points of sheets are listed by their names, others by their numbers in that order.
  void find(float range, Threads& threads);

  // Takes away those pairs for which drop(owner, neighbour) holds.
  template <class Drop>
  void drop(const Drop& drop, Threads& threads) {
    threads.share(chunks(), few(), [&](std::size_t k) {
      Chunk& c = chunks_[k];
      std::size_t kept = 0;
      for (std::size_t i = 0; i < c.found; ++i) {
        if (drop(c.owner[i], c.neighbour[i])) continue;
        c.owner[kept] = c.owner[i];
        c.neighbour[kept++] = c.neighbour[i];
      }
      c.found = kept;
    });
  }

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
  std::int32_t name(std::size_t sorted) const { return grid_.names()[sorted]; }
  // Whether one thread is faster.
  bool few() const { return count_ < 2048; }
  std::size_t bytes() const;

 private:
  struct Chunk {
    std::vector<std::int32_t> owner, neighbour;  // as long as each other
    std::size_t found = 0;
  };
  struct Room {  // of one thread, for the candidates of a cell
    std::vector<std::int32_t> name;
    std::vector<float> place;  // three arrays as long as `name`
  };
  void find_chunk(std::size_t k, float range, Room& room);

  const KernelTable& kernels_;
  std::size_t count_ = 0;
  std::vector<NearSheet> sheets_;
  std::vector<std::vector<NameWindow>> windows_;  // of every sheet
  std::vector<std::int32_t> name_;
  AlignedArray<float> x_, y_, z_;
  SpatialHash grid_;
  std::vector<Chunk> chunks_;
  std::vector<Room> rooms_;
};

}  // namespace weft::physics
