// The search for pairs (pair_search.h).
#include "physics/self_collision/pair_search.h"

#include <algorithm>
#include <cmath>

namespace weft::physics {
namespace {

constexpr float kHair = 1.001f;            // cells are wider than the range, for rounding
constexpr std::size_t kPairsReserved = 8;  // per point
constexpr std::size_t kCandidates = 512;   // of one cell, room at first

}  // namespace

// Sheets follow each other along u, further apart than each is wide: whole numbers of columns, which
// stay exact for a rectangular sheet.
PairSearch::PairSearch(std::size_t most_points, const std::vector<RestMetric>& metrics, bool once,
                       const KernelTable& kernels)
    : kernels_(kernels), once_(once) {
  double begin = 0;
  for (const RestMetric& m : metrics) {
    const double shear = double(m.uv) / m.uu;
    const double height = std::sqrt(std::max(0.0, double(m.vv) / m.uu - shear * shear));
    const double wide = std::ceil(m.columns + std::abs(shear) * m.rows);
    flat_.push_back({float(begin + wide), float(shear), float(height), m.range_squared / m.uu});
    begin += 4 * wide;
  }
  const std::size_t n = most_points;
  sites_.resize(n);
  for (AlignedArray<float>* a : {&x_, &y_, &z_, &u_, &w_, &apart_squared_})
    *a = AlignedArray<float>(n + 2 * CellGrid::kPadding);
  grid_.reserve(n);
  sorted_sites_.resize(n);
  chunks_.resize((n + kChunk - 1) / kChunk);
  for (Chunk& c : chunks_) {
    c.owner.resize(kPairsReserved * kChunk + kCandidates);
    c.neighbour.resize(c.owner.size());
  }
}

void PairSearch::sort(std::size_t count, const Spread& box, float range, Threads& threads) {
  count_ = count;
  grid_.build({x_.data(), y_.data(), z_.data()}, count, box, range * kHair, threads);
  threads.share(chunks(), few(), [&](std::size_t k) {
    for (std::size_t p = begin(k); p < begin(k + 1); ++p) {
      const Site& s = sites_[std::size_t(grid_.numbers()[p])];
      sorted_sites_[p] = s;
      const FlatSheet& flat = flat_[s.cloth];
      u_[CellGrid::kPadding + p] = flat.begin + float(s.column) + flat.shear * float(s.row);
      w_[CellGrid::kPadding + p] = flat.height * float(s.row);
      apart_squared_[p] = flat.apart_squared;
    }
  });
}

void PairSearch::find(float range, Threads& threads, const std::int32_t* names) {
  const bool alone = few() || threads.count() == 1;
  rooms_.resize(std::size_t(threads.count()));
  threads.share(chunks(), alone, [&](std::size_t k) {
    find_chunk(k, range, rooms_[alone ? 0 : std::size_t(Threads::index())], names);
  });
}

void PairSearch::find_chunk(std::size_t k, float range, Room& room, const std::int32_t* names) {
  Chunk& c = chunks_[k];
  c.found = 0;
  NearSearch s{};
  s.x = grid_.sorted();
  s.u = u_.data() + CellGrid::kPadding;
  s.w = w_.data() + CellGrid::kPadding;
  s.apart_squared = apart_squared_.data();
  s.names = names;
  s.bucket = grid_.buckets();
  s.start = grid_.starts();
  s.table = grid_.table();
  std::copy_n(grid_.offsets(), 9, s.offset);
  s.range_squared = range * range;
  s.begin = int(begin(k));
  s.end = int(begin(k + 1));
  s.once = once_;
  for (std::size_t needed = kCandidates; s.begin < s.end;) {
    if (room.number.size() < needed) {
      room.number.resize(2 * needed);
      room.place.resize(5 * room.number.size());
    }
    if (c.owner.size() < c.found + needed) {
      c.owner.resize(2 * (c.found + needed));
      c.neighbour.resize(c.owner.size());
    }
    const std::size_t size = room.number.size();
    float* const place = room.place.data();
    s.room = {{place, place + size, place + 2 * size},
              place + 3 * size,
              place + 4 * size,
              room.number.data(),
              int(size)};
    s.owner = c.owner.data() + c.found;
    s.neighbour = c.neighbour.data() + c.found;
    s.pairs_room = int(c.owner.size() - c.found);
    const NearFound found = kernels_.near_pairs(s);
    s.begin = found.next;
    c.found += std::size_t(found.pairs);
    needed = std::size_t(found.needed);
  }
  // What kernels may read beyond the last.
  const auto begin = std::ptrdiff_t(c.found);
  std::fill_n(c.owner.begin() + begin, kNearPadding / 2, 0);
  std::fill_n(c.neighbour.begin() + begin, kNearPadding / 2, 0);
}

std::size_t PairSearch::bytes() const {
  std::size_t bytes = sites_.size() * 2 * sizeof(Site) + 6 * x_.size() * 4 + grid_.bytes();
  for (const Chunk& c : chunks_) bytes += 2 * c.owner.capacity() * 4;
  for (const Room& r : rooms_) bytes += 6 * r.number.capacity() * 4;
  return bytes;
}

}  // namespace weft::physics
