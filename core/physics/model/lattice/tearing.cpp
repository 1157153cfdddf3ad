// What holds together of a cloth that can tear (tearing.h).
#include "physics/model/lattice/tearing.h"

#include <algorithm>
#include <numeric>

#include "physics/model/lattice/pinch_vertex.h"
#include "physics/model/lattice/tear_boundary.h"

namespace weft::physics {

LatticeTearing::LatticeTearing(const Lattice& l, std::vector<Stencil>& stencils, const Cloth& cloth)
    : lattice_(l),
      columns_(l.columns),
      rows_(l.rows),
      stride_(l.stride),
      tears_(cloth.tears),
      stencils_(stencils),
      bend_links_(cloth.bending.given() ? std::make_unique<BendLinks>(l) : nullptr),
      died_(static_cast<std::size_t>(l.rows)),
      followed_(died_),
      squares_(static_cast<std::size_t>(l.columns - 1) * (l.rows - 1)),
      boundary_(tears_ == Tears::split ? std::make_unique<TearBoundary>(cloth) : nullptr) {
  for (Stencil& f : stencils_) {
    links_.push_back(std::make_unique<Links>(rows_, stride_, f.per_row(columns_)));
    f.links = links_.back().get();
  }
  if (tears_ == Tears::particles)
    removed_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  make_whole();
  triangles_.reserve(2 * squares_.size());
  rows_about_.reserve(static_cast<std::size_t>(l.rows));
}

LatticeTearing::~LatticeTearing() = default;

void LatticeTearing::make_whole() {
  for (Stencil& f : stencils_)
    for (int j = 0; j < rows_; ++j)
      std::fill_n(f.links->row(j), f.per_row(columns_), j + f.dj < rows_ ? -1 : 0);
  if (bend_links_) bend_links_->make_whole();
  std::fill(died_.begin(), died_.end(), 0);
  followed_ = died_;
  std::fill(squares_.begin(), squares_.end(), std::uint8_t(0));
  std::fill(removed_.begin(), removed_.end(), std::uint8_t(0));
  torn_ = 0;
}

std::vector<Joined> LatticeTearing::torn_list() const {
  std::vector<Joined> list;
  if (torn_ == 0) return list;
  for (const Stencil& f : stencils_)
    for (int j = 0; j + f.dj < rows_; ++j)
      for (int a = 0; a < f.per_row(columns_); ++a)
        if (!f.alive(j, a))
          list.push_back({j * columns_ + a + f.near(), (j + f.dj) * columns_ + a + f.far()});
  return list;
}

void LatticeTearing::end_joined(const Joined& constraint) {
  const auto [from, to] = std::minmax(constraint[0], constraint[1]);
  const int j = from / columns_, i = from % columns_;
  if (const Stencil* f = stencil_at(to % columns_ - i, to / columns_ - j))
    end(*f, j, i - f->near());
}

void LatticeTearing::set_torn(const std::vector<Joined>& torn) {
  make_whole();
  for (const Joined& constraint : torn) end_joined(constraint);
  for (std::size_t p = 0; p < removed_.size(); ++p)
    removed_[p] = free(static_cast<int>(p) % columns_, static_cast<int>(p) / columns_);
  update();
  ++version_;
  list_triangles();
}

std::int64_t LatticeTearing::end_all(const std::vector<Joined>& constraints) {
  const std::int64_t before = torn_;
  for (const Joined& constraint : constraints) end_joined(constraint);
  update();
  return torn_ - before;
}

TornSurface LatticeTearing::surface() {
  if (version_ == 0) return {};
  if (!boundary_) return {triangles_, {}, {}, {}};
  boundary_->update(*this, lattice_);
  return {triangles_, boundary_->points(), boundary_->particles(), boundary_->triangles()};
}

const Stencil* LatticeTearing::stencil_at(int di, int dj) const {
  for (const Stencil& f : stencils_)
    if (f.di == di && f.dj == dj) return &f;
  return nullptr;
}

bool LatticeTearing::alive(int di, int dj, int i, int j) const {
  const Stencil* f = stencil_at(di, dj);
  return !f || f->alive(j, i - f->near());
}

bool LatticeTearing::joined(int di, int dj, int i, int j) const {
  const Stencil* f = stencil_at(di, dj);
  return f && f->alive(j, i - f->near());
}

// A constraint over g steps of a shorter stencil goes when one of the steps it spans, one of them in
// the row, is gone.
void LatticeTearing::end_spanning(int row) {
  for (const Stencil& f : stencils_) {
    const int g = std::gcd(f.di, f.dj);
    const Stencil* step = g > 1 ? stencil_at(f.di / g, f.dj / g) : nullptr;
    if (!step) continue;
    for (int j = std::max(0, row - f.dj); j <= row && j + f.dj < rows_; ++j)
      for (int a = 0; a < f.per_row(columns_); ++a)
        for (int m = 0; m < g; ++m) {
          const int i = a + f.near() + m * step->di - step->near();
          if (!step->alive(j + m * step->dj, i)) end(f, j, a);
        }
  }
}

// Whether a particle has no constraint left, where it had one.
bool LatticeTearing::free(int i, int j) const {
  bool had = false;
  for (const Stencil& f : stencils_)
    for (const int side : {1, -1}) {
      const int x = i + side * f.di, y = j + side * f.dj;
      if (x < 0 || y < 0 || x >= columns_ || y >= rows_) continue;
      had = true;
      if (f.alive(std::min(j, y), std::min(i, x))) return false;
    }
  return had;
}

// What is dead about the rows where something died, and joins no particle that is gone already, takes
// its own two with it.
void LatticeTearing::end_particles() {
  const auto at = [&](int i, int j) { return static_cast<std::size_t>(j) * columns_ + i; };
  std::vector<std::array<int, 2>> gone;
  for (const int j : rows_about_)
    for (const Stencil& f : stencils_)
      for (int a = 0; j + f.dj < rows_ && a < f.per_row(columns_); ++a) {
        if (f.alive(j, a)) continue;
        const std::array<int, 2> near{a + f.near(), j}, far{a + f.far(), j + f.dj};
        if (removed_[at(near[0], near[1])] || removed_[at(far[0], far[1])]) continue;
        gone.push_back(near);
        gone.push_back(far);
      }
  for (const auto& [i, j] : gone) {
    removed_[at(i, j)] = 1;
    for (const Stencil& f : stencils_)
      for (const int side : {1, -1}) {
        const int x = i + side * f.di, y = j + side * f.dj;
        if (x >= 0 && y >= 0 && x < columns_ && y < rows_) end(f, std::min(j, y), std::min(i, x));
      }
  }
}

// Bending goes with the structural constraints that it bends.
void LatticeTearing::end_bending(int row) {
  BendLinks& b = *bend_links_;
  for (int j = std::max(0, row - 1); j <= row; ++j)
    for (int i = 0; i < columns_; ++i) {
      const std::size_t at = static_cast<std::size_t>(j) * stride_ + i;
      const bool right = i + 1 < columns_ && alive(1, 0, i, j);
      const bool down = j + 1 < rows_ && alive(0, 1, i, j);
      if (i + 2 < columns_ && !(right && alive(1, 0, i + 1, j))) b.along[at] = 0;
      if (j + 2 < rows_ && !(down && alive(0, 1, i, j + 1))) b.across[at] = 0;
      if (i + 1 < columns_ && j + 1 < rows_ &&
          !(right && down && alive(1, 0, i, j + 1) && alive(0, 1, i + 1, j)))
        b.twist[at] = 0;
    }
}

// The squares above and below a row; returns whether any lost an edge.
bool LatticeTearing::look_at_squares(int row) {
  bool changed = false;
  for (int j = std::max(0, row - 1); j <= row && j + 1 < rows_; ++j)
    for (int i = 0; i + 1 < columns_; ++i) {
      const bool diagonal = alive(-1, 1, i + 1, j);
      const bool edges[6] = {alive(1, 0, i, j),     diagonal,
                             alive(0, 1, i, j),     alive(0, 1, i + 1, j),
                             alive(1, 0, i, j + 1), diagonal};
      std::uint8_t gone = 0;
      for (int n = 0; n < 6; ++n) gone |= static_cast<std::uint8_t>(!edges[n] << n);
      if (!removed_.empty()) {
        const std::size_t p = static_cast<std::size_t>(j) * columns_ + i, below = p + columns_;
        if (removed_[p] || removed_[p + 1] || removed_[below]) gone |= 7;
        if (removed_[p + 1] || removed_[below + 1] || removed_[below]) gone |= 7 << 3;
      }
      std::uint8_t& square = squares_[static_cast<std::size_t>(j) * (columns_ - 1) + i];
      changed |= square != gone;
      square = gone;
    }
  return changed;
}

void LatticeTearing::list_triangles() {
  triangles_.clear();
  for (int j = 0; j + 1 < rows_; ++j)
    for (int i = 0; i + 1 < columns_; ++i) {
      const std::uint8_t lost = gone(i, j);
      const auto p = static_cast<std::uint32_t>(j * stride_ + i);
      const auto below = p + static_cast<std::uint32_t>(stride_);
      if (!(lost & 7)) triangles_.push_back({p, p + 1, below});
      if (!(lost >> 3)) triangles_.push_back({p + 1, below + 1, below});
    }
}

// Particles of a row that are beside a torn triangle.
void LatticeTearing::end_pinches(int j) {
  for (int i = 0; i < columns_; ++i) {
    unsigned torn = 0;
    for (int y = std::max(0, j - 1); y <= j && y + 1 < rows_; ++y)
      for (int x = std::max(0, i - 1); x <= i && x + 1 < columns_; ++x) torn |= gone(x, y);
    const unsigned ending = torn ? pinched(*this, i, j) : 0;
    for (std::size_t k = 0; k < kAround.size() && ending >> k; ++k) {
      if (!(ending >> k & 1)) continue;
      const auto [di, dj] = kAround[k];
      const bool forth = dj > 0 || (dj == 0 && di > 0);
      const Stencil* f = forth ? stencil_at(di, dj) : stencil_at(-di, -dj);
      if (!f) continue;
      const int a = (forth ? i : i + di) - f->near(), from = forth ? j : j + dj;
      if (from >= 0 && from + f->dj < rows_ && a >= 0 && a < f->per_row(columns_)) end(*f, from, a);
    }
  }
}

// Where something died that has not been followed.
void LatticeTearing::list_rows() {
  rows_about_.clear();
  for (int j = 0; j < rows_; ++j)
    if (died_[static_cast<std::size_t>(j)] != followed_[static_cast<std::size_t>(j)])
      rows_about_.push_back(j);
}

// What dies at a pinch vertex may make another one.
bool LatticeTearing::update() {
  if (died_ == followed_) return false;
  bool changed = false;
  while (died_ != followed_) {
    const bool particles = tears_ == Tears::particles;
    list_rows();
    if (particles) {
      end_particles();
      list_rows();
    }
    for (const int j : rows_about_) {
      if (!particles) end_spanning(j);
      if (bend_links_) end_bending(j);
      changed |= look_at_squares(j);
    }
    followed_ = died_;
    if (particles) continue;
    // Constraints of a row join particles that have it in their neighbourhood.
    int next = 0;
    for (const int row : rows_about_)
      for (next = std::max(next, row - 1); next <= std::min(row + 2, rows_ - 1); ++next)
        end_pinches(next);
  }
  torn_ = std::accumulate(died_.begin(), died_.end(), std::int64_t(0));
  if (changed) {
    ++version_;
    list_triangles();
  }
  return true;
}

void LatticeTearing::remember() {
  if (remembered_.empty())
    for (std::size_t f = 0; f < links_.size(); ++f)
      remembered_.push_back(std::make_unique<Links>(rows_, stride_, 0));
  for (std::size_t f = 0; f < links_.size(); ++f) remembered_[f]->copy(*links_[f]);
}

void LatticeTearing::go_back() {
  for (std::size_t f = 0; f < remembered_.size(); ++f) links_[f]->copy(*remembered_[f]);
  died_ = followed_;
}

std::size_t LatticeTearing::bytes() const {
  std::size_t bytes =
      squares_.size() + removed_.size() + died_.size() * 16 + triangles_.capacity() * 12;
  for (const auto& l : links_) bytes += l->bytes();
  for (const auto& l : remembered_) bytes += l->bytes();
  return bytes + (bend_links_ ? bend_links_->bytes() : 0) + (boundary_ ? boundary_->bytes() : 0);
}

}  // namespace weft::physics
