// Of the list of near squares, those within a range in an interval (near_squares.h).
#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>

#include "physics/contact/self/near_squares.h"

namespace weft::physics {
namespace {

constexpr std::size_t kFewParticles = 4096;
constexpr std::size_t kAtOnce = 1024;  // pairs that are looked through in one go
// Runs after which a pair that was near is measured again, to sleep: that costs as much as to look for contacts.
constexpr std::size_t kTurns = 8;

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

// visit(square).
template <class Visit>
void NearSquares::share_squares(Threads& threads, const Visit& visit) const {
  const bool few = all_squares_ < kFewParticles;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    if (sheets_[s].mesh) continue;
    threads.share(std::size_t(sheets_[s].points->rows), few, [&](std::size_t j) {
      for (int i = 0; i < sheets_[s].columns; ++i) visit(std::size_t(named_[s].name(int(j), i)));
    });
  }
  for (const auto& part : parts_)
    threads.share((part->end - part->first + kAtOnce - 1) / kAtOnce, few, [&](std::size_t k) {
      const std::size_t first = part->first + k * kAtOnce;
      for (std::size_t n = first; n < std::min(part->end, first + kAtOnce); ++n) visit(n);
    });
}

void NearSquares::bound(const Place* place, const Displacement* moved, Threads& threads) {
  share_squares(threads, [&](std::size_t n) { bound_square(n, place, moved); });
}

void NearSquares::add_ways(const Displacement* moved, Threads& threads) {
  if (ways_.too_long()) wake();
  ways_.begin(moved);
  share_squares(threads, [&](std::size_t n) { ways_.add(n, moved); });
  ways_.end();
}

// Those that share a corner, first in within_.
void NearSquares::list_beside(bool all, const Place* place, Threads& threads) {
  beside_.list(ways_.beside(), all, passing_, threads);
  for (const auto& part : parts_) part->beside.list(place, passing_, threads);
  within_.count = 0;
  within_.add(beside_.pairs(), beside_.pairs().size());
  beside_count_ = within_.count;
  for (const auto& part : parts_) within_.add(part->beside.pairs(), part->beside.pairs().size());
}

// Of two boxes.
float NearSquares::box_gap(std::int32_t a, std::int32_t b) const {
  using Record = Eigen::Array4f;
  const SquareBox &p = boxes_[std::size_t(a)], &q = boxes_[std::size_t(b)];
  Record gap = (Record::Map(p.low) - Record::Map(q.high))
                   .max(Record::Map(q.low) - Record::Map(p.high))
                   .max(0.0f);
  gap *= gap;
  return std::sqrt(gap[0] + gap[1] + gap[2]);
}

// Of so many listed pairs those that are awake and whose boxes are within the range; others fall asleep.
void NearSquares::take_awake(std::size_t first, std::size_t count, float range, Room& room,
                             SquarePairs& found) {
  found.reserve(count);
  found.count = 0;
  room.awake.resize(kAtOnce + SquarePairs::kPadding);
  const std::int32_t *const owner = listed_.owner.data() + first, *const neighbour =
                                                                      listed_.neighbour.data() +
                                                                      first;
  float* const until = until_.data() + first;
  const int awake = kernels_.sheets.squares_awake(
      {int(count), owner, neighbour, until, ways_.anywhere().all.data(), room.awake.data()});
  for (int k = 0; k < awake; ++k) {
    const std::int32_t n = room.awake[std::size_t(k)], a = owner[n], b = neighbour[n];
    const float beyond = box_gap(a, b) - range;
    if (beyond > 0)
      until[n] = ways_.anywhere().until(a, b, beyond);
    else
      found.put(a, b, std::int32_t(first) + n);
  }
}

float& NearSquares::until(std::size_t pair) {
  const std::int32_t number = within_.number[pair];
  return pair < beside_count_ ? beside_.until(number) : until_[std::size_t(number)];
}

// Whether a pair of within_ comes nowhere near: `gap` is how far apart they are at least, 0 where that is not
// measured. Tells until when.
bool NearSquares::stays_away(std::size_t pair, float gap, float range, const Place* place) {
  const std::int32_t a = within_.owner[pair], b = within_.neighbour[pair];
  float& until = this->until(pair);
  const Ways& ways = pair < beside_count_ ? ways_.beside() : ways_.anywhere();
  const float came = ways.of_last(a, b);
  const auto sleep = [&](float farther) {
    until = farther > came ? ways.until(a, b, farther - came) : SquareWays::kAlways;
    return farther > came;
  };
  if (sleep(gap - range)) return true;
  if (pair >= beside_count_) return false;
  const float alike = beside_.alike(within_.number[pair], place);
  sleep(alike);
  return alike >= 0;
}

// Takes those out of a piece of within_ that come nowhere near. Measured are those that have slept, and others by
// turns. `first`: of the piece's pairs.
void NearSquares::put_to_sleep(std::size_t first, std::size_t count, float range,
                               const Place* place, Room& room, SquarePairs& kept) {
  for (auto* of : {&room.owner, &room.neighbour}) of->resize(kAtOnce + SquarePairs::kPadding);
  room.gap.resize(kAtOnce + SquarePairs::kPadding);
  room.asked.clear();
  for (std::size_t pair = first; pair < first + count; ++pair) {
    const std::int32_t number = within_.number[pair];
    if (number == SquarePairs::kNone) continue;
    if (until(pair) == SquareWays::kAlways && (std::size_t(number) + turn_) % kTurns != 0) continue;
    room.owner[room.asked.size()] = within_.owner[pair];
    room.neighbour[room.asked.size()] = within_.neighbour[pair];
    room.asked.push_back(pair);
  }
  std::fill_n(room.owner.begin() + std::ptrdiff_t(room.asked.size()), SquarePairs::kPadding, 0);
  std::fill_n(room.neighbour.begin() + std::ptrdiff_t(room.asked.size()), SquarePairs::kPadding, 0);
  kernels_.sheets.square_gaps({place, squares_.data(), int(room.asked.size()), room.owner.data(),
                               room.neighbour.data(), room.gap.data()});
  kept.reserve(count);
  kept.count = 0;
  std::size_t next = 0;
  for (std::size_t pair = first; pair < first + count; ++pair) {
    const bool asked = next < room.asked.size() && room.asked[next] == pair;
    const float gap = asked ? room.gap[next++] : 0;
    if (within_.number[pair] != SquarePairs::kNone && stays_away(pair, gap, range, place)) continue;
    kept.put(within_.owner[pair], within_.neighbour[pair], within_.number[pair]);
  }
}

const SquarePairs& NearSquares::within(float range, const Place* place, const Displacement* moved,
                                       Threads& threads) {
  within_range_ = range;
  ++turn_;
  add_ways(moved, threads);
  bound(place, moved, threads);
  list_beside(false, place, threads);
  until_.resize(listed_.count + SquarePairs::kPadding, SquareWays::kAtOnce);
  std::size_t pieces = (listed_.count + kAtOnce - 1) / kAtOnce;
  make_room(pieces);
  threads.share(pieces, pieces < 8, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(listed_.count - first, kAtOnce);
    take_awake(first, count, range, rooms_[k], found_[k]);
  });
  within_.add(found_, pieces);
  pieces = (within_.count + kAtOnce - 1) / kAtOnce;
  make_room(pieces);
  threads.share(pieces, pieces < 8, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(within_.count - first, kAtOnce);
    put_to_sleep(first, count, range, place, rooms_[k], found_[k]);
    keep_not_apart(range, place, moved, found_[k]);
  });
  within_.count = 0;
  within_.add(found_, pieces);
  return within_;
}

// Takes those out of within_, where so far are those that share a corner, that lie much alike.
void NearSquares::drop_alike(const Place* place) {
  std::size_t kept = 0;
  for (std::size_t pair = 0; pair < within_.count; ++pair) {
    if (pair < beside_count_ && beside_.alike(within_.number[pair], place) >= 0) continue;
    within_.owner[kept] = within_.owner[pair];
    within_.neighbour[kept] = within_.neighbour[pair];
    within_.number[kept++] = within_.number[pair];
  }
  within_.count = kept;
}

const SquarePairs& NearSquares::all_within(float range, const Place* place,
                                           const Displacement* moved, Threads& threads) {
  within_range_ = range;
  bound(place, moved, threads);
  list_beside(true, place, threads);
  drop_alike(place);
  const std::size_t pieces = (listed_.count + kAtOnce - 1) / kAtOnce;
  make_room(pieces);
  threads.share(pieces, pieces < 8, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(listed_.count - first, kAtOnce);
    SquarePairs& found = found_[k];
    found.reserve(count);
    found.count = std::size_t(kernels_.sheets.squares_within(
        {boxes_.data(), int(count), listed_.owner.data() + first, listed_.neighbour.data() + first,
         range, found.owner.data(), found.neighbour.data()}));
    keep_not_apart(range, place, moved, found);
  });
  within_.add(found_, pieces);
  return within_;
}

// But for pairs that a plane keeps apart.
void NearSquares::keep_not_apart(float range, const Place* place, const Displacement* moved,
                                 SquarePairs& found) const {
  std::int32_t *const owner = found.owner.data(), *const neighbour = found.neighbour.data(),
                      *const number = found.number.data();
  found.count = std::size_t(
      kernels_.sheets.squares_not_apart({place, moved, squares_.data(), int(found.count), owner,
                                         neighbour, number, range, owner, neighbour, number}));
}

void NearSquares::make_room(std::size_t pieces) {
  if (found_.size() < pieces) found_.resize(pieces);
  if (rooms_.size() < pieces) rooms_.resize(pieces);
}

const SquarePairs& NearSquares::still_within(float range, const Place* place,
                                             const Displacement* moved, Threads& threads) {
  assert(range <= within_range_);
  const std::size_t pieces = (within_.count + kAtOnce - 1) / kAtOnce;
  make_room(pieces);
  threads.share(pieces, pieces < 8, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(within_.count - first, kAtOnce);
    SquarePairs& found = found_[k];
    found.reserve(count);
    found.count = std::size_t(kernels_.sheets.squares_not_apart(
        {place, moved, squares_.data(), int(count), within_.owner.data() + first,
         within_.neighbour.data() + first, within_.number.data() + first, range, found.owner.data(),
         found.neighbour.data(), found.number.data()}));
  });
  still_.count = 0;
  still_.add(found_, pieces);
  return still_;
}

}  // namespace weft::physics
