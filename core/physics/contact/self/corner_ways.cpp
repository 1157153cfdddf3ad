// How far corners of squares have come from each other (corner_ways.h).
#include "physics/contact/self/corner_ways.h"

#include <algorithm>

namespace weft::physics {

CornerWays::CornerWays(const std::vector<Square>& squares, const KernelTable& kernels)
    : squares_(squares), kernels_(kernels) {}

void CornerWays::forget() {
  all_.assign(squares_.size() + kPacket, 0);
  last_.assign(squares_.size() + kPacket, 0);
}

bool CornerWays::too_long() const {
  return *std::max_element(all_.begin(), all_.end()) > kLongest;
}

void CornerWays::add(std::size_t first, int count, const Displacement* moved) {
  kernels_.sheets.corner_ways(
      {moved, squares_.data() + first, count, all_.data() + first, last_.data() + first});
}

}  // namespace weft::physics
