// Of the list of near squares, those within a range in an interval (near_squares.h).
#include <Eigen/Core>
#include <algorithm>
#include <cassert>

#include "physics/contact/self/near_squares.h"

namespace weft::physics {
namespace {

constexpr std::size_t kFewParticles = 4096;
constexpr std::size_t kAtOnce = 1024;  // pairs that are looked through in one go

}  // namespace

// The box about a square in an interval. Whole records, four floats at once.
void NearSquares::bound_square(std::size_t n, const Place* place, const Displacement* moved) {
  using Record = Eigen::Array4f;
  const std::int32_t* const corner = squares_[n].corner;
  Record low = Record::Map(place[corner[0]].x), high = low;
  for (int c = 0; c < 4; ++c) {
    const Record from = Record::Map(place[corner[c]].x);
    const Record to = from + Record::Map(moved[corner[c]].u);
    low = low.min(from).min(to);
    high = high.max(from).max(to);
  }
  boxes_[n] = {{low[0], low[1], low[2]}, 1, {high[0], high[1], high[2]}, 0};
}

// Of all squares; and how those of grids lie at the interval's start.
void NearSquares::bound(const Place* place, const Displacement* moved, Threads& threads) {
  const bool few = all_squares_ < kFewParticles;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    if (sheets_[s].mesh) continue;
    threads.share(std::size_t(sheets_[s].points->rows), few, [&](std::size_t j) {
      for (int i = 0; i < sheets_[s].columns; ++i)
        bound_square(std::size_t(named_[s].name(int(j), i)), place, moved);
      beside_.measure_row(s, int(j), place);
    });
  }
  for (const auto& part : parts_)
    threads.share((part->end - part->first + kAtOnce - 1) / kAtOnce, few, [&](std::size_t k) {
      const std::size_t first = part->first + k * kAtOnce;
      for (std::size_t n = first; n < std::min(part->end, first + kAtOnce); ++n)
        bound_square(n, place, moved);
    });
}

const SquarePairs& NearSquares::within(float range, const Place* place, const Displacement* moved,
                                       Threads& threads) {
  within_range_ = range;
  bound(place, moved, threads);
  beside_.list(passing_, threads);
  for (const auto& part : parts_) part->beside.list(place, passing_, threads);
  const std::size_t pieces = (listed_.count + kAtOnce - 1) / kAtOnce;
  if (found_.size() < pieces) found_.resize(pieces);
  threads.share(pieces, pieces < 8, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(listed_.count - first, kAtOnce);
    SquarePairs& found = found_[k];
    found.reserve(count);
    std::int32_t *const owner = found.owner.data(), *const neighbour = found.neighbour.data();
    const int near =
        kernels_.sheets.squares_within({boxes_.data(), int(count), listed_.owner.data() + first,
                                        listed_.neighbour.data() + first, range, owner, neighbour});
    found.count = std::size_t(kernels_.sheets.squares_not_apart(
        {place, moved, squares_.data(), near, owner, neighbour, range, owner, neighbour}));
  });
  within_.count = 0;
  within_.add(beside_.pairs(), beside_.pairs().size());
  for (const auto& part : parts_) within_.add(part->beside.pairs(), part->beside.pairs().size());
  within_.add(found_, pieces);
  return within_;
}

const SquarePairs& NearSquares::still_within(float range, const Place* place,
                                             const Displacement* moved, Threads& threads) {
  assert(range <= within_range_);
  const std::size_t pieces = (within_.count + kAtOnce - 1) / kAtOnce;
  if (found_.size() < pieces) found_.resize(pieces);
  threads.share(pieces, pieces < 8, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(within_.count - first, kAtOnce);
    SquarePairs& found = found_[k];
    found.reserve(count);
    found.count = std::size_t(kernels_.sheets.squares_not_apart(
        {place, moved, squares_.data(), int(count), within_.owner.data() + first,
         within_.neighbour.data() + first, range, found.owner.data(), found.neighbour.data()}));
  });
  still_.count = 0;
  still_.add(found_, pieces);
  return still_;
}

}  // namespace weft::physics
