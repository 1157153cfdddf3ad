// Of the list of near squares, those within a range in an interval (near_squares.h).
#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "physics/contact/self/near_squares.h"

namespace weft::physics {
namespace {

constexpr std::size_t kFewParticles = 4096;
constexpr std::size_t kAtOnce = 1024;  // pairs that are looked through in one go
constexpr std::size_t kFewPieces = 8;  // that one thread does faster
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
  boxes_[n] = {{low[0], low[1], low[2]}, 0, {high[0], high[1], high[2]}, 0};
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

// The boxes about all, and how far all have come.
void NearSquares::bound(const Place* place, const Displacement* moved, Threads& threads) {
  if (ways_.too_long()) wake();
  ways_.begin(moved);
  share_squares(threads, [&](std::size_t n) {
    bound_square(n, place, moved);
    ways_.add(n, moved);
  });
  ways_.end();
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

// Whether a pair that may come so much farther before it is near comes nowhere near now. Tells until when it sleeps.
bool NearSquares::sleeps(const SquarePairs& pairs, std::size_t pair, const Ways& ways,
                         float farther, float& until) {
  const std::int32_t a = pairs.owner[pair], b = pairs.neighbour[pair];
  const float came = ways.of_last(a, b);
  until = farther > came ? ways.until(a, b, farther - came) : SquareWays::kAlways;
  return farther > came;
}

// Takes those out of a list for which drop(pair) holds.
template <class Drop>
void NearSquares::drop_pairs(SquarePairs& pairs, const Drop& drop) {
  const std::size_t count = std::exchange(pairs.count, 0);
  for (std::size_t pair = 0; pair < count; ++pair)
    if (!drop(pair)) pairs.put(pairs, pair);
  pairs.pad();
}

// Takes those out that come nowhere near by how far apart they are. Measured are those that have slept, and others by
// turns, where they could sleep for a while: what moves fast is as far apart at most as the skin. until(number): of a
// pair.
template <class Until>
void NearSquares::drop_far(SquarePairs& pairs, const Ways& ways, const Until& until, float range,
                           const Place* place, Room& room) {
  SquarePairs& asked = room.asked;
  asked.count = 0;
  asked.reserve(pairs.count);
  for (std::size_t pair = 0; pair < pairs.count; ++pair) {
    const std::int32_t number = pairs.number[pair];
    const bool due =
        until(number) != SquareWays::kAlways || (std::size_t(number) + turn_) % kTurns == 0;
    if (due && kTurns * ways.of_last(pairs.owner[pair], pairs.neighbour[pair]) < skin_)
      asked.put(pairs.owner[pair], pairs.neighbour[pair], std::int32_t(pair));
  }
  if (asked.count == 0) return;
  asked.pad();
  room.measured.resize(std::max(room.measured.size(), asked.count + SquarePairs::kPadding));
  kernels_.sheets.square_gaps({place, squares_.data(), int(asked.count), asked.owner.data(),
                               asked.neighbour.data(), room.measured.data()});
  std::size_t next = 0;
  drop_pairs(pairs, [&](std::size_t pair) {
    if (next == asked.count || asked.number[next] != std::int32_t(pair)) return false;
    const float farther = room.measured[next++] - range;
    return sleeps(pairs, pair, ways, farther, until(pairs.number[pair]));
  });
}

// Takes those out that share a corner and lie alike; they sleep.
void NearSquares::drop_alike(SquarePairs& pairs, const Place* place, Room& room) {
  room.measured.resize(std::max(room.measured.size(), pairs.count + SquarePairs::kPadding));
  beside_.alike(pairs.owner.data(), pairs.neighbour.data(), pairs.count, place,
                room.measured.data());
  drop_pairs(pairs, [&](std::size_t pair) {
    const float change = room.measured[pair];
    sleeps(pairs, pair, ways_.beside(), change, beside_.until(pairs.number[pair]));
    return change >= 0;
  });
}

// work(piece, its first, how many) for pieces of so many pairs; what each has found is added to a list.
template <class Work>
void NearSquares::add_pieces(std::size_t pairs, SquarePairs& to, Threads& threads,
                             const Work& work) {
  const std::size_t pieces = (pairs + kAtOnce - 1) / kAtOnce;
  if (found_.size() < pieces) found_.resize(pieces);
  if (rooms_.size() < pieces) rooms_.resize(pieces);
  threads.share(pieces, pieces < kFewPieces, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce;
    work(k, first, std::min(pairs - first, kAtOnce));
  });
  to.add(found_, pieces);
}

const SquarePairs& NearSquares::within(float range, const Place* place, const Displacement* moved,
                                       Threads& threads) {
  within_range_ = range;
  ++turn_;
  bound(place, moved, threads);
  awake_ = false;
  corner_pairs_.count = 0;
  beside_.list(ways_.beside(), passing_, threads);
  corner_pairs_.add(beside_.pairs(), beside_.pairs().size());
  within_.count = 0;
  add_pieces(corner_pairs_.count, within_, threads,
             [&](std::size_t k, std::size_t first, std::size_t count) {
               SquarePairs& found = found_[k];
               found.take(corner_pairs_, first, count);
               drop_far(
                   found, ways_.beside(),
                   [&](std::int32_t number) -> float& { return beside_.until(number); }, range,
                   place, rooms_[k]);
               drop_alike(found, place, rooms_[k]);
               keep_not_apart(range, place, moved, found);
             });
  corner_pairs_.count = 0;
  for (const auto& part : parts_) {
    part->beside.list(place, passing_, threads);
    corner_pairs_.add(part->beside.pairs(), part->beside.pairs().size());
  }
  add_pieces(corner_pairs_.count, within_, threads,
             [&](std::size_t k, std::size_t first, std::size_t count) {
               find_not_apart(corner_pairs_, first, count, range, place, moved, found_[k]);
             });
  add_pieces(listed_.count, within_, threads,
             [&](std::size_t k, std::size_t first, std::size_t count) {
               SquarePairs& found = found_[k];
               found.reserve(count);
               found.count = std::size_t(kernels_.sheets.squares_awake(
                   {boxes_.data(), int(count), listed_.owner.data() + first,
                    listed_.neighbour.data() + first, until_.data() + first,
                    ways_.anywhere().all.data(), range, std::int32_t(first), found.owner.data(),
                    found.neighbour.data(), found.number.data()}));
               drop_far(
                   found, ways_.anywhere(),
                   [&](std::int32_t number) -> float& { return until_[std::size_t(number)]; },
                   range, place, rooms_[k]);
               keep_not_apart(range, place, moved, found);
             });
  return within_;
}

// Of a piece of a list, but for pairs that a plane keeps apart.
void NearSquares::find_not_apart(const SquarePairs& pairs, std::size_t first, std::size_t count,
                                 float range, const Place* place, const Displacement* moved,
                                 SquarePairs& found) const {
  found.reserve(count);
  found.count = std::size_t(kernels_.sheets.squares_not_apart(
      {place, moved, squares_.data(), int(count), pairs.owner.data() + first,
       pairs.neighbour.data() + first, range, found.owner.data(), found.neighbour.data()}));
}

void NearSquares::keep_not_apart(float range, const Place* place, const Displacement* moved,
                                 SquarePairs& found) const {
  find_not_apart(found, 0, found.count, range, place, moved, found);
}

// Of pairs that share a corner, those of squares asked for.
void NearSquares::add_asked_beside(float range, float box_range, const Place* place,
                                   const Displacement* moved, Threads& threads) {
  beside_.list_asked(asked_, passing_, threads);
  corner_pairs_.count = 0;
  corner_pairs_.add(beside_.pairs(), beside_.pairs().size());
  add_pieces(corner_pairs_.count, still_, threads,
             [&](std::size_t k, std::size_t first, std::size_t count) {
               SquarePairs& found = found_[k];
               std::vector<float>& change = rooms_[k].measured;
               change.resize(kAtOnce + SquarePairs::kPadding);
               beside_.alike(corner_pairs_.owner.data() + first,
                             corner_pairs_.neighbour.data() + first, count, place, change.data());
               found.reserve(count);
               found.count = 0;
               for (std::size_t i = first; i < first + count; ++i)
                 if (!(change[i - first] >= 0)) found.put(corner_pairs_, i);
               keep_not_apart(range, place, moved, found);
             });
  corner_pairs_.count = 0;
  for (const auto& part : parts_)
    corner_pairs_.add(part->beside.pairs(), part->beside.pairs().size());
  add_asked(corner_pairs_, range, box_range, place, moved, threads);
}

// Of a list, those of squares asked for whose boxes are within a range.
void NearSquares::add_asked(const SquarePairs& pairs, float range, float box_range,
                            const Place* place, const Displacement* moved, Threads& threads) {
  add_pieces(pairs.count, still_, threads,
             [&](std::size_t k, std::size_t first, std::size_t count) {
               SquarePairs& found = found_[k];
               found.reserve(count);
               found.count = 0;
               for (std::size_t i = first; i < first + count; ++i) {
                 const std::int32_t a = pairs.owner[i], b = pairs.neighbour[i];
                 if ((asked_[std::size_t(a)] | asked_[std::size_t(b)]) && box_gap(a, b) < box_range)
                   found.put(pairs, i);
               }
               keep_not_apart(range, place, moved, found);
             });
}

const SquarePairs& NearSquares::still_within(float range, const Place* place,
                                             const Displacement* moved, Threads& threads) {
  assert(range <= within_range_);
  still_.count = 0;
  add_pieces(within_.count, still_, threads,
             [&](std::size_t k, std::size_t first, std::size_t count) {
               find_not_apart(within_, first, count, range, place, moved, found_[k]);
             });
  return still_;
}

const SquarePairs& NearSquares::strayed_within(float range, float most,
                                               const std::vector<std::uint8_t>& strayed,
                                               const Place* place, const Displacement* moved,
                                               Threads& threads) {
  share_squares(threads, [&](std::size_t n) {
    asked_[n] = has_corner_in(squares_[n], strayed);
    if (asked_[n]) bound_square(n, place, moved);
  });
  still_.count = 0;
  add_asked_beside(range, range + most, place, moved, threads);
  add_asked(listed_, range, range + most, place, moved, threads);
  return still_;
}

}  // namespace weft::physics
