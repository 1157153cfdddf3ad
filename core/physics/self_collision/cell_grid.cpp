// The grid of cells (cell_grid.h).
#include "physics/self_collision/cell_grid.h"

#include <algorithm>
#include <bit>

namespace weft::physics {
namespace {

constexpr std::int64_t kTablePerParticle = 4;  // buckets

std::int64_t modulo(std::int64_t a, std::int64_t m) {
  const std::int64_t r = a % m;
  return r < 0 ? r + m : r;
}

}  // namespace

void CellGrid::reserve(std::size_t particles) {
  const auto table = std::bit_ceil(std::size_t(kTablePerParticle) * particles + 1024);
  key_.resize(particles);
  number_.resize(particles);
  start_.reserve(table + 2);
  x_ = AlignedArray<float>(particles + 16);
  y_ = AlignedArray<float>(particles + 16);
  z_ = AlignedArray<float>(particles + 16);
}

// The whole box when it fits the table; else strides for which the nine runs of the 27 cells stay
// apart modulo the table.
void CellGrid::choose_strides(const int cells[3]) {
  const auto most = std::int64_t(std::bit_ceil(std::size_t(kTablePerParticle) * count_ + 1024));
  stride_y_ = cells[0] + 2;
  const std::int64_t rows = cells[1] + 2;
  stride_z_ = stride_y_ * rows;
  const std::int64_t whole = stride_z_ * (cells[2] + 2);
  if (whole <= most) {
    table_ = whole;
    return;
  }
  table_ = most;
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

void CellGrid::build(ConstRow3 x, std::size_t particles, const float low[3], const float high[3],
                     float size) {
  count_ = particles;
  const float inverse = 1 / size;
  int cells[3];
  for (int k = 0; k < 3; ++k) cells[k] = int((high[k] - low[k]) * inverse) + 1;
  choose_strides(cells);
  for (int c = -1; c <= 1; ++c)
    for (int b = -1; b <= 1; ++b)
      offset_[3 * (c + 1) + b + 1] = modulo(b * stride_y_ + c * stride_z_ - 1, table_);
  start_.assign(std::size_t(table_) + 1, 0);
  const bool wraps = stride_z_ * (cells[2] + 2) > table_;
  for (std::size_t p = 0; p < particles; ++p) {
    const std::int64_t a = std::int64_t((x.x[p] - low[0]) * inverse) + 1;
    const std::int64_t b = std::int64_t((x.y[p] - low[1]) * inverse) + 1;
    const std::int64_t c = std::int64_t((x.z[p] - low[2]) * inverse) + 1;
    std::int64_t key = a + b * stride_y_ + c * stride_z_;
    if (wraps) key = modulo(key, table_);
    key_[p] = std::int32_t(key);
    ++start_[std::size_t(key) + 1];
  }
  for (std::size_t k = 1; k < start_.size(); ++k) start_[k] += start_[k - 1];
  for (std::size_t p = 0; p < particles; ++p) {
    const auto at = std::size_t(start_[std::size_t(key_[p])]++);
    number_[at] = std::int32_t(p);
    x_[at] = x.x[p];
    y_[at] = x.y[p];
    z_[at] = x.z[p];
  }
  // Each start has moved to its bucket's end: the start of the next.
  for (std::size_t k = start_.size() - 1; k > 0; --k) start_[k] = start_[k - 1];
  start_[0] = 0;
}

std::size_t CellGrid::bucket_start_from(std::size_t sorted) const {
  if (sorted == 0 || sorted >= count_) return std::min(sorted, count_);
  return key_of_sorted(sorted) == key_of_sorted(sorted - 1) ? bucket_end(sorted) : sorted;
}

int CellGrid::runs_about(std::size_t sorted, Run* runs) const {
  const std::int64_t key = key_of_sorted(sorted);
  int n = 0;
  const auto add = [&](std::int64_t from, std::int64_t to) {
    const Run run{start_[std::size_t(from)], start_[std::size_t(to)]};
    if (run.first < run.last) runs[n++] = run;
  };
  for (const std::int64_t offset : offset_) {
    std::int64_t from = key + offset;
    if (from >= table_) from -= table_;
    add(from, std::min(from + 3, table_));
    if (from + 3 > table_) add(0, from + 3 - table_);
  }
  return n;
}

std::size_t CellGrid::bytes() const {
  return (key_.size() + number_.size() + start_.capacity() + 3 * x_.size()) * 4;
}

}  // namespace weft::physics
