// Lists of pairs of squares (square_pairs.h).
#include "physics/contact/self/square_pairs.h"

#include <algorithm>

namespace weft::physics {

void SquarePairs::reserve(std::size_t pairs) {
  if (owner.size() >= pairs + kPadding) return;
  owner.resize(2 * pairs + kPadding);
  neighbour.resize(owner.size());
  number.resize(owner.size());
}

void SquarePairs::pad() {
  reserve(count);
  for (std::vector<std::int32_t>* of : {&owner, &neighbour})
    std::fill_n(of->data() + count, kPadding, 0);
}

void SquarePairs::take(const SquarePairs& from, std::size_t first, std::size_t how_many) {
  reserve(how_many);
  std::copy_n(from.owner.data() + first, how_many, owner.data());
  std::copy_n(from.neighbour.data() + first, how_many, neighbour.data());
  std::copy_n(from.number.data() + first, how_many, number.data());
  count = how_many;
  pad();
}

void SquarePairs::add(const std::vector<SquarePairs>& pieces, std::size_t how_many) {
  for (std::size_t k = 0; k < how_many; ++k) {
    const SquarePairs& found = pieces[k];
    reserve(count + found.count);
    std::copy_n(found.owner.data(), found.count, owner.data() + count);
    std::copy_n(found.neighbour.data(), found.count, neighbour.data() + count);
    std::copy_n(found.number.data(), found.count, number.data() + count);
    count += found.count;
  }
  pad();
}

std::size_t SquarePairs::bytes() const {
  return owner.capacity() * 3 * sizeof(std::int32_t);
}

}  // namespace weft::physics
