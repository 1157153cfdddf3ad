// Squares beside each other (beside_squares.h).
#include "physics/contact/self/beside_squares.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace weft::physics {
namespace {

constexpr std::size_t kFewSquares = 4096;  // that one thread does faster

// Four floats, of which the last is of no account.
using Record = Eigen::Array4f;

float product(const Record& a, const Record& b) {
  const Record products = a * b;
  return products[0] + products[1] + products[2];
}

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
    : sheets_(sheets), named_(named), squares_(squares), awake_(squares.size()) {
  for (const Sheet& s : sheets) {
    first_row_.push_back(pairs_.size());
    pairs_.resize(pairs_.size() + std::size_t(rows_of(s)));
  }
  wake();
}

void BesideSquares::wake() {
  for (auto& until : until_) until.assign(squares_.size(), SquareWays::kAtOnce);
}

// From a square's number to that of the other one of a pair.
std::ptrdiff_t BesideSquares::step(std::size_t sheet, std::size_t pair) const {
  return pair < 2 ? std::ptrdiff_t(pair) : named_[sheet].stride + std::ptrdiff_t(pair) - 3;
}

void BesideSquares::find_awake(std::size_t sheet, int row, const Ways& ways, bool all) {
  const auto first = std::size_t(named_[sheet].name(row, 0));
  const int columns = sheets_[sheet].columns;
  const std::size_t pairs = row + 1 < sheets_[sheet].points->rows ? kPairs : 2;
  std::uint8_t* const awake = awake_.data() + first;
  std::fill_n(awake, columns, std::uint8_t(0));
  for (std::size_t pair = 0; pair < pairs; ++pair) {
    const int begin = pair == 2 ? 1 : 0, end = columns - (pair == 1 || pair == 4 ? 1 : 0);
    const float* const until = until_[pair].data() + first;
    const float* const way = ways.all.data() + first;
    const float* const other = way + step(sheet, pair);
    const auto bit = std::uint8_t(1 << pair);
    for (int i = begin; i < end; ++i)
      awake[i] = std::uint8_t(awake[i] | (all || way[i] + other[i] >= until[i] ? bit : 0));
  }
}

void BesideSquares::list(const Ways& ways, bool all, const std::vector<std::uint8_t>& marked,
                         Threads& threads) {
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    threads.share(std::size_t(rows_of(sheets_[s])), squares_.size() < kFewSquares,
                  [&](std::size_t j) {
                    find_awake(s, int(j), ways, all);
                    list_row(s, int(j), marked, pairs_[first_row_[s] + j]);
                  });
}

void BesideSquares::list_row(std::size_t sheet, int row, const std::vector<std::uint8_t>& marked,
                             SquarePairs& found) {
  const int columns = sheets_[sheet].columns;
  found.count = 0;
  found.reserve(kPairs * std::size_t(columns));
  for (int i = 0; i < columns; ++i) {
    const auto p = std::size_t(named_[sheet].name(row, i));
    for (unsigned left = awake_[p]; left != 0; left &= left - 1) {
      const auto pair = std::size_t(std::countr_zero(left));
      const std::size_t q = p + std::size_t(step(sheet, pair));
      if (has_corner_in(squares_[p], marked) || has_corner_in(squares_[q], marked)) continue;
      found.put(std::int32_t(p), std::int32_t(q), std::int32_t(kPairs * p + pair));
    }
  }
}

// How a square lies: its mean edges, and how far its edges are off them.
auto BesideSquares::lie_of(std::size_t n, const Place* place) const -> Lie {
  const std::int32_t* const corner = squares_[n].corner;
  const Record a = Record::Map(place[corner[0]].x), b = Record::Map(place[corner[1]].x);
  const Record c = Record::Map(place[corner[2]].x), d = Record::Map(place[corner[3]].x);
  const Record u = 0.5f * (b - a + d - c), v = 0.5f * (c - a + d - b);
  const Record off = 0.5f * (a + d - b - c);
  Lie lie;
  Record::Map(lie.u) = u;
  Record::Map(lie.v) = v;
  lie.uu = product(u, u);
  lie.vv = product(v, v);
  lie.warp = std::sqrt(product(off, off));
  return lie;
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
// Edges change by no more than corners come from each other.
float BesideSquares::alike(std::int32_t number, const Place* place) const {
  constexpr float kApart = 0.6f;  // ρ, with what an interval may change
  // Of the shorter edge at rest: looked at again after the first of these by which they may change. Flat squares may
  // by 0.07.
  constexpr float kChanges[] = {0.065f, 0.03f, 0};
  const std::size_t p = std::size_t(number) / kPairs, pair = std::size_t(number) % kPairs;
  std::size_t of = sheets_.size() - 1;
  while (std::int32_t(p) < named_[of].first) --of;
  const Sheet& sheet = sheets_[of];
  const Lie a = lie_of(p, place);
  const Lie b = pair == 0 ? a : lie_of(p + std::size_t(step(of, pair)), place);
  const Record au = Record::Map(a.u), av = Record::Map(a.v);
  const Record bu = Record::Map(b.u), bv = Record::Map(b.v);
  const float uu = product(au, bu), vv = product(av, bv);
  const float askew = std::max({std::abs(product(au, av)), std::abs(product(au, bv)),
                                std::abs(product(bu, av)), std::abs(product(bu, bv))});
  const float warp = std::max(a.warp, b.warp);
  const float least_u = least_between(a.uu, b.uu, uu), least_v = least_between(a.vv, b.vv, vv);
  const float longest = std::sqrt(std::max({a.uu, b.uu, a.vv, b.vv}));
  const float rest = std::sqrt(sheet.uu * sheet.vv);
  // Whether they do when edges are others by so much.
  const auto holds = [&](float change) {
    const float off = warp + 2 * change, u = least_u - off, v = least_v - off;
    const float most = askew + off * (2 * (longest + change) + off);
    const float needed = kApart * kApart * (1 + std::abs(sheet.uv) / rest) + most / rest;
    return u > 0 && v > 0 && u * u >= needed * sheet.uu && v * v >= needed * sheet.vv;
  };
  for (const float share : kChanges) {
    const float change = share * std::sqrt(std::min(sheet.uu, sheet.vv));
    if (holds(change)) return change;
  }
  return -1;
}

std::size_t BesideSquares::bytes() const {
  std::size_t bytes = squares_.size() * (4 * kPairs + 1);
  for (const SquarePairs& p : pairs_) bytes += p.bytes();
  return bytes;
}

}  // namespace weft::physics
