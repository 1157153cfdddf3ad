// The search for pairs (pair_search.h).
#include "physics/self_collision/pair_search.h"

#include <algorithm>
#include <cmath>

namespace weft::physics {
namespace {

constexpr float kHair = 1.001f;            // cells are wider than the range, for rounding
constexpr std::size_t kHitsReserved = 16;  // per point
constexpr std::size_t kCandidates = 512;   // of one cell, room at first

}  // namespace

// Sheets follow each other along u, further apart than each is wide: whole numbers of columns, which
// stay exact for a rectangular sheet.
PairSearch::PairSearch(std::size_t most_points, const std::vector<RestMetric>& metrics,
                       const KernelTable& kernels)
    : kernels_(kernels), chunks_(kChunks) {
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
    *a = AlignedArray<float>(n + 16);
  grid_.reserve(n);
  counts_.resize(n);
  for (Chunk& c : chunks_) {
    c.hits.resize(kHitsReserved * n / kChunks + kCandidates);
    c.number.resize(kCandidates);
    c.farther.resize(kCandidates);
    c.room.resize(5 * kCandidates);
  }
}

void PairSearch::sort(std::size_t count, const Spread& box, float range, Threads& threads) {
  count_ = count;
  grid_.build({x_.data(), y_.data(), z_.data()}, count, box, range * kHair, threads);
  threads.share(kChunks, few(), [&](std::size_t k) {
    for (std::size_t p = begin(k); p < begin(k + 1); ++p) {
      const Site& s = sites_[std::size_t(grid_.numbers()[p])];
      const FlatSheet& flat = flat_[s.cloth];
      u_[p] = flat.begin + float(s.column) + flat.shear * float(s.row);
      w_[p] = flat.height * float(s.row);
      apart_squared_[p] = flat.apart_squared;
    }
  });
}

void PairSearch::find(float range, float soon, Threads& threads) {
  threads.share(kChunks, few(), [&](std::size_t k) { find_chunk(k, range, soon); });
}

void PairSearch::find_chunk(std::size_t k, float range, float soon) {
  Chunk& c = chunks_[k];
  c.found = 0;
  NearSearch s{};
  s.x = grid_.sorted();
  s.u = u_.data();
  s.w = w_.data();
  s.apart_squared = apart_squared_.data();
  s.bucket = grid_.buckets();
  s.start = grid_.starts();
  s.table = grid_.table();
  std::copy_n(grid_.offsets(), 9, s.offset);
  s.range_squared = range * range;
  s.near_squared = soon * soon;
  s.begin = int(begin(k));
  s.end = int(begin(k + 1));
  s.counts = counts_.data();
  for (int needed = 0; s.begin < s.end;) {
    if (c.number.size() < std::size_t(needed)) {
      c.number.resize(2 * std::size_t(needed));
      c.farther.resize(c.number.size());
      c.room.resize(5 * c.number.size());
    }
    if (c.hits.size() < c.found + std::size_t(needed))
      c.hits.resize(2 * (c.found + std::size_t(needed)));
    const std::size_t size = c.number.size();
    float* const room = c.room.data();
    s.room = {{room, room + size, room + 2 * size},
              room + 3 * size,
              room + 4 * size,
              c.number.data(),
              c.farther.data(),
              int(size)};
    s.hits = c.hits.data() + c.found;
    s.hits_room = int(c.hits.size() - c.found);
    const NearFound found = kernels_.near_pairs(s);
    s.begin = found.next;
    c.found += std::size_t(found.hits);
    needed = found.needed;
  }
}

std::size_t PairSearch::bytes() const {
  std::size_t bytes = sites_.size() * (sizeof(Site) + 4) + 6 * x_.size() * 4 + grid_.bytes();
  for (const Chunk& c : chunks_) bytes += (c.hits.capacity() + 7 * c.number.capacity()) * 4;
  return bytes;
}

}  // namespace weft::physics
