// The grid of cells (spatial_hash.h).
#include "physics/contact/self/spatial_hash.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <utility>

#include "physics/model/clamp_to_int.h"

namespace weft::physics {
namespace {

constexpr std::int64_t kTablePerParticle = 4;  // buckets
constexpr std::int64_t kSmallestTable = 1024;
constexpr std::size_t kFew = 4096;  // particles that one thread sorts faster

std::int64_t modulo(std::int64_t a, std::int64_t m) {
  const std::int64_t r = a % m;
  return r < 0 ? r + m : r;
}

// Cells along an axis.
int cells_in(float length, float inverse) {
  return clamp_to_int(length * inverse, 0, int(kMostCells)) + 1;
}

std::int64_t largest_table(std::size_t particles) {
  return std::int64_t(std::bit_ceil(std::size_t(kTablePerParticle) * particles + kSmallestTable));
}

}  // namespace

void SpatialHash::reserve(std::size_t particles) {
  key_.resize(particles + kPadding);
  dealt_.resize(particles);
  bucket_.resize(particles);
  start_.reserve(std::size_t(largest_table(particles)) + 1);
  name_ = AlignedArray<std::int32_t>(particles + 2 * kPadding);
  for (AlignedArray<float>* a : {&x_, &y_, &z_}) *a = AlignedArray<float>(particles + 2 * kPadding);
}

// The whole box when it fits the table; else strides for which the nine runs of the 27 cells stay
// apart modulo the table.
void SpatialHash::choose_strides(const int cells[3]) {
  const std::int64_t most = largest_table(count_);
  stride_y_ = cells[0] + 2;
  const std::int64_t rows = cells[1] + 2;
  stride_z_ = stride_y_ * rows;
  const std::int64_t whole = stride_z_ * (cells[2] + 2);
  wraps_ = whole > most;
  table_ = wraps_ ? most : whole;
  if (!wraps_) return;
  const auto apart = [&] {
    for (std::int64_t b = -2; b <= 2; ++b)
      for (std::int64_t c = -2; c <= 2; ++c) {
        const std::int64_t off = modulo(b * stride_y_ + c * stride_z_, table_);
        if ((b != 0 || c != 0) && std::min(off, table_ - off) < 3) return false;
      }
    return true;
  };
  while (!apart()) {
    ++stride_y_;
    stride_z_ = stride_y_ * rows + 7;
  }
}

void SpatialHash::build(ConstRow3 x, const std::int32_t* names, std::size_t particles,
                        const Spread& box, float size, Threads& threads) {
  count_ = particles;
  inverse_ = 1 / size;
  int cells[3];
  for (int k = 0; k < 3; ++k) {
    low_[k] = box.low[k];
    cells[k] = cells_in(box.high[k] - box.low[k], inverse_);
    last_[k] = float(cells[k] - 1);
  }
  choose_strides(cells);
  for (int c = -1; c <= 1; ++c)
    for (int b = -1; b <= 1; ++b)
      offset_[3 * (c + 1) + b + 1] = modulo(b * stride_y_ + c * stride_z_ - 1, table_);
  start_.resize(std::size_t(table_) + 1);
  shift_ = 0;
  while (((table_ - 1) >> shift_) >= kParts) ++shift_;
  // Counts of every part and share, then where each begins: part after part, share after share.
  const bool few = particles < kFew;
  threads.share(kShares, few, [&](std::size_t share) { count(x, int(share)); });
  std::int32_t before = 0;
  for (int p = 0; p <= kParts; ++p)
    for (int s = 0; s < kShares; ++s) before += std::exchange(dealt_to_[p][s], before);
  threads.share(kShares, few, [&](std::size_t share) { deal(int(share)); });
  threads.share(kParts, few, [&](std::size_t part) { sort_part(x, names, int(part)); });
  start_[std::size_t(table_)] = std::int32_t(count_);
}

// Whole groups of lanes, so that no two shares write to the same.
std::size_t SpatialHash::share_begin(std::size_t share) const {
  return share == kShares ? count_ : share * count_ / kShares / kPadding * kPadding;
}

// The buckets of a share of the particles, and how many of them are in each part of the table.
void SpatialHash::count(ConstRow3 x, int share) {
  const std::size_t begin = share_begin(std::size_t(share)),
                    end = share_begin(std::size_t(share) + 1);
  kernels_.sheets.cell_keys({x,
                             int(begin),
                             int(end),
                             {low_[0], low_[1], low_[2]},
                             {last_[0], last_[1], last_[2]},
                             inverse_,
                             stride_y_,
                             stride_z_,
                             table_,
                             wraps_,
                             key_.data()});
  // By turns: particles beside each other are often in the same part, and what was just written is slow
  // to read.
  constexpr std::size_t kTurns = 4;
  std::int32_t counts[kTurns][kParts + 1] = {};
  for (std::size_t p = begin; p < end; ++p) {
    assert(key_[p] >= 0 && key_[p] < table_);
    ++counts[p % kTurns][key_[p] >> shift_];
  }
  for (int p = 0; p <= kParts; ++p)
    dealt_to_[p][share] = counts[0][p] + counts[1][p] + counts[2][p] + counts[3][p];
}

// The particles of a share to their parts. Those beside each other are often in the same: where its next
// goes is kept at hand, since what was just written is slow to read.
void SpatialHash::deal(int share) {
  const std::size_t end = share_begin(std::size_t(share) + 1);
  std::int32_t at[kParts], part = 0;
  for (int p = 0; p < kParts; ++p) at[p] = dealt_to_[p][share];
  std::int32_t next = at[0];
  for (std::size_t i = share_begin(std::size_t(share)); i < end; ++i) {
    const std::int32_t other = key_[i] >> shift_;
    if (other != part) {
      at[part] = next;
      next = at[part = other];
    }
    dealt_[std::size_t(next++)] = std::int32_t(i);
  }
}

void SpatialHash::sort_part(ConstRow3 x, const std::int32_t* names, int part) {
  const std::int64_t first = std::min(std::int64_t(part) << shift_, table_);
  const std::int64_t last = std::min(std::int64_t(part + 1) << shift_, table_);
  const std::int32_t begin = dealt_to_[part][0], end = dealt_to_[part + 1][0];
  std::int32_t* const start = start_.data();
  std::fill(start + first, start + last, 0);
  for (std::int32_t i = begin; i < end; ++i) ++start[key_[std::size_t(dealt_[std::size_t(i)])]];
  std::int32_t before = begin;
  for (std::int64_t k = first; k < last; ++k) before += std::exchange(start[k], before);
  for (std::int32_t i = begin; i < end; ++i) {
    const auto p = std::size_t(dealt_[std::size_t(i)]);
    const auto at = std::size_t(start[key_[p]]++);
    bucket_[at] = key_[p];
    name_[kPadding + at] = names[p];
    x_[kPadding + at] = x.x[p];
    y_[kPadding + at] = x.y[p];
    z_[kPadding + at] = x.z[p];
  }
  // Each start has moved to its bucket's end, the start of the next.
  for (std::int64_t k = last - 1; k > first; --k) start[k] = start[k - 1];
  if (first < last) start[first] = begin;
}

std::size_t SpatialHash::bytes() const {
  return (3 * key_.size() + start_.capacity() + 4 * x_.size()) * 4;
}

}  // namespace weft::physics
