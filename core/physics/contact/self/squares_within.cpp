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
// Runs, or lists pruned, after which a pair that was near is measured again, to sleep: that costs as much as to look for
// contacts.
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

// How far corners have come from each other.
void NearSquares::come_apart(const Displacement* moved, Threads& threads) {
  if (ways_.too_long()) wake();
  const bool few = all_squares_ < kFewParticles;
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    if (!sheets_[s].mesh)
      threads.share(std::size_t(sheets_[s].points->rows), few, [&](std::size_t j) {
        ways_.add(std::size_t(named_[s].name(int(j), 0)), sheets_[s].columns, moved);
      });
  awake_ = false;
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

// Takes those out of a list for which drop(pair) holds.
template <class Drop>
void NearSquares::drop_pairs(SquarePairs& pairs, const Drop& drop) {
  const std::size_t count = std::exchange(pairs.count, 0);
  for (std::size_t pair = 0; pair < count; ++pair)
    if (!drop(pair)) pairs.put(pairs, pair);
  pairs.pad();
}

// Takes those out of a list for which sleeps(pair, how far apart its squares are) holds. Measured are those that have
// slept, by until(number), and others by turns.
template <class Until, class Sleeps>
void NearSquares::drop_asleep(SquarePairs& pairs, std::size_t turn, const Until& until,
                              const Place* place, Room& room, const Sleeps& sleeps) const {
  SquarePairs& asked = room.asked;
  asked.count = 0;
  asked.reserve(pairs.count);
  for (std::size_t pair = 0; pair < pairs.count; ++pair) {
    const std::int32_t number = pairs.number[pair];
    if (until(number) != CornerWays::kAlways || (std::size_t(number) + turn) % kTurns == 0)
      asked.put(pairs.owner[pair], pairs.neighbour[pair], std::int32_t(pair));
  }
  if (asked.count == 0) return;
  asked.pad();
  std::vector<float>& gap = room.measured;
  gap.resize(std::max(gap.size(), asked.count + SquarePairs::kPadding));
  kernels_.sheets.square_gaps({place, squares_.data(), int(asked.count), asked.owner.data(),
                               asked.neighbour.data(), gap.data()});
  std::size_t next = 0;
  drop_pairs(pairs, [&](std::size_t pair) {
    if (next == asked.count || asked.number[next] != std::int32_t(pair)) return false;
    return sleeps(pair, gap[next++]);
  });
}

// Takes those out of the list that cannot come within range; they sleep.
void NearSquares::drop_beyond_allowances(SquarePairs& pairs, float range, const Place* place,
                                         Room& room) {
  const auto until = [&](std::int32_t number) -> float& { return until_[std::size_t(number)]; };
  drop_asleep(pairs, prunes_, until, place, room, [&](std::size_t pair, float gap) {
    const auto a = std::size_t(pairs.owner[pair]), b = std::size_t(pairs.neighbour[pair]);
    const float beyond = gap - range - (allowance_[a] + allowance_[b]);
    until(pairs.number[pair]) =
        beyond > 0 ? (way_[a] + way_[b] + beyond) * kRoundedDown : CornerWays::kAlways;
    return beyond > 0;
  });
}

// Whether a pair that shares a corner may come so much farther before it is near, and so comes nowhere near now. Notes
// until when it sleeps.
bool NearSquares::sleeps(const SquarePairs& pairs, std::size_t pair, float farther) {
  const std::int32_t a = pairs.owner[pair], b = pairs.neighbour[pair];
  const float came = ways_.of_last(a, b);
  beside_.until(pairs.number[pair]) =
      farther > came ? ways_.until(a, b, farther - came) : CornerWays::kAlways;
  return farther > came;
}

// Takes those out that share a corner and come nowhere near by how far apart they are otherwise.
void NearSquares::drop_far(SquarePairs& pairs, float range, const Place* place, Room& room) {
  const auto until = [&](std::int32_t number) { return beside_.until(number); };
  drop_asleep(pairs, turn_, until, place, room,
              [&](std::size_t pair, float gap) { return sleeps(pairs, pair, gap - range); });
}

// Takes those out that share a corner and lie alike; they sleep.
void NearSquares::drop_alike(SquarePairs& pairs, const Place* place, Room& room) {
  room.measured.resize(std::max(room.measured.size(), pairs.count + SquarePairs::kPadding));
  beside_.alike(pairs.owner.data(), pairs.neighbour.data(), pairs.count, place,
                room.measured.data());
  drop_pairs(pairs, [&](std::size_t pair) {
    const float change = room.measured[pair];
    sleeps(pairs, pair, change);
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

// The boxes about squares, with their allowances, and how far they have come.
void NearSquares::widen_boxes(const Place* place, Threads& threads) {
  using Record = Eigen::Array4f;
  share_squares(threads, [&](std::size_t n) {
    const std::int32_t* const corner = squares_[n].corner;
    Record low = Record::Map(place[corner[0]].x), high = low;
    float came = 0, allowance = 0;
    for (int c = 0; c < 4; ++c) {
      const Record at = Record::Map(place[corner[c]].x);
      low = low.min(at);
      high = high.max(at);
      came = std::max(came, allowances_.came(corner[c]));
      allowance = std::max(allowance, allowances_.of(corner[c]));
    }
    low -= allowance;
    high += allowance;
    boxes_[n] = {{low[0], low[1], low[2]}, 0, {high[0], high[1], high[2]}, 0};
    way_[n] = (way_[n] - allowance_[n] + came + allowance) / kRoundedDown;
    allowance_[n] = allowance;
  });
}

// Leaves those of the list that may come within range while allowances hold, which are given now.
void NearSquares::prune(float range, const Place* place, const Displacement* moved,
                        Threads& threads) {
  if (*std::ranges::max_element(way_) > CornerWays::kLongest) wake_listed();
  allowances_.give(place, moved, threads);
  widen_boxes(place, threads);
  pruned_.count = 0;
  ++prunes_;
  add_pieces(listed_.count, pruned_, threads,
             [&](std::size_t k, std::size_t first, std::size_t count) {
               SquarePairs& found = found_[k];
               found.reserve(count);
               found.count = std::size_t(kernels_.sheets.squares_awake(
                   {boxes_.data(), int(count), listed_.owner.data() + first,
                    listed_.neighbour.data() + first, until_.data() + first, way_.data(), range,
                    std::int32_t(first), found.owner.data(), found.neighbour.data(),
                    found.number.data()}));
               drop_beyond_allowances(found, range, place, rooms_[k]);
             });
}

const SquarePairs& NearSquares::within(float range, const Place* place, const Displacement* moved,
                                       Threads& threads) {
  within_range_ = range;
  boxed_ = false;
  ++turn_;
  come_apart(moved, threads);
  if (!allowances_.hold(place, moved, threads)) prune(range, place, moved, threads);
  corner_pairs_.count = 0;
  beside_.list(ways_, passing_, threads);
  corner_pairs_.add(beside_.pairs(), beside_.pairs().size());
  within_.count = 0;
  add_pieces(corner_pairs_.count, within_, threads,
             [&](std::size_t k, std::size_t first, std::size_t count) {
               SquarePairs& found = found_[k];
               found.take(corner_pairs_, first, count);
               drop_far(found, range, place, rooms_[k]);
               drop_alike(found, place, rooms_[k]);
               keep_not_apart(range, place, moved, found);
             });
  corner_pairs_.count = 0;
  for (const auto& part : parts_) {
    part->beside.list(place, passing_, threads);
    corner_pairs_.add(part->beside.pairs(), part->beside.pairs().size());
  }
  for (const SquarePairs* pairs : {&corner_pairs_, &pruned_})
    add_pieces(pairs->count, within_, threads,
               [&](std::size_t k, std::size_t first, std::size_t count) {
                 find_not_apart(*pairs, first, count, range, place, moved, found_[k]);
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
    if (asked_[n] || !boxed_) bound_square(n, place, moved);
  });
  boxed_ = true;
  still_.count = 0;
  add_asked_beside(range, range + most, place, moved, threads);
  add_asked(listed_, range, range + most, place, moved, threads);
  return still_;
}

}  // namespace weft::physics
