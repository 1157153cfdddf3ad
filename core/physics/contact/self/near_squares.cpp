// The list of near squares (near_squares.h).
#include "physics/contact/self/near_squares.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace weft::physics {
namespace {

constexpr float kBeyond = 0.4f;      // spacings that listed pairs may be farther apart than is held
constexpr float kOverstretched = 3;  // half-diagonals at rest: larger squares are torn and left out
constexpr std::size_t kFewParticles = 4096;
constexpr std::size_t kAtOnce = 1024;  // pairs that are looked through in one go

// Adds the pairs of pieces, piece after piece.
void join(const std::vector<SquarePairs>& pieces, std::size_t count, SquarePairs& to) {
  for (std::size_t k = 0; k < count; ++k) {
    const SquarePairs& found = pieces[k];
    to.reserve(to.count + found.count);
    std::copy_n(found.owner.data(), found.count, to.owner.data() + to.count);
    std::copy_n(found.neighbour.data(), found.count, to.neighbour.data() + to.count);
    to.count += found.count;
  }
  to.pad();
}

void widen(Spread& spread, int k, float value) {
  spread.low[k] = std::min(spread.low[k], value);
  spread.high[k] = std::max(spread.high[k], value);
}

// The least length of a mean of two vectors, by their squares and their product.
float least_between(float aa, float bb, float ab) {
  const float least = std::min(aa, bb);
  if (ab >= least) return std::sqrt(least);
  return std::sqrt(std::max(0.0f, aa * bb - ab * ab) / (aa + bb - 2 * ab));
}

float half_diagonal(const Sheet& s) {
  return 0.5f * std::sqrt(s.uu + s.vv + 2 * std::abs(s.uv));
}

}  // namespace

void SquarePairs::reserve(std::size_t pairs) {
  if (owner.size() >= pairs + kPadding) return;
  owner.resize(2 * pairs + kPadding);
  neighbour.resize(owner.size());
}

void SquarePairs::pad() {
  reserve(count);
  for (std::vector<std::int32_t>* of : {&owner, &neighbour})
    std::fill_n(of->data() + count, kPadding, 0);
}

std::size_t SquarePairs::bytes() const {
  return owner.capacity() * 2 * sizeof(std::int32_t);
}

NearSquares::NearSquares(const std::vector<Sheet>& sheets, const std::vector<NamedSheet>& named,
                         std::size_t bodies, const KernelTable& kernels)
    : sheets_(sheets),
      named_(named),
      kernels_(kernels),
      search_(count_particles(sheets_), {}, kernels) {
  float spacing = 0;
  for (const Sheet& s : sheets_) {
    spacing = std::max({spacing, std::sqrt(s.uu), std::sqrt(s.vv)});
    most_ = std::max(most_, s.thickness);
    all_squares_ += std::size_t(s.lattice->columns) * std::size_t(s.lattice->rows);
  }
  beyond_ = kBeyond * spacing;
  squares_.resize(bodies);
  origins_.resize(bodies);
  chosen_.resize(bodies);
  passing_.resize(bodies);
  asked_.resize(bodies);
  boxes_.resize(bodies);
  lies_.resize(bodies);
  stride_.resize(bodies);
  beside_.resize(row_number(sheets_.size(), 0));
  row_moved_.resize(beside_.size());
  begin_.resize(bodies + 1);
  sorted_.resize(all_squares_);
  left_out_.reserve(all_squares_);
  joined_.reserve(all_squares_);
  make_squares();
}

// visit(number, sheet, row, column).
template <class Visit>
void NearSquares::for_each_square(const Visit& visit) const {
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    for (int j = 0; j < sheets_[s].lattice->rows; ++j)
      for (int i = 0; i < sheets_[s].lattice->columns; ++i) visit(number(s, j, i), s, j, i);
}

void NearSquares::make_squares() {
  for_each_square([&](std::size_t n, std::size_t sheet, int j, int i) {
    const Lattice& l = *sheets_[sheet].lattice;
    stride_[n] = named_[sheet].stride;
    for (int c = 0; c < 4; ++c)
      squares_[n].corner[c] = std::int32_t(
          number(sheet, std::min(j + (c >> 1), l.rows - 1), std::min(i + (c & 1), l.columns - 1)));
  });
}

void NearSquares::leave_out(const std::vector<std::uint8_t>& marked) {
  std::size_t at = 0;
  for_each_square([&](std::size_t n, std::size_t, int, int) { passing_[n] = marked[at++]; });
}

void NearSquares::update(bool all, const Place* now, Threads& threads) {
  now_ = now;
  joined_.clear();
  if (all) {
    std::fill(row_moved_.begin(), row_moved_.end(), std::uint8_t{1});
  } else {
    look_how_far();
    look_who_joined();
  }
  if (all || !joined_.empty() || left() <= 0) list(all, threads);
}

// The common part of all motion is the middle of what all have moved.
void NearSquares::look_how_far() {
  Spread moved = nothing();
  const auto off = [&](std::size_t n, int k) {
    return now_[n].x[k] - frame_[k] - origins_[n].x[k];
  };
  for_each_square([&](std::size_t n, std::size_t, int, int) {
    for (int k = 0; k < 3; ++k) widen(moved, k, off(n, k));
  });
  for (int k = 0; k < 3; ++k) frame_[k] += 0.5f * (moved.low[k] + moved.high[k]);
  float gone_squared = 0;
  for_each_square([&](std::size_t n, std::size_t, int, int) {
    Origin& origin = origins_[n];
    origin.gone_squared = 0;
    for (int k = 0; k < 3; ++k) origin.gone_squared += off(n, k) * off(n, k);
    gone_squared = std::max(gone_squared, origin.gone_squared);
  });
  gone_ = std::sqrt(gone_squared);
}

// Squares that were left out and have come together again: their pairs are to be listed.
void NearSquares::look_who_joined() {
  for (const LeftOut& square : left_out_) {
    float middle[3];
    const auto number = std::size_t(square.number);
    if (!(middle_of(number, middle) <= square.most_squared)) continue;
    joined_.push_back(square.number);
    for (const std::int32_t c : squares_[number].corner)
      origins_[std::size_t(c)].gone_squared = std::numeric_limits<float>::max();
  }
}

// The pairs of those squares that have a vertex which has gone far; of all where that are many.
//
// Vertices that are chosen start anew: they have gone nowhere. The others may have gone kFar beyond_
// before, so much less is left of what pairs that are not listed are apart (left()).
void NearSquares::list(bool all, Threads& threads) {
  std::size_t asked = all ? all_squares_ : choose(false);
  if (asked > all_squares_ / 2) {
    asked = choose(true);
    listed_.count = 0;
  }
  squares_listed_ += double(asked);
  Spread box;
  std::size_t whole = 0;
  const float range = most_ + beyond_ + 2 * list_whole(box, whole);
  search_.sort(whole, box, range, threads);
  threads.share(search_.chunks(), search_.few(), [&](std::size_t k) {
    for (std::size_t p = search_.begin(k); p < search_.begin(k + 1); ++p) fill_box(p);
  });
  search_.find(range, threads);
  if (found_.size() < search_.chunks()) found_.resize(search_.chunks());
  threads.share(search_.chunks(), search_.few(), [&](std::size_t k) { find_in(k); });
  take_found();
  sort_listed();
}

// Vertices that start anew, and the squares that they are corners of; returns how many these are.
std::size_t NearSquares::choose(bool all) {
  const float far = kFar * beyond_;
  float gone_squared = 0;
  for_each_square([&](std::size_t n, std::size_t, int, int) {
    Origin& origin = origins_[n];
    chosen_[n] = all || origin.gone_squared > far * far;
    if (chosen_[n]) {
      for (int k = 0; k < 3; ++k) origin.x[k] = now_[n].x[k] - frame_[k];
      origin.gone_squared = 0;
    }
    gone_squared = std::max(gone_squared, origin.gone_squared);
  });
  gone_ = std::sqrt(gone_squared);
  std::size_t asked = 0;
  for_each_square([&](std::size_t n, std::size_t, int, int) {
    asked_[n] = has_corner_in(squares_[n], chosen_);
    asked += asked_[n];
  });
  return asked;
}

// The middle of a square's corners, and how far from it they are at most, squared.
float NearSquares::middle_of(std::size_t square, float (&middle)[3]) const {
  float off[4] = {};
  for (int k = 0; k < 3; ++k) {
    float x[4];
    for (int c = 0; c < 4; ++c) x[c] = now_[std::size_t(squares_[square].corner[c])].x[k];
    middle[k] = 0.25f * (x[0] + x[1] + x[2] + x[3]);
    for (int c = 0; c < 4; ++c) off[c] += (x[c] - middle[k]) * (x[c] - middle[k]);
  }
  return *std::max_element(off, off + 4);
}

// The middles of all squares that are whole, for the search; returns the greatest distance of a corner
// from the middle.
float NearSquares::list_whole(Spread& box, std::size_t& count) {
  box = nothing();
  left_out_.clear();
  float widest_squared = 0;
  const Row3 to = search_.points();
  for_each_square([&](std::size_t n, std::size_t sheet, int, int) {
    if (has_corner_in(squares_[n], passing_)) return;
    const float most = kOverstretched * half_diagonal(sheets_[sheet]);
    float middle[3];
    const float radius_squared = middle_of(n, middle);
    if (!(radius_squared <= most * most)) {
      left_out_.push_back({std::int32_t(n), most * most});
      return;
    }
    widest_squared = std::max(widest_squared, radius_squared);
    to.x[count] = middle[0];
    to.y[count] = middle[1];
    to.z[count] = middle[2];
    for (int k = 0; k < 3; ++k) widen(box, k, middle[k]);
    search_.names()[count++] = std::int32_t(n);
  });
  return std::sqrt(widest_squared);
}

// The box about one square.
void NearSquares::fill_box(std::size_t sorted) {
  const auto n = std::size_t(search_.name(sorted));
  sorted_[sorted] = std::int32_t(n);
  SquareBox& box = boxes_[sorted];
  for (int c = 0; c < 4; ++c) {
    const float* const x = now_[std::size_t(squares_[n].corner[c])].x;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = c == 0 ? x[k] : std::min(box.low[k], x[k]);
      box.high[k] = c == 0 ? x[k] : std::max(box.high[k], x[k]);
    }
  }
  box.asked = asked_[n];
}

// Whether two squares share a corner, p < q: names of a sheet's squares differ as their places do.
bool NearSquares::beside(std::int32_t p, std::int32_t q) const {
  const std::int32_t stride = stride_[std::size_t(p)], apart = q - p;
  return apart <= 1 || (apart >= stride - 1 && apart <= stride + 1);
}

// The pairs of a chunk of the search that are asked for and within reach, but for those that share a
// corner.
void NearSquares::find_in(std::size_t chunk) {
  const PairSearch::Pairs near = search_.pairs(chunk);
  SquarePairs& found = found_[chunk];
  found.reserve(near.count);
  found.count = std::size_t(
      kernels_.squares_within({boxes_.data(), int(near.count), near.owner, near.neighbour,
                               most_ + beyond_, found.owner.data(), found.neighbour.data()}));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < found.count; ++i) {
    const auto [p, q] =
        std::minmax(sorted_[std::size_t(found.owner[i])], sorted_[std::size_t(found.neighbour[i])]);
    if (beside(p, q)) continue;
    found.owner[kept] = p;
    found.neighbour[kept++] = q;
  }
  found.count = kept;
}

// In place of all listed pairs of the squares asked for.
void NearSquares::take_found() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < listed_.count; ++i) {
    if (asked_[std::size_t(listed_.owner[i])] || asked_[std::size_t(listed_.neighbour[i])])
      continue;
    listed_.owner[kept] = listed_.owner[i];
    listed_.neighbour[kept++] = listed_.neighbour[i];
  }
  for (std::size_t k = 0; k < search_.chunks(); ++k) {
    const SquarePairs& found = found_[k];
    listed_.reserve(kept + found.count);
    std::copy_n(found.owner.data(), found.count, listed_.owner.data() + kept);
    std::copy_n(found.neighbour.data(), found.count, listed_.neighbour.data() + kept);
    kept += found.count;
  }
  listed_.count = kept;
  listed_.pad();
}

// By their owners, and those of one owner by their neighbours.
void NearSquares::sort_listed() {
  std::fill(begin_.begin(), begin_.end(), 0);
  for (std::size_t i = 0; i < listed_.count; ++i) ++begin_[std::size_t(listed_.owner[i]) + 1];
  for (std::size_t n = 1; n < begin_.size(); ++n) begin_[n] += begin_[n - 1];
  within_.reserve(listed_.count);
  for (std::size_t i = 0; i < listed_.count; ++i) {
    const auto at = std::size_t(begin_[std::size_t(listed_.owner[i])]++);
    within_.owner[at] = listed_.owner[i];
    within_.neighbour[at] = listed_.neighbour[i];
  }
  for (std::size_t i = 0; i < listed_.count;) {
    std::size_t end = i;
    while (end < listed_.count && within_.owner[end] == within_.owner[i]) ++end;
    std::sort(within_.neighbour.begin() + std::ptrdiff_t(i),
              within_.neighbour.begin() + std::ptrdiff_t(end));
    i = end;
  }
  within_.count = listed_.count;
  within_.pad();
  std::swap(listed_, within_);
}

// How a square lies: its mean edges, and how far its edges are off them.
auto NearSquares::lie_of(std::size_t n, const Place* place) const -> Lie {
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

// A row is measured anew where edges have changed by so much that it may matter.
void NearSquares::measure_row(std::size_t sheet, int row, const Place* place) {
  constexpr float kChange = 0.03f;  // of the shorter edge at rest
  const Sheet& s = sheets_[sheet];
  const float most = kChange * kChange * std::min(s.uu, s.vv);
  std::uint8_t& moved = row_moved_[row_number(sheet, row)];
  const std::size_t begin = number(sheet, row, 0), end = begin + std::size_t(s.lattice->columns);
  for (std::size_t n = begin; n < end && !moved; ++n) {
    const Lie now = lie_of(n, place), &then = lies_[n];
    float du = 0, dv = 0;
    for (int k = 0; k < 3; ++k) {
      du += (now.u[k] - then.u[k]) * (now.u[k] - then.u[k]);
      dv += (now.v[k] - then.v[k]) * (now.v[k] - then.v[k]);
    }
    const float warped = now.warp - then.warp;
    moved = !(std::max({du, dv, warped * warped}) <= most);
  }
  for (std::size_t n = begin; moved && n < end; ++n) lies_[n] = lie_of(n, place);
}

std::size_t NearSquares::row_number(std::size_t sheet, int row) const {
  std::size_t first = 0;
  for (std::size_t s = 0; s < sheet; ++s) first += std::size_t(sheets_[s].lattice->rows);
  return first + std::size_t(row);
}

// Lists of rows that have changed, or the row after them has.
void NearSquares::list_rows_beside(Threads& threads) {
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const int rows = sheets_[s].lattice->rows;
    threads.share(std::size_t(rows), all_squares_ < kFewParticles, [&](std::size_t j) {
      const std::size_t n = row_number(s, int(j));
      if (row_moved_[n] || (int(j) + 1 < rows && row_moved_[n + 1]))
        list_beside(s, int(j), beside_[n]);
    });
  }
  std::fill(row_moved_.begin(), row_moved_.end(), std::uint8_t{0});
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
bool NearSquares::lie_alike(const Sheet& sheet, std::size_t p, std::size_t q) const {
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

// Pairs of squares that share a corner, and each with itself, unless they lie flat.
void NearSquares::list_beside(std::size_t sheet, int row, SquarePairs& found) const {
  const Lattice& l = *sheets_[sheet].lattice;
  found.count = 0;
  found.reserve(5 * std::size_t(l.columns));
  const auto add = [&](std::size_t p, std::size_t q) {
    if (lie_alike(sheets_[sheet], p, q)) return;
    if (has_corner_in(squares_[p], passing_) || has_corner_in(squares_[q], passing_)) return;
    found.owner[found.count] = std::int32_t(p);
    found.neighbour[found.count++] = std::int32_t(q);
  };
  for (int i = 0; i < l.columns; ++i) {
    const std::size_t n = number(sheet, row, i);
    add(n, n);
    if (i + 1 < l.columns) add(n, n + 1);
    if (row + 1 == l.rows) continue;
    for (int across = i > 0 ? -1 : 0; across <= (i + 1 < l.columns ? 1 : 0); ++across)
      add(n, number(sheet, row + 1, i + across));
  }
}

// The box about every square in an interval, and how it lies at its start.
void NearSquares::bound(const Place* place, const Displacement* moved, Threads& threads) {
  const auto widen_by = [&](std::int32_t corner, SquareBox& box, bool first) {
    for (int k = 0; k < 3; ++k) {
      const float from = place[corner].x[k], to = from + moved[corner].u[k];
      box.low[k] = std::min(first ? from : box.low[k], std::min(from, to));
      box.high[k] = std::max(first ? from : box.high[k], std::max(from, to));
    }
  };
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    threads.share(std::size_t(sheets_[s].lattice->rows), all_squares_ < kFewParticles,
                  [&](std::size_t j) {
                    for (int i = 0; i < sheets_[s].lattice->columns; ++i) {
                      const std::size_t n = number(s, int(j), i);
                      for (int c = 0; c < 4; ++c)
                        widen_by(squares_[n].corner[c], boxes_[n], c == 0);
                      boxes_[n].asked = 1;
                    }
                    measure_row(s, int(j), place);
                  });
}

const SquarePairs& NearSquares::within(float range, const Place* place, const Displacement* moved,
                                       Threads& threads) {
  within_range_ = range;
  bound(place, moved, threads);
  list_rows_beside(threads);
  const std::size_t pieces = (listed_.count + kAtOnce - 1) / kAtOnce;
  if (found_.size() < pieces) found_.resize(pieces);
  threads.share(pieces, pieces < 8, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(listed_.count - first, kAtOnce);
    SquarePairs& found = found_[k];
    found.reserve(count);
    std::int32_t *const owner = found.owner.data(), *const neighbour = found.neighbour.data();
    const int near =
        kernels_.squares_within({boxes_.data(), int(count), listed_.owner.data() + first,
                                 listed_.neighbour.data() + first, range, owner, neighbour});
    found.count = std::size_t(kernels_.squares_not_apart(
        {place, moved, squares_.data(), near, owner, neighbour, range, owner, neighbour}));
  });
  within_.count = 0;
  join(beside_, beside_.size(), within_);
  join(found_, pieces, within_);
  return within_;
}

const SquarePairs& NearSquares::still_within(float range, const Place* place,
                                             const Displacement* moved, Threads& threads) {
  assert(range <= within_range_);
  const std::size_t pieces = (within_.count + kAtOnce - 1) / kAtOnce;
  if (found_.size() < pieces) found_.resize(pieces);
  threads.share(pieces, pieces < 8, [&](std::size_t k) {
    const std::size_t first = k * kAtOnce, count = std::min(within_.count - first, kAtOnce);
    SquarePairs& found = found_[k];
    found.reserve(count);
    found.count = std::size_t(kernels_.squares_not_apart(
        {place, moved, squares_.data(), int(count), within_.owner.data() + first,
         within_.neighbour.data() + first, range, found.owner.data(), found.neighbour.data()}));
  });
  still_.count = 0;
  join(found_, pieces, still_);
  return still_;
}

double NearSquares::listed() const {
  return squares_listed_ / double(std::max<std::size_t>(all_squares_, 1));
}

std::size_t NearSquares::bytes() const {
  std::size_t bytes = search_.bytes();
  bytes += squares_.size() * (sizeof(Square) + sizeof(Origin) + sizeof(SquareBox) + 3);
  bytes += all_squares_ * (sizeof(LeftOut) + 8) + 4 * begin_.size();
  bytes += listed_.bytes() + within_.bytes() + still_.bytes();
  for (const auto* lists : {&found_, &beside_})
    for (const SquarePairs& p : *lists) bytes += p.bytes();
  bytes += lies_.size() * sizeof(Lie) + row_moved_.size();
  return bytes;
}

}  // namespace weft::physics
