// Squares beside each other (beside_squares.h).
#include "physics/contact/self/beside_squares.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace weft::physics {
namespace {

constexpr std::size_t kFewSquares = 4096;  // that one thread does faster

// The least length of a mean of two vectors, by their squares and their product.
float least_between(float aa, float bb, float ab) {
  const float least = std::min(aa, bb);
  if (ab >= least) return std::sqrt(least);
  return std::sqrt(std::max(0.0f, aa * bb - ab * ab) / (aa + bb - 2 * ab));
}

// Meshes have none (beside_triangles.h).
int rows_of(const Sheet& sheet) {
  return sheet.mesh ? 0 : sheet.points->rows;
}

}  // namespace

BesideSquares::BesideSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
                             const std::vector<Square>& squares)
    : sheets_(sheets),
      named_(named),
      squares_(squares),
      lies_(squares.size()),
      changed_(squares.size(), 1),
      may_touch_(squares.size()) {
  for (const Sheet& s : sheets) {
    first_row_.push_back(pairs_.size());
    pairs_.resize(pairs_.size() + std::size_t(rows_of(s)));
  }
  row_changed_.assign(pairs_.size(), 1);
}

void BesideSquares::forget() {
  std::fill(changed_.begin(), changed_.end(), std::uint8_t{1});
  std::fill(row_changed_.begin(), row_changed_.end(), std::uint8_t{1});
}

// How a square lies: its mean edges, and how far its edges are off them.
auto BesideSquares::lie_of(std::size_t n, const Place* place) const -> Lie {
  const std::int32_t* const corner = squares_[n].corner;
  Lie lie{};
  float warp = 0;
  for (int k = 0; k < 3; ++k) {
    const float a = place[corner[0]].x[k], b = place[corner[1]].x[k];
    const float c = place[corner[2]].x[k], d = place[corner[3]].x[k];
    lie.u[k] = 0.5f * (b - a + d - c);
    lie.v[k] = 0.5f * (c - a + d - b);
    const float off = 0.5f * (a + d - b - c);
    warp += off * off;
    lie.uu += lie.u[k] * lie.u[k];
    lie.vv += lie.v[k] * lie.v[k];
  }
  lie.warp = std::sqrt(warp);
  return lie;
}

void BesideSquares::measure_row(std::size_t sheet, int row, const Place* place) {
  constexpr float kChange = 0.03f;  // of the shorter edge at rest
  const Sheet& s = sheets_[sheet];
  const float most = kChange * kChange * std::min(s.uu, s.vv);
  std::uint8_t& row_changed = row_changed_[first_row_[sheet] + std::size_t(row)];
  const auto begin = std::size_t(named_[sheet].name(row, 0));
  for (std::size_t n = begin; n < begin + std::size_t(s.columns); ++n) {
    const Lie now = lie_of(n, place);
    Lie& then = lies_[n];
    float du = 0, dv = 0;
    for (int k = 0; k < 3; ++k) {
      du += (now.u[k] - then.u[k]) * (now.u[k] - then.u[k]);
      dv += (now.v[k] - then.v[k]) * (now.v[k] - then.v[k]);
    }
    const float warped = now.warp - then.warp;
    if (changed_[n] == 0 && std::max({du, dv, warped * warped}) <= most) continue;
    then = now;
    changed_[n] = row_changed = 1;
  }
}

void BesideSquares::list(const std::vector<std::uint8_t>& passing, Threads& threads) {
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const int rows = rows_of(sheets_[s]);
    threads.share(std::size_t(rows), squares_.size() < kFewSquares, [&](std::size_t j) {
      const std::size_t row = first_row_[s] + j;
      const bool below = int(j) + 1 < rows && row_changed_[row + 1];
      if (row_changed_[row] || below) list_row(s, int(j), passing, pairs_[row]);
    });
  }
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    for (int j = 0; j < rows_of(sheets_[s]); ++j)
      if (std::exchange(row_changed_[first_row_[s] + std::size_t(j)], std::uint8_t{0}))
        std::fill_n(changed_.begin() + named_[s].name(j, 0), sheets_[s].columns, 0);
}

// Whether two squares that share a corner, or one with itself, lie so much alike that they cannot touch.
//
// Two points of them that are a columns and b rows apart are a A + b B from each other, with A a mean of
// their edges along rows and B of those along columns. So they are at least ρ times as far apart as on the
// flat sheet, with
//
//   ρ² (1 + |u·v|/(|u||v|)) = min(min |A|²/|u|², min |B|²/|v|²) - max |A·B|/(|u||v|)
//
// where u and v are the edges at rest. Contact keeps half of that distance.
bool BesideSquares::lie_alike(const Sheet& sheet, std::size_t p, std::size_t q) const {
  constexpr float kApart = 0.6f;  // ρ, with what an interval may change
  const Lie &a = lies_[p], &b = lies_[q];
  float uu = 0, vv = 0, askew[4] = {};
  for (int k = 0; k < 3; ++k) {
    uu += a.u[k] * b.u[k];
    vv += a.v[k] * b.v[k];
    askew[0] += a.u[k] * a.v[k], askew[1] += a.u[k] * b.v[k];
    askew[2] += b.u[k] * a.v[k], askew[3] += b.u[k] * b.v[k];
  }
  const float warp = std::max(a.warp, b.warp);
  const float u = least_between(a.uu, b.uu, uu) - warp, v = least_between(a.vv, b.vv, vv) - warp;
  if (!(u > 0) || !(v > 0)) return false;
  const float longest = std::sqrt(std::max({a.uu, b.uu, a.vv, b.vv}));
  float most = 0;
  for (const float s : askew) most = std::max(most, std::abs(s));
  most += warp * (2 * longest + warp);
  const float rest = std::sqrt(sheet.uu * sheet.vv);
  const float needed = kApart * kApart * (1 + std::abs(sheet.uv) / rest) + most / rest;
  return u * u >= needed * sheet.uu && v * v >= needed * sheet.vv;
}

// A square's bits are in this order: itself, the next along the row, and those of the next row from the one
// before it to the one after.
void BesideSquares::list_row(std::size_t sheet, int row, const std::vector<std::uint8_t>& passing,
                             SquarePairs& found) {
  const int columns = sheets_[sheet].columns, rows = sheets_[sheet].points->rows;
  found.count = 0;
  found.reserve(5 * std::size_t(columns));
  const auto look_at = [&](std::size_t p, std::size_t q, int bit) {
    std::uint8_t& bits = may_touch_[p];
    if (changed_[p] || changed_[q]) {
      const bool touch = !lie_alike(sheets_[sheet], p, q);
      bits = std::uint8_t((bits & ~(1 << bit)) | (int(touch) << bit));
    }
    if (!(bits >> bit & 1)) return;
    if (has_corner_in(squares_[p], passing) || has_corner_in(squares_[q], passing)) return;
    found.owner[found.count] = std::int32_t(p);
    found.neighbour[found.count++] = std::int32_t(q);
  };
  for (int i = 0; i < columns; ++i) {
    const auto n = std::size_t(named_[sheet].name(row, i));
    look_at(n, n, 0);
    if (i + 1 < columns) look_at(n, n + 1, 1);
    if (row + 1 == rows) continue;
    for (int across = i > 0 ? -1 : 0; across <= (i + 1 < columns ? 1 : 0); ++across)
      look_at(n, std::size_t(named_[sheet].name(row + 1, i + across)), 3 + across);
  }
}

std::size_t BesideSquares::bytes() const {
  std::size_t bytes = lies_.size() * (sizeof(Lie) + 2) + row_changed_.size();
  for (const SquarePairs& p : pairs_) bytes += p.bytes();
  return bytes;
}

}  // namespace weft::physics
