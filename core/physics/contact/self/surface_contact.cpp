// Self-collision among surfaces (surface.h).
#include "physics/contact/self/surface_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/model/clamp_to_int.h"

namespace weft::physics {
namespace {

constexpr float kBound = 0.45f;        // of the least distance beyond the floor, the push included
constexpr float kMostPush = 0.25f;     // of the least distance, at once
constexpr float kFloor = 0.05f;        // of the thickness: what is nearer is only pushed apart
constexpr float kMeasureAt = 0.8f;     // of a bound, moved: a vertex is hot, and measured anew
constexpr double kMostHot = 0.3;       // of the vertices: more, and all is
constexpr float kComeAt = 0.8f;        // of the rest of a bound, at its speed: time to come again
constexpr int kMostSubsteps = 8;       // between two times
constexpr float kLeastBound = 1e-12f;  // m, to divide by
constexpr std::size_t kAtOnce = 256;   // pairs that are measured in one call
constexpr std::size_t kFewParticles = 4096;

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

}  // namespace

std::unique_ptr<SurfaceContact> SurfaceContact::make(const Scene& scene,
                                                     const std::vector<Sheet>& sheets,
                                                     const KernelTable& kernels) {
  const bool asked = std::any_of(scene.cloths.begin(), scene.cloths.end(), [](const Cloth& c) {
    return c.self_collision.mode == SelfCollisionMode::surface;
  });
  return asked ? std::unique_ptr<SurfaceContact>(new SurfaceContact(sheets, kernels)) : nullptr;
}

SurfaceContact::SurfaceContact(std::vector<Sheet> sheets, const KernelTable& kernels)
    : sheets_(std::move(sheets)), kernels_(kernels), near_(sheets_, kernels) {
  floor_ = kFloor * near_.close();
  for (const Sheet& s : sheets_) floor_ = std::min(floor_, kFloor * s.thickness);
  const std::size_t n = near_.count();
  places_.resize(n);
  hot_.resize(n);
  sums_.resize(n);
  near_squared_.resize(n);
}

// How far apart all is now, or those vertices alone that are near their bounds: pushes what touches,
// and bounds the way that everything may go from here.
void SurfaceContact::measure(bool all, Threads& threads) {
  near_.update(!valid_, frame_, threads);
  for (const std::int32_t joined : near_.joined())
    for (const std::int32_t c : near_.squares()[std::size_t(joined)].corner)
      hot_[std::size_t(c)] = true;
  pairs_ = all ? &near_.pairs() : &pairs_of_hot();
  const std::size_t pieces = (pairs_->count + kAtOnce - 1) / kAtOnce;
  if (pieces_.size() < pieces) pieces_.resize(pieces);
  threads.share(pieces, false, [&](std::size_t k) { measure_piece(k); });
  // Each goes through all pairs.
  const auto parts = std::size_t(threads.count());
  const std::size_t squares = near_.count();
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
const SquarePairs& SurfaceContact::pairs_of_hot() {
  const SquarePairs& all = near_.pairs();
  const auto hot = [&](std::int32_t square) {
    return has_corner_in(near_.squares()[std::size_t(square)], hot_);
  };
  const float touching = near_.most() * near_.most();
  of_hot_.reserve(all.count);
  of_hot_.count = 0;
  for (std::size_t i = 0; i < all.count; ++i) {
    if (!(all.near_squared[i] < touching) && !hot(all.owner[i]) && !hot(all.neighbour[i])) continue;
    of_hot_.owner[of_hot_.count] = all.owner[i];
    of_hot_.neighbour[of_hot_.count++] = all.neighbour[i];
  }
  of_hot_.pad();
  return of_hot_;
}

void SurfaceContact::measure_piece(std::size_t piece) {
  const std::size_t first = piece * kAtOnce, count = std::min(pairs_->count - first, kAtOnce);
  Piece& p = pieces_[piece];
  p.touching.resize(kAtOnce);
  p.near_squared.resize(kAtOnce + SquarePairs::kPadding);
  p.touches = std::size_t(kernels_.surface_pairs(
      {near_.vertices().data(), near_.squares().data(), int(count), pairs_->owner.data() + first,
       pairs_->neighbour.data() + first, near_.close(), near_.beyond(), p.near_squared.data(),
       p.touching.data()}));
  if (pairs_ == &near_.pairs())
    std::copy_n(p.near_squared.data(), count, near_.pairs().near_squared.data() + first);
}

// What all pairs say of the squares from `begin` to `end`, in the order of the pairs.
void SurfaceContact::sum_up(std::size_t begin, std::size_t end) {
  const float unlisted = near_.unlisted();
  std::fill(sums_.begin() + std::ptrdiff_t(begin), sums_.begin() + std::ptrdiff_t(end),
            SquareChange{});
  std::fill(near_squared_.begin() + std::ptrdiff_t(begin),
            near_squared_.begin() + std::ptrdiff_t(end), unlisted * unlisted);
  const auto ours = [&](std::int32_t square) { return std::size_t(square) - begin < end - begin; };
  for (std::size_t first = 0; first < pairs_->count; first += kAtOnce) {
    const Piece& piece = pieces_[first / kAtOnce];
    const std::int32_t* const owner = pairs_->owner.data() + first;
    const std::int32_t* const neighbour = pairs_->neighbour.data() + first;
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
    const std::size_t n = near_.number(sheet, row, i);
    Place& place = places_[n];
    float push[3] = {}, gain[3] = {}, weight = 0;
    float near_squared = std::numeric_limits<float>::max();
    for (int c = 0; c < 4; ++c) {
      const int column = i - (c & 1), above = row - (c >> 1);
      if (column < 0 || above < 0) continue;
      const std::size_t square = near_.number(sheet, above, column);
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
      for (int k = 0; k < 3; ++k) gone[k] = near_.vertices()[n].x[k] - frame_[k] - place.x[k];
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

// What is common to all since places were set: the mean, which few that move to and fro do not change.
// What is pinned or asleep stays where it is: then nothing is common.
SurfaceContact::Common SurfaceContact::common_motion() const {
  double moved[3] = {}, speed[3] = {};
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const Lattice& l = *sheets_[s].lattice;
    for (int j = 0; j < l.rows; ++j) {
      const Place* const place = &places_[near_.number(s, j, 0)];
      for (int i = 0; i < l.columns; ++i)
        if (!(l.w(j)[i] > 0)) return {};
      const ConstRow3 rx = l.x.row(j), rv = l.v.row(j);
      const float* const x[3] = {rx.x, rx.y, rx.z};
      const float* const v[3] = {rv.x, rv.y, rv.z};
      for (int k = 0; k < 3; ++k) {
        float row_moved = 0, row_speed = 0;
        for (int i = 0; i < l.columns; ++i) {
          row_moved += x[k][i] - frame_[k] - place[i].x[k];
          row_speed += v[k][i];
        }
        moved[k] += double(row_moved);
        speed[k] += double(row_speed);
      }
    }
  }
  Common common{};
  for (int k = 0; k < 3; ++k) {
    common.moved[k] = float(moved[k] / double(places_.size()));
    common.speed[k] = float(speed[k] / double(places_.size()));
  }
  return common;
}

// Puts back what has left its bound in `seconds`, and tells how near to them the rest is, or will be in
// a substep of dt.
void SurfaceContact::hold(double seconds, double dt) {
  const Common common = common_motion();
  for (int k = 0; k < 3; ++k) frame_[k] += common.moved[k];
  motion_ = {};
  for (std::size_t s = 0; s < sheets_.size(); ++s)
    for (int j = 0; j < sheets_[s].lattice->rows; ++j) hold_row(s, j, common.speed, seconds, dt);
}

void SurfaceContact::hold_row(std::size_t sheet, int row, const float (&drift)[3], double seconds,
                              double dt) {
  Lattice& l = *sheets_[sheet].lattice;
  const Row3 x = l.x.row(row), v = l.v.row(row);
  const std::size_t first = near_.number(sheet, row, 0);
  for (int i = 0; i < l.columns; ++i) {
    const Place& place = places_[first + std::size_t(i)];
    float* const at[3] = {x.x + i, x.y + i, x.z + i};
    float* const speed[3] = {v.x + i, v.y + i, v.z + i};
    float d[3], u[3], next[3];
    for (int k = 0; k < 3; ++k) {
      d[k] = *at[k] - frame_[k] - place.x[k];
      u[k] = *speed[k] - drift[k];
      next[k] = d[k] + u[k] * float(dt);
    }
    const float bound = std::max(place.bound, kLeastBound), inverse = 1 / (bound * bound);
    const float far_squared = square(d);
    const bool hot = far_squared * inverse > kMeasureAt * kMeasureAt || square(next) * inverse > 1;
    hot_[first + std::size_t(i)] = hot;
    motion_.hot += hot;
    motion_.rate_squared = std::max(motion_.rate_squared, square(u) * inverse);
    motion_.share_squared = std::max(motion_.share_squared, far_squared * inverse);
    if (!(far_squared > bound * bound)) continue;
    if (!(l.w(row)[i] > 0)) {
      forced_ = true;
      continue;
    }
    ++held_back_;
    const float far = std::sqrt(far_squared), back = bound / far;
    const float out = (u[0] * d[0] + u[1] * d[1] + u[2] * d[2]) / far;
    const float lost =
        std::clamp(float((far - bound) / std::max(seconds, 1e-9)), 0.0f, std::max(out, 0.0f));
    for (int k = 0; k < 3; ++k) {
      *at[k] = place.x[k] + frame_[k] + d[k] * back;
      *speed[k] -= d[k] / far * lost;
    }
  }
}

void SurfaceContact::begin(Threads& threads) {
  valid_ = false;
  std::fill(std::begin(frame_), std::end(frame_), 0.0f);
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
  const double left = 1 - std::min(1.0f, std::sqrt(motion_.share_squared));
  const double steps =
      kComeAt * left / std::max(std::sqrt(double(motion_.rate_squared)) * dt, 1e-12);
  return clamp_to_int(steps, 1, std::max(1, kMostSubsteps - since_));
}

std::size_t SurfaceContact::bytes() const {
  std::size_t bytes = near_.bytes() + of_hot_.bytes();
  bytes += places_.size() * (sizeof(Place) + sizeof(SquareChange) + sizeof(float) + 1);
  for (const Piece& p : pieces_)
    bytes +=
        sizeof(SquaresTouching) * p.touching.capacity() + sizeof(float) * p.near_squared.capacity();
  return bytes;
}

}  // namespace weft::physics
