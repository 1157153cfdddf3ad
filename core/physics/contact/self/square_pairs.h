// Lists of pairs of squares, and squares by their marked corners.
#pragma once

#include <cstdint>
#include <vector>

#include "physics/kernels/surface.h"

namespace weft::physics {

// Numbers of squares, two by two, with what kernels may read and write beyond the last.
struct SquarePairs {
  static constexpr std::size_t kPadding = 32;
  std::vector<std::int32_t> owner, neighbour;
  std::vector<std::int32_t> number;  // of each, of one's own
  std::size_t count = 0;
  void reserve(std::size_t pairs);
  void pad();
  // One more, for which there is room.
  void put(std::int32_t a, std::int32_t b, std::int32_t at) {
    owner[count] = a;
    neighbour[count] = b;
    number[count++] = at;
  }
  void put(const SquarePairs& of, std::size_t pair) {
    put(of.owner[pair], of.neighbour[pair], of.number[pair]);
  }
  // Becomes so many pairs of another list.
  void take(const SquarePairs& from, std::size_t first, std::size_t how_many);
  // The pairs of so many pieces, piece after piece.
  void add(const std::vector<SquarePairs>& pieces, std::size_t how_many);
  std::size_t bytes() const;
};

// Whether one of a square's four vertices is marked. Empty: none is.
inline bool has_corner_in(const Square& square, const std::vector<std::uint8_t>& marked) {
  if (marked.empty()) return false;
  const auto at = [&](int c) { return marked[std::size_t(square.corner[c])]; };
  return (at(0) | at(1) | at(2) | at(3)) != 0;
}

}  // namespace weft::physics
