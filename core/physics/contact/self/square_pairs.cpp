// Lists of pairs of squares (square_pairs.h).
#include "physics/contact/self/square_pairs.h"

#include <algorithm>

namespace weft::physics {

void SquarePairs::reserve(std::size_t pairs) {
  if (owner.size() >= pairs + kPadding) return;
  owner.resize(2 * pairs + kPadding);
  neighbour.resize(owner.size());
}

void SquarePairs::pad() {
  reserve(count);
  for (std::vector<std::int32_t>* of : {&owner, &neighbour})
    std::fill_n(of->data() + count, kPadding, 0);
}

std::size_t SquarePairs::bytes() const {
  return owner.capacity() * 2 * sizeof(std::int32_t);
}

}  // namespace weft::physics
