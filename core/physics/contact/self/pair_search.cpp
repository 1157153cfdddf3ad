// The search for pairs (pair_search.h).
#include "physics/contact/self/pair_search.h"

#include <algorithm>
#include <cmath>

#include "physics/model/clamp_to_int.h"

namespace weft::physics {
namespace {

constexpr float kHair = 1.001f;            // cells are wider than the range, for rounding
constexpr std::size_t kPairsReserved = 4;  // per point
constexpr std::size_t kCandidates = 512;   // of one cell, room at first

bool within(const NamedSheet& s, float range_squared, int a, int b) {
  return double(a) * a * s.uu + 2.0 * a * b * s.uv + double(b) * b * s.vv < range_squared;
}

// The points near one on the flat sheet that lie b rows further on: those from `first` to `last` columns
// further on.
struct Columns {
  int first, last;
};

Columns near_in_row(const NamedSheet& s, int b) {
  const auto near = [&](int a) { return within(s, s.range_squared, a, b); };
  // About the nearest; rounding may leave out a column at either end.
  const double shear = double(s.uv) / s.uu;
  const double height_squared = std::max(0.0, double(s.vv) - shear * s.uv);
  const double half =
      std::sqrt(std::max(0.0, s.range_squared - double(b) * b * height_squared) / s.uu);
  const int most = s.columns - 1;
  const auto clipped = [&](double a) { return clamp_to_int(a, -most, most); };
  Columns c{clipped(std::floor(-shear * b - half) - 1), clipped(std::ceil(-shear * b + half) + 1)};
  while (c.first <= c.last && !near(c.first)) ++c.first;
  while (c.first <= c.last && !near(c.last)) --c.last;
  return c;
}

// visit(b, columns) for every row of points near one, from the point's own on.
template <class Visit>
void for_each_row(const NamedSheet& s, const Visit& visit) {
  const double shear = double(s.uv) / s.uu, height_squared = double(s.vv) - shear * s.uv;
  for (int b = 0; b < s.rows; ++b) {
    if (b > 0 && double(b - 1) * (b - 1) * height_squared >= s.range_squared) break;
    const Columns columns = near_in_row(s, b);
    if (columns.first <= columns.last) visit(b, columns);
  }
}

}  // namespace

std::size_t give_names(std::vector<NamedSheet>& sheets) {
  std::int32_t next = 0, between = 0;
  for (NamedSheet& s : sheets) {
    int columns = 0, rows = 0;
    for_each_row(s, [&](int b, Columns c) {
      columns = std::max({columns, -c.first, c.last});
      rows = b;
    });
    s.stride = std::max(s.stride, s.columns + columns);
    // An odd number of the cache's lines of places: rows do not compete for the same.
    s.stride = (s.stride + 3) / 8 * 8 + 4;
    const std::int32_t farthest = rows * s.stride + columns;
    s.first = next == 0 ? 0 : next + std::max(between, farthest);
    next = s.first + s.rows * s.stride;
    between = farthest;
  }
  return std::size_t(next);
}

std::vector<SheetStep> steps_beyond(const NamedSheet& s, float range_squared) {
  std::vector<SheetStep> steps;
  for_each_row(s, [&](int b, Columns c) {
    for (int a = b == 0 ? 1 : c.first; a <= c.last; ++a)
      if (!within(s, range_squared, a, b)) steps.push_back({a, b});
  });
  return steps;
}

PairSearch::PairSearch(std::size_t most_points, const std::vector<NamedSheet>& sheets,
                       const KernelTable& kernels)
    : kernels_(kernels), grid_(kernels) {
  for (const NamedSheet& s : sheets) {
    std::vector<NameWindow>& windows = windows_.emplace_back();
    for_each_row(s, [&](int b, Columns c) {
      windows.push_back({b == 0 ? 0 : b * s.stride + c.first, b * s.stride + c.last});
    });
  }
  for (std::size_t n = 0; n < sheets.size(); ++n)
    sheets_.push_back({sheets[n].first, windows_[n].data(), int(windows_[n].size())});
  const std::size_t n = most_points;
  name_.resize(n);
  for (AlignedArray<float>* a : {&x_, &y_, &z_})
    *a = AlignedArray<float>(n + 2 * SpatialHash::kPadding);
  grid_.reserve(n);
  chunks_.resize((n + kChunk - 1) / kChunk);
  for (Chunk& c : chunks_) {
    c.owner.resize(kPairsReserved * kChunk + kCandidates);
    c.neighbour.resize(c.owner.size());
  }
}

void PairSearch::sort(std::size_t count, const Spread& box, float range, Threads& threads) {
  count_ = count;
  grid_.build({x_.data(), y_.data(), z_.data()}, name_.data(), count, box, range * kHair, threads);
}

void PairSearch::find(float range, Threads& threads) {
  const bool alone = few() || threads.count() == 1;
  rooms_.resize(std::size_t(threads.count()));
  threads.share(chunks(), alone, [&](std::size_t k) {
    find_chunk(k, range, rooms_[alone ? 0 : std::size_t(Threads::index())]);
  });
}

void PairSearch::find_chunk(std::size_t k, float range, Room& room) {
  Chunk& c = chunks_[k];
  c.found = 0;
  NearSearch s{};
  s.x = grid_.sorted();
  s.name = sheets_.empty() ? nullptr : grid_.names();
  s.sheet = sheets_.data();
  s.sheets = int(sheets_.size());
  s.bucket = grid_.buckets();
  s.start = grid_.starts();
  s.table = grid_.table();
  std::copy_n(grid_.offsets(), 9, s.offset);
  s.range_squared = range * range;
  s.begin = int(begin(k));
  s.end = int(begin(k + 1));
  for (std::size_t needed = kCandidates; s.begin < s.end;) {
    if (room.name.size() < needed) {
      room.name.resize(2 * needed);
      room.place.resize(3 * room.name.size());
    }
    if (c.owner.size() < c.found + needed) {
      c.owner.resize(2 * (c.found + needed));
      c.neighbour.resize(c.owner.size());
    }
    const std::size_t size = room.name.size();
    float* const place = room.place.data();
    s.room = {{place, place + size, place + 2 * size}, room.name.data(), int(size)};
    s.owner = c.owner.data() + c.found;
    s.neighbour = c.neighbour.data() + c.found;
    s.pairs_room = int(c.owner.size() - c.found);
    const NearFound found = kernels_.sheets.near_pairs(s);
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
  std::size_t bytes = (name_.size() + 3 * x_.size()) * 4 + grid_.bytes();
  for (const Chunk& c : chunks_) bytes += 2 * c.owner.capacity() * 4;
  for (const Room& r : rooms_) bytes += 4 * r.name.capacity() * 4;
  return bytes;
}

}  // namespace weft::physics
