// The list of near squares in order, and until when its pairs sleep (near_squares.h).
#include <algorithm>
#include <utility>

#include "physics/contact/self/near_squares.h"

namespace weft::physics {

// In place of all listed pairs of the squares asked for.
void NearSquares::take_found() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < listed_.count; ++i) {
    if (asked_[std::size_t(listed_.owner[i])] || asked_[std::size_t(listed_.neighbour[i])])
      continue;
    listed_.owner[kept] = listed_.owner[i];
    until_[kept] = until_[i];
    listed_.neighbour[kept++] = listed_.neighbour[i];
  }
  until_.resize(kept);
  for (std::size_t k = 0; k < search_.chunks(); ++k) {
    const SquarePairs& found = found_[k];
    listed_.reserve(kept + found.count);
    std::copy_n(found.owner.data(), found.count, listed_.owner.data() + kept);
    std::copy_n(found.neighbour.data(), found.count, listed_.neighbour.data() + kept);
    kept += found.count;
    until_.resize(kept, SquareWays::kAtOnce);
  }
  listed_.count = kept;
  listed_.pad();
}

// By their owners, and those of one owner by their neighbours: a stable counting sort by each, the second first.
void NearSquares::sort_listed() {
  sort_by(&SquarePairs::neighbour);
  sort_by(&SquarePairs::owner);
}

void NearSquares::sort_by(std::vector<std::int32_t> SquarePairs::*number) {
  const std::int32_t* const of = (listed_.*number).data();
  std::fill(begin_.begin(), begin_.end(), 0);
  for (std::size_t i = 0; i < listed_.count; ++i) ++begin_[std::size_t(of[i]) + 1];
  for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
  within_.reserve(listed_.count);
  sorted_until_.resize(listed_.count);
  for (std::size_t i = 0; i < listed_.count; ++i) {
    const auto at = std::size_t(begin_[std::size_t(of[i])]++);
    within_.owner[at] = listed_.owner[i];
    within_.neighbour[at] = listed_.neighbour[i];
    sorted_until_[at] = until_[i];
  }
  within_.count = listed_.count;
  within_.pad();
  std::swap(listed_, within_);
  std::swap(until_, sorted_until_);
}

// Pairs that were on the list before all was listed anew sleep on. Both are sorted.
void NearSquares::sleep_as_before() {
  const auto key = [](const SquarePairs& of, std::size_t k) {
    return std::pair(of.owner[k], of.neighbour[k]);
  };
  std::size_t old = 0;
  for (std::size_t i = 0; i < listed_.count && old < before_.count; ++i) {
    while (old < before_.count && key(before_, old) < key(listed_, i)) ++old;
    if (old < before_.count && key(before_, old) == key(listed_, i)) until_[i] = before_until_[old];
  }
}

}  // namespace weft::physics
