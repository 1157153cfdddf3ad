// The list of near squares (near_squares.h).
#include "physics/contact/self/near_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::physics {
namespace {

constexpr float kBeyond = 0.4f;      // spacings that listed pairs may be farther apart than is held
constexpr float kClose = 0.25f;      // spacings that neighbours are kept apart
constexpr float kOverstretched = 2;  // half-diagonals at rest: larger squares are torn and left out
constexpr std::size_t kFewParticles = 4096;

void widen(Spread& spread, int k, float value) {
  spread.low[k] = std::min(spread.low[k], value);
  spread.high[k] = std::max(spread.high[k], value);
}

float half_diagonal(const Sheet& s) {
  return 0.5f * std::sqrt(s.uu + s.vv + 2 * std::abs(s.uv));
}

}  // namespace

void SquarePairs::reserve(std::size_t pairs) {
  if (owner.size() >= pairs + kPadding) return;
  owner.resize(2 * pairs + kPadding);
  neighbour.resize(owner.size());
  near_squared.resize(owner.size());
}

void SquarePairs::pad() {
  reserve(count);
  for (std::vector<std::int32_t>* of : {&owner, &neighbour})
    std::fill_n(of->data() + count, kPadding, 0);
}

std::size_t SquarePairs::bytes() const {
  return owner.capacity() * (2 * sizeof(std::int32_t) + sizeof(float));
}

NearSquares::NearSquares(const std::vector<Sheet>& sheets, const KernelTable& kernels)
    : sheets_(sheets), kernels_(kernels), search_(count_particles(sheets_), {}, kernels) {
  float spacing = 0;
  close_ = least_ = std::numeric_limits<float>::max();
  for (const Sheet& s : sheets_) {
    spacing = std::max({spacing, std::sqrt(s.uu), std::sqrt(s.vv)});
    most_ = std::max(most_, s.thickness);
    least_ = std::min(least_, s.thickness);
    close_ = std::min({close_, kClose * std::sqrt(s.uu), kClose * std::sqrt(s.vv)});
  }
  least_ = std::min(least_, close_);
  beyond_ = kBeyond * spacing;
  make_squares();
  const std::size_t n = squares_.size();
  vertices_.resize(n);
  origins_.resize(n);
  chosen_.resize(n);
  passing_.resize(n);
  asked_.resize(n);
  sorted_.resize(n);
  boxes_.resize(n);
  left_out_.reserve(n);
  joined_.reserve(n);
}

void NearSquares::make_squares() {
  constexpr float kBetweenSheets = 1e5f;  // columns
  for (std::size_t n = 0; n < sheets_.size(); ++n) {
    const Sheet& s = sheets_[n];
    const Lattice& l = *s.lattice;
    first_.push_back(squares_.size());
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i) {
        Square q{};
        for (int c = 0; c < 4; ++c)
          q.corner[c] = std::int32_t(
              number(n, std::min(j + (c >> 1), l.rows - 1), std::min(i + (c & 1), l.columns - 1)));
        q.place[0] = float(i) + kBetweenSheets * float(n);
        q.place[1] = float(j);
        q.thickness = s.thickness;
        q.friction = s.friction;
        squares_.push_back(q);
      }
  }
}

void NearSquares::update(bool all, const float (&frame)[3], Threads& threads) {
  read_vertices(threads);
  joined_.clear();
  if (!all) {
    look_how_far(frame);
    look_who_joined();
  }
  if (all || !joined_.empty() || unlisted() <= least_) list(all, frame, threads);
}

void NearSquares::read_vertices(Threads& threads) {
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    Lattice& l = *sheets_[s].lattice;
    threads.share(std::size_t(l.rows), vertices_.size() < kFewParticles, [&](std::size_t j) {
      const Row3 x = l.x.row(int(j)), v = l.v.row(int(j));
      const float* const w = l.w(int(j));
      Vertex* const to = &vertices_[number(s, int(j), 0)];
      for (int i = 0; i < l.columns; ++i)
        to[i] = {{x.x[i], x.y[i], x.z[i]}, w[i], {v.x[i], v.y[i], v.z[i]}, 0};
    });
  }
}

void NearSquares::look_how_far(const float (&frame)[3]) {
  float gone_squared = 0;
  for (std::size_t n = 0; n < origins_.size(); ++n) {
    Origin& origin = origins_[n];
    origin.gone_squared = 0;
    for (int k = 0; k < 3; ++k) {
      const float gone = vertices_[n].x[k] - frame[k] - origin.x[k];
      origin.gone_squared += gone * gone;
    }
    gone_squared = std::max(gone_squared, origin.gone_squared);
  }
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
// before, so much less is left of what pairs that are not listed are apart (unlisted()).
void NearSquares::list(bool all, const float (&frame)[3], Threads& threads) {
  std::size_t asked = all ? squares_.size() : choose(false, frame);
  if (asked > squares_.size() / 2) {
    asked = choose(true, frame);
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
  threads.share(search_.chunks(), false, [&](std::size_t k) { find_in(k); });
  take_found();
}

// Vertices that start anew, and the squares that they are corners of; returns how many these are.
std::size_t NearSquares::choose(bool all, const float (&frame)[3]) {
  const float far = kFar * beyond_;
  float gone_squared = 0;
  for (std::size_t n = 0; n < origins_.size(); ++n) {
    Origin& origin = origins_[n];
    chosen_[n] = all || origin.gone_squared > far * far;
    if (chosen_[n]) {
      for (int k = 0; k < 3; ++k) origin.x[k] = vertices_[n].x[k] - frame[k];
      origin.gone_squared = 0;
    }
    gone_squared = std::max(gone_squared, origin.gone_squared);
  }
  gone_ = std::sqrt(gone_squared);
  std::size_t asked = 0;
  for (std::size_t n = 0; n < squares_.size(); ++n) {
    asked_[n] = has_corner_in(squares_[n], chosen_);
    asked += asked_[n];
  }
  return asked;
}

// The middle of a square's corners, and how far from it they are at most, squared.
float NearSquares::middle_of(std::size_t square, float (&middle)[3]) const {
  float off[4] = {};
  for (int k = 0; k < 3; ++k) {
    float x[4];
    for (int c = 0; c < 4; ++c) x[c] = vertices_[std::size_t(squares_[square].corner[c])].x[k];
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
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const Lattice& l = *sheets_[s].lattice;
    const float most = kOverstretched * half_diagonal(sheets_[s]);
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i) {
        const std::size_t n = number(s, j, i);
        if (has_corner_in(squares_[n], passing_)) continue;
        float middle[3];
        const float radius_squared = middle_of(n, middle);
        if (!(radius_squared <= most * most)) {
          left_out_.push_back({std::int32_t(n), most * most});
          continue;
        }
        widest_squared = std::max(widest_squared, radius_squared);
        to.x[count] = middle[0];
        to.y[count] = middle[1];
        to.z[count] = middle[2];
        for (int k = 0; k < 3; ++k) widen(box, k, middle[k]);
        search_.names()[count++] = std::int32_t(n);
      }
  }
  return std::sqrt(widest_squared);
}

// The box about one square.
void NearSquares::fill_box(std::size_t sorted) {
  const auto n = std::size_t(search_.name(sorted));
  sorted_[sorted] = std::int32_t(n);
  SquareBox& box = boxes_[sorted];
  for (int c = 0; c < 4; ++c) {
    const float* const x = vertices_[std::size_t(squares_[n].corner[c])].x;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = c == 0 ? x[k] : std::min(box.low[k], x[k]);
      box.high[k] = c == 0 ? x[k] : std::max(box.high[k], x[k]);
    }
  }
  box.asked = asked_[n];
}

// The pairs of a chunk of the search that are asked for and within reach.
void NearSquares::find_in(std::size_t chunk) {
  const PairSearch::Pairs near = search_.pairs(chunk);
  const std::size_t begin = search_.begin(chunk), end = search_.begin(chunk + 1);
  SquarePairs& found = found_[chunk];
  found.reserve(near.count + (end - begin));
  found.count = std::size_t(
      kernels_.squares_within({boxes_.data(), int(near.count), near.owner, near.neighbour,
                               most_ + beyond_, found.owner.data(), found.neighbour.data()}));
  for (std::size_t i = 0; i < found.count; ++i) {
    // In this order, so that a pair is measured to the same bits however it was found.
    const auto [p, q] =
        std::minmax(sorted_[std::size_t(found.owner[i])], sorted_[std::size_t(found.neighbour[i])]);
    found.owner[i] = p;
    found.neighbour[i] = q;
  }
  // A square folded along its diagonal: its own A comes near its own BDC.
  for (std::size_t p = begin; p < end; ++p)
    if (boxes_[p].asked > 0) {
      found.owner[found.count] = sorted_[p];
      found.neighbour[found.count++] = sorted_[p];
    }
  found.pad();
  const std::size_t count = found.count;
  kernels_.surface_pairs({vertices_.data(), squares_.data(), int(count), found.owner.data(),
                          found.neighbour.data(), close_, beyond_, found.near_squared.data(),
                          nullptr});
  found.count = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (found.near_squared[i] < kOutOfReach) {
      found.owner[found.count] = found.owner[i];
      found.neighbour[found.count] = found.neighbour[i];
      found.near_squared[found.count++] = found.near_squared[i];
    }
}

// In place of all listed pairs of the squares asked for.
void NearSquares::take_found() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < listed_.count; ++i) {
    if (asked_[std::size_t(listed_.owner[i])] || asked_[std::size_t(listed_.neighbour[i])])
      continue;
    listed_.owner[kept] = listed_.owner[i];
    listed_.neighbour[kept] = listed_.neighbour[i];
    listed_.near_squared[kept++] = listed_.near_squared[i];
  }
  for (std::size_t k = 0; k < search_.chunks(); ++k) {
    const SquarePairs& found = found_[k];
    listed_.reserve(kept + found.count);
    std::copy_n(found.owner.data(), found.count, listed_.owner.data() + kept);
    std::copy_n(found.neighbour.data(), found.count, listed_.neighbour.data() + kept);
    std::copy_n(found.near_squared.data(), found.count, listed_.near_squared.data() + kept);
    kept += found.count;
  }
  listed_.count = kept;
  listed_.pad();
}

double NearSquares::listed() const {
  return squares_listed_ / double(std::max<std::size_t>(squares_.size(), 1));
}

std::size_t NearSquares::bytes() const {
  std::size_t bytes = search_.bytes();
  bytes += squares_.size() * (sizeof(Square) + sizeof(Vertex) + sizeof(Origin) + sizeof(SquareBox) +
                              sizeof(LeftOut) + 10);
  bytes += listed_.bytes();
  for (const SquarePairs& p : found_) bytes += p.bytes();
  return bytes;
}

}  // namespace weft::physics
