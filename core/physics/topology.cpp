// What holds together of a cloth that can tear (topology.h).
#include "physics/topology.h"

#include <algorithm>
#include <numeric>

namespace weft::physics {

Topology::Topology(int columns, int rows, int stride, std::vector<Family>& families)
    : columns_(columns),
      rows_(rows),
      stride_(stride),
      families_(families),
      died_(static_cast<std::size_t>(rows)),
      squares_(static_cast<std::size_t>(columns - 1) * (rows - 1), 3) {
  for (Family& f : families_) {
    links_.push_back(std::make_unique<Links>(rows, stride, f.per_row(columns)));
    f.links = links_.back().get();
    for (int j = rows - f.dj; j < rows; ++j) std::fill_n(f.links->row(j), f.per_row(columns), 0);
  }
  triangles_.reserve(2 * squares_.size());
}

const Family* Topology::family_at(int di, int dj) const {
  for (const Family& f : families_)
    if (f.di == di && f.dj == dj) return &f;
  return nullptr;
}

// Whether the constraint (di, dj) from particle (i, j) is there; true when the cloth has none such.
bool Topology::alive(int di, int dj, int i, int j) const {
  const Family* f = family_at(di, dj);
  return !f || f->alive(j, i - f->near());
}

// A constraint over g steps of a shorter family goes when one of the steps it spans is gone.
void Topology::end_spanning() {
  for (const Family& f : families_) {
    const int g = std::gcd(f.di, f.dj);
    const Family* step = g > 1 ? family_at(f.di / g, f.dj / g) : nullptr;
    if (!step) continue;
    for (int j = 0; j + f.dj < rows_; ++j)
      for (int a = 0; a < f.per_row(columns_); ++a)
        for (int m = 0; m < g; ++m) {
          const int i = a + f.near() + m * step->di - step->near();
          if (!step->alive(j + m * step->dj, i)) end(f, j, a);
        }
  }
}

void Topology::rebuild_triangles() {
  bool changed = false;
  for (int j = 0; j + 1 < rows_; ++j)
    for (int i = 0; i + 1 < columns_; ++i) {
      const bool diagonal = alive(-1, 1, i + 1, j);
      const bool first = diagonal && alive(1, 0, i, j) && alive(0, 1, i, j);
      const bool second = diagonal && alive(1, 0, i, j + 1) && alive(0, 1, i + 1, j);
      const auto left = static_cast<std::uint8_t>(first | second << 1);
      std::uint8_t& square = squares_[static_cast<std::size_t>(j) * (columns_ - 1) + i];
      changed |= square != left;
      square = left;
    }
  if (!changed) return;
  ++version_;
  triangles_.clear();
  for (int j = 0; j + 1 < rows_; ++j)
    for (int i = 0; i + 1 < columns_; ++i) {
      const std::uint8_t left = squares_[static_cast<std::size_t>(j) * (columns_ - 1) + i];
      const auto p = static_cast<std::uint32_t>(j * stride_ + i);
      const auto below = p + static_cast<std::uint32_t>(stride_);
      if (left & 1) triangles_.push_back({p, p + 1, below});
      if (left & 2) triangles_.push_back({p + 1, below + 1, below});
    }
}

bool Topology::update() {
  const auto count = [&] { return std::accumulate(died_.begin(), died_.end(), std::int64_t(0)); };
  if (count() == torn_) return false;
  end_spanning();
  torn_ = count();
  rebuild_triangles();
  return true;
}

std::size_t Topology::bytes() const {
  std::size_t bytes = squares_.size() + died_.size() * 8 + triangles_.capacity() * 12;
  for (const auto& l : links_) bytes += l->bytes();
  return bytes;
}

}  // namespace weft::physics
