// Self-collision among surfaces (surface.h).
#include "physics/self_collision/surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace weft::physics {
namespace {

constexpr float kBound = 0.45f;     // of the least distance beyond the floor, the push included
constexpr float kMostPush = 0.25f;  // of the least distance, at once
constexpr float kFloor = 0.05f;     // of the thickness: what is nearer is only pushed apart
constexpr float kMeasureAt = 0.8f;  // of a bound, moved: a vertex is hot, and measured anew
constexpr double kMostHot = 0.3;    // of the vertices: more, and all is
constexpr float kComeAt = 0.8f;     // of the rest of a bound, at its speed: time to come again
constexpr int kMostSubsteps = 8;    // between two times
constexpr float kBeyond = 0.4f;     // spacings that listed pairs may be farther apart than is held
constexpr float kClose = 0.25f;     // spacings that neighbours are kept apart
constexpr float kLeastBound = 1e-12f;  // m, to divide by
constexpr std::size_t kAtOnce = 256;   // pairs that are measured in one call
constexpr std::size_t kFewParticles = 4096;
constexpr std::size_t kPadding = 32;  // that kernels may write
constexpr float kOverstretched = 2;  // half-diagonals at rest: larger squares are torn and left out

std::size_t count_particles(const std::vector<Sheet>& sheets) {
  std::size_t n = 0;
  for (const Sheet& s : sheets) n += std::size_t(s.lattice->columns) * std::size_t(s.lattice->rows);
  return n;
}

// Only a square itself is no pair of it.
std::vector<RestMetric> metrics_of(const std::vector<Sheet>& sheets) {
  std::vector<RestMetric> metrics;
  for (const Sheet& s : sheets)
    metrics.push_back({s.lattice->columns, s.lattice->rows, 1, 0, 1, 0.5f});
  return metrics;
}

float square(const float* a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

void add(const SquareChange& change, SquareChange& sum) {
  for (int c = 0; c < 4; ++c) {
    for (int k = 0; k < 3; ++k) {
      sum.push[c][k] += change.push[c][k];
      sum.gain[c][k] += change.gain[c][k];
    }
    sum.weight[c] += change.weight[c];
  }
}

void widen(Spread& spread, int k, float value) {
  spread.low[k] = std::min(spread.low[k], value);
  spread.high[k] = std::max(spread.high[k], value);
}

float half_diagonal(const Sheet& s) {
  return 0.5f * std::sqrt(s.uu + s.vv + 2 * std::abs(s.uv));
}

}  // namespace

std::unique_ptr<SurfaceContact> SurfaceContact::make(const Scene& scene,
                                                     const std::vector<Sheet>& sheets,
                                                     const KernelTable& kernels) {
  const bool asked = std::any_of(scene.cloths.begin(), scene.cloths.end(), [](const Cloth& c) {
    return c.self_collision.mode == SelfCollisionMode::surface;
  });
  return asked ? std::unique_ptr<SurfaceContact>(new SurfaceContact(sheets, kernels)) : nullptr;
}

void SurfaceContact::Pairs::reserve(std::size_t pairs) {
  if (owner.size() >= pairs + kPadding) return;
  owner.resize(2 * pairs + kPadding);
  neighbour.resize(owner.size());
  near_squared.resize(owner.size());
}

void SurfaceContact::Pairs::pad() {
  for (std::vector<std::int32_t>* of : {&owner, &neighbour})
    std::fill_n(of->data() + count, kPadding, 0);
}

SurfaceContact::SurfaceContact(std::vector<Sheet> sheets, const KernelTable& kernels)
    : sheets_(std::move(sheets)),
      kernels_(kernels),
      search_(count_particles(sheets_), metrics_of(sheets_), true, kernels) {
  constexpr float kBetweenSheets = 1e5f;  // columns
  float spacing = 0, most = 0;
  close_ = least_ = floor_ = std::numeric_limits<float>::max();
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
    spacing = std::max({spacing, std::sqrt(s.uu), std::sqrt(s.vv)});
    most = std::max(most, s.thickness);
    least_ = std::min(least_, s.thickness);
    close_ = std::min({close_, kClose * std::sqrt(s.uu), kClose * std::sqrt(s.vv)});
    floor_ = std::min({floor_, kFloor * s.thickness, kFloor * close_});
  }
  least_ = std::min(least_, close_);
  beyond_ = kBeyond * spacing;
  reach_ = most + beyond_;
  const std::size_t n = squares_.size();
  vertices_.resize(n);
  places_.resize(n);
  chosen_.resize(n);
  asked_.resize(n);
  hot_.resize(n);
  sorted_.resize(n);
  boxes_.resize(n);
  sums_.resize(n);
  near_squared_.resize(n);
  left_out_.reserve(n);
}

void SurfaceContact::read_vertices(Threads& threads) {
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

// Which pairs are within reach, of those squares that have a vertex which has gone far; of all where
// that are many.
//
// Vertices that are chosen start anew: they have gone nowhere. The others may have gone kFar beyond_
// before, so much less is left of what pairs that are not listed are apart (unlisted()).
void SurfaceContact::list(Threads& threads) {
  std::size_t asked = valid_ ? choose(false) : squares_.size();
  if (asked > squares_.size() / 2) {
    asked = choose(true);
    listed_.count = 0;
  }
  squares_listed_ += double(asked);
  Spread box;
  std::size_t whole = 0;
  const float range = reach_ + 2 * list_squares(box, whole);
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
std::size_t SurfaceContact::choose(bool all) {
  const float far = kFar * beyond_;
  float gone_squared = 0;
  for (std::size_t n = 0; n < places_.size(); ++n) {
    Place& place = places_[n];
    chosen_[n] = all || place.gone_squared > far * far;
    if (chosen_[n]) {
      for (int k = 0; k < 3; ++k) place.listed[k] = vertices_[n].x[k] - frame_[k];
      place.gone_squared = 0;
    }
    gone_squared = std::max(gone_squared, place.gone_squared);
  }
  motion_.gone = std::sqrt(gone_squared);
  std::size_t asked = 0;
  for (std::size_t n = 0; n < squares_.size(); ++n) {
    const std::int32_t* const c = squares_[n].corner;
    asked_[n] = chosen_[std::size_t(c[0])] | chosen_[std::size_t(c[1])] |
                chosen_[std::size_t(c[2])] | chosen_[std::size_t(c[3])];
    asked += asked_[n];
  }
  return asked;
}

// The middle of a square's corners, and how far from it they are at most, squared.
float SurfaceContact::middle_of(std::size_t square, float (&middle)[3]) const {
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
float SurfaceContact::list_squares(Spread& box, std::size_t& count) {
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
        float middle[3];
        const float radius_squared = middle_of(n, middle);
        if (!(radius_squared <= most * most)) {
          left_out_.push_back({n, most * most});
          continue;
        }
        widest_squared = std::max(widest_squared, radius_squared);
        to.x[count] = middle[0];
        to.y[count] = middle[1];
        to.z[count] = middle[2];
        for (int k = 0; k < 3; ++k) widen(box, k, middle[k]);
        search_.sites()[count++] = {std::uint16_t(s), std::uint16_t(j), std::uint16_t(i)};
      }
  }
  return std::sqrt(widest_squared);
}

// Whether squares that were left out have come together again: then their pairs are to be listed, and
// measured.
bool SurfaceContact::come_together() {
  bool any = false;
  for (const LeftOut& square : left_out_) {
    float middle[3];
    if (!(middle_of(square.number, middle) <= square.most_squared)) continue;
    any = true;
    for (const std::int32_t c : squares_[square.number].corner) {
      places_[std::size_t(c)].gone_squared = std::numeric_limits<float>::max();
      hot_[std::size_t(c)] = true;
    }
  }
  return any;
}

// The box about one square.
void SurfaceContact::fill_box(std::size_t sorted) {
  const Site site = search_.site(sorted);
  const std::size_t n = number(site.cloth, site.row, site.column);
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
void SurfaceContact::find_in(std::size_t chunk) {
  const PairSearch::Pairs near = search_.pairs(chunk);
  const std::size_t begin = search_.begin(chunk), end = search_.begin(chunk + 1);
  Pairs& found = found_[chunk];
  found.reserve(near.count + (end - begin));
  found.count = std::size_t(
      kernels_.squares_within({boxes_.data(), int(near.count), near.owner, near.neighbour, reach_,
                               found.owner.data(), found.neighbour.data()}));
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
void SurfaceContact::take_found() {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < listed_.count; ++i) {
    if (asked_[std::size_t(listed_.owner[i])] || asked_[std::size_t(listed_.neighbour[i])])
      continue;
    listed_.owner[kept] = listed_.owner[i];
    listed_.neighbour[kept] = listed_.neighbour[i];
    listed_.near_squared[kept++] = listed_.near_squared[i];
  }
  for (std::size_t k = 0; k < search_.chunks(); ++k) {
    const Pairs& found = found_[k];
    listed_.reserve(kept + found.count);
    std::copy_n(found.owner.data(), found.count, listed_.owner.data() + kept);
    std::copy_n(found.neighbour.data(), found.count, listed_.neighbour.data() + kept);
    std::copy_n(found.near_squared.data(), found.count, listed_.near_squared.data() + kept);
    kept += found.count;
  }
  listed_.count = kept;
  listed_.pad();
}

// How far apart all is now, or those vertices alone that are near their bounds: pushes what touches,
// and bounds the way that everything may go from here.
void SurfaceContact::measure(bool all, Threads& threads) {
  read_vertices(threads);
  if (!valid_ || come_together() || unlisted() <= least_) list(threads);
  pairs_ = all ? &listed_ : &pairs_of_hot();
  const std::size_t pieces = (pairs_->count + kAtOnce - 1) / kAtOnce;
  if (pieces_.size() < pieces) pieces_.resize(pieces);
  threads.share(pieces, false, [&](std::size_t k) { measure_piece(k); });
  // Each goes through all pairs.
  const auto parts = std::size_t(threads.count());
  const std::size_t squares = squares_.size();
  threads.share(parts, false,
                [&](std::size_t k) { sum_up(k * squares / parts, (k + 1) * squares / parts); });
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    threads.share(std::size_t(sheets_[s].lattice->rows), squares < kFewParticles,
                  [&](std::size_t j) { set_places_and_push(s, int(j), all); });
  valid_ = true;
  if (all) since_ = 0;
  ++(all ? measured_ : measured_in_part_);
}

// And of what touched when it was measured last: that is pushed apart all the time.
const SurfaceContact::Pairs& SurfaceContact::pairs_of_hot() {
  const auto hot = [&](std::int32_t square) {
    const std::int32_t* const c = squares_[std::size_t(square)].corner;
    return hot_[std::size_t(c[0])] | hot_[std::size_t(c[1])] | hot_[std::size_t(c[2])] |
           hot_[std::size_t(c[3])];
  };
  const float touching = reach_ - beyond_;
  of_hot_.reserve(listed_.count);
  of_hot_.count = 0;
  for (std::size_t i = 0; i < listed_.count; ++i) {
    if (!(listed_.near_squared[i] < touching * touching) && !hot(listed_.owner[i]) &&
        !hot(listed_.neighbour[i]))
      continue;
    of_hot_.owner[of_hot_.count] = listed_.owner[i];
    of_hot_.neighbour[of_hot_.count++] = listed_.neighbour[i];
  }
  of_hot_.pad();
  return of_hot_;
}

void SurfaceContact::measure_piece(std::size_t piece) {
  const std::size_t first = piece * kAtOnce, count = std::min(pairs_->count - first, kAtOnce);
  Piece& p = pieces_[piece];
  p.touching.resize(kAtOnce);
  p.near_squared.resize(kAtOnce + kPadding);
  p.touches = std::size_t(
      kernels_.surface_pairs({vertices_.data(), squares_.data(), int(count),
                              pairs_->owner.data() + first, pairs_->neighbour.data() + first,
                              close_, beyond_, p.near_squared.data(), p.touching.data()}));
  if (pairs_ == &listed_)
    std::copy_n(p.near_squared.data(), count, listed_.near_squared.data() + first);
}

// What all pairs say of the squares from `begin` to `end`, in the order of the pairs.
void SurfaceContact::sum_up(std::size_t begin, std::size_t end) {
  const float unlisted = this->unlisted();
  std::fill(sums_.begin() + std::ptrdiff_t(begin), sums_.begin() + std::ptrdiff_t(end),
            SquareChange{});
  std::fill(near_squared_.begin() + std::ptrdiff_t(begin),
            near_squared_.begin() + std::ptrdiff_t(end), unlisted * unlisted);
  const auto ours = [&](std::int32_t square) { return std::size_t(square) - begin < end - begin; };
  for (std::size_t first = 0; first < pairs_->count; first += kAtOnce) {
    const Piece& piece = pieces_[first / kAtOnce];
    const std::int32_t *const owner = pairs_->owner.data() + first, *const neighbour =
                                                                        pairs_->neighbour.data() +
                                                                        first;
    for (std::size_t i = 0; i < std::min(pairs_->count - first, kAtOnce); ++i)
      for (const std::int32_t square : {owner[i], neighbour[i]})
        if (ours(square)) {
          float& near = near_squared_[std::size_t(square)];
          near = std::min(near, piece.near_squared[i]);
        }
    for (std::size_t t = 0; t < piece.touches; ++t) {
      const SquaresTouching& touching = piece.touching[t];
      const std::int32_t square[2] = {owner[touching.pair], neighbour[touching.pair]};
      for (int n = 0; n < 2; ++n)
        if (ours(square[n])) add(touching.change[n], sums_[std::size_t(square[n])]);
    }
  }
}

// A vertex belongs to up to four squares: its bound is of the nearest of all, its push of all. What has
// not been measured this time keeps to what is left of its old bound.
void SurfaceContact::set_places_and_push(std::size_t sheet, int row, bool all) {
  Lattice& l = *sheets_[sheet].lattice;
  for (int i = 0; i < l.columns; ++i) {
    const std::size_t n = number(sheet, row, i);
    Place& place = places_[n];
    float push[3] = {}, gain[3] = {}, weight = 0;
    float near_squared = std::numeric_limits<float>::max();
    for (int c = 0; c < 4; ++c) {
      const int column = i - (c & 1), above = row - (c >> 1);
      if (column < 0 || above < 0) continue;
      const std::size_t square = number(sheet, above, column);
      near_squared = std::min(near_squared, near_squared_[square]);
      const SquareChange& sum = sums_[square];
      if (!(sum.weight[c] > 0)) continue;
      weight += sum.weight[c];
      for (int k = 0; k < 3; ++k) {
        push[k] += sum.push[c][k];
        gain[k] += sum.gain[c][k];
      }
    }
    const float nearest = std::sqrt(near_squared);
    float bound = kBound * (nearest - floor_), most = kMostPush * nearest;
    if (!all && !hot_[n]) {
      float gone[3];
      for (int k = 0; k < 3; ++k) gone[k] = vertices_[n].x[k] - frame_[k] - place.x[k];
      bound = std::max(0.0f, std::min(bound, place.bound - std::sqrt(square(gone))));
      most = std::min(most, bound);
    }
    float pushed = 0;
    if (weight > 0 && l.w(row, i) > 0) {
      const float far = std::sqrt(square(push)) / weight;
      const float share = (far > most ? most / far : 1) / weight;
      pushed = std::min(far, most);
      for (int k = 0; k < 3; ++k) {
        l.x.at(k, row, i) += push[k] * share;
        l.v.at(k, row, i) += gain[k] / weight;
      }
    }
    place.bound = std::max(0.0f, bound - pushed);
    for (int k = 0; k < 3; ++k) place.x[k] = l.x.at(k, row, i) - frame_[k];
  }
}

// Puts back what has left its bound, and tells how near to them the rest is, or will be in a substep.
// What is common to all is the mean, which few that move to and fro do not change; what is pinned or
// asleep stays where it is: then nothing is common.
void SurfaceContact::hold(double seconds, double dt) {
  const auto each_row = [&](auto&& work) {
    for (std::size_t s = 0; s < sheets_.size(); ++s) {
      Lattice& l = *sheets_[s].lattice;
      for (int j = 0; j < l.rows; ++j)
        work(l.x.row(j), l.v.row(j), l.w(j), &places_[number(s, j, 0)], l.columns);
    }
  };
  double moved[3] = {}, speed[3] = {};
  bool all_free = true;
  each_row([&](Row3 x, Row3 v, const float* w, const Place* place, int columns) {
    float row_moved[3] = {}, row_speed[3] = {};
    for (int i = 0; i < columns; ++i) {
      all_free &= w[i] > 0;
      const float* const p = place[i].x;
      row_moved[0] += x.x[i] - frame_[0] - p[0];
      row_moved[1] += x.y[i] - frame_[1] - p[1];
      row_moved[2] += x.z[i] - frame_[2] - p[2];
      row_speed[0] += v.x[i];
      row_speed[1] += v.y[i];
      row_speed[2] += v.z[i];
    }
    for (int k = 0; k < 3; ++k) {
      moved[k] += double(row_moved[k]);
      speed[k] += double(row_speed[k]);
    }
  });
  Motion m{};
  float drift[3] = {};
  for (int k = 0; k < 3 && all_free; ++k) {
    frame_[k] += float(moved[k] / double(places_.size()));
    drift[k] = float(speed[k] / double(places_.size()));
  }
  float share_squared = 0, rate_squared = 0, gone_squared = 0;
  each_row([&](Row3 x, Row3 v, const float* w, Place* place, int columns) {
    for (int i = 0; i < columns; ++i) {
      Place& p = place[i];
      float* const at[3] = {x.x + i, x.y + i, x.z + i};
      float* const speed_at[3] = {v.x + i, v.y + i, v.z + i};
      float d[3], u[3], next[3], from[3];
      for (int k = 0; k < 3; ++k) {
        d[k] = *at[k] - frame_[k] - p.x[k];
        u[k] = *speed_at[k] - drift[k];
      }
      const float bound = std::max(p.bound, kLeastBound);
      const float far_off = square(d), inverse = 1 / (bound * bound);
      rate_squared = std::max(rate_squared, square(u) * inverse);
      share_squared = std::max(share_squared, far_off * inverse);
      for (int k = 0; k < 3; ++k) next[k] = d[k] + u[k] * float(dt);
      const bool hot = far_off * inverse > kMeasureAt * kMeasureAt || square(next) * inverse > 1;
      hot_[std::size_t(&p - places_.data())] = hot;
      m.hot += hot;
      if (far_off > bound * bound && w[i] > 0) {
        ++held_back_;
        const float far = std::sqrt(far_off), back = bound / far;
        const float out = (u[0] * d[0] + u[1] * d[1] + u[2] * d[2]) / far;
        const float lost =
            std::clamp(float((far - bound) / std::max(seconds, 1e-9)), 0.0f, std::max(out, 0.0f));
        for (int k = 0; k < 3; ++k) {
          *at[k] = p.x[k] + frame_[k] + d[k] * back;
          *speed_at[k] -= d[k] / far * lost;
        }
      }
      for (int k = 0; k < 3; ++k) from[k] = *at[k] - frame_[k] - p.listed[k];
      p.gone_squared = square(from);
      gone_squared = std::max(gone_squared, p.gone_squared);
    }
  });
  m.share = std::min(1.0f, std::sqrt(share_squared));
  m.rate = std::sqrt(rate_squared);
  m.gone = std::sqrt(gone_squared);
  motion_ = m;
}

void SurfaceContact::begin(Threads& threads) {
  valid_ = false;
  measure(true, threads);
  hold(0, 0);
}

int SurfaceContact::run(double dt, int since, Threads& threads) {
  since_ += since;
  hold(since * dt, dt);
  const bool all =
      since_ >= kMostSubsteps || double(motion_.hot) > kMostHot * double(places_.size());
  if (!all && motion_.hot > 0) {
    measure(false, threads);
    return 1;
  }
  if (all) {
    measure(true, threads);
    hold(dt, dt);
  }
  const double steps = kComeAt * (1 - motion_.share) / std::max(double(motion_.rate) * dt, 1e-12);
  return int(std::clamp(steps, 1.0, double(std::max(1, kMostSubsteps - since_))));
}

std::size_t SurfaceContact::bytes() const {
  std::size_t bytes = search_.bytes();
  bytes += squares_.size() * (sizeof(Square) + sizeof(Vertex) + sizeof(Place) + sizeof(SquareBox) +
                              sizeof(SquareChange) + 11);
  const auto add = [&](const Pairs& p) { bytes += 12 * p.owner.capacity(); };
  add(listed_);
  add(of_hot_);
  for (const Pairs& p : found_) add(p);
  for (const Piece& p : pieces_) bytes += sizeof(SquaresTouching) * p.touching.capacity();
  return bytes;
}

}  // namespace weft::physics
