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
constexpr float kMeasureAt = 0.7f;  // of a bound, moved: all is measured anew
constexpr float kComeAt = 0.8f;     // of the rest of a bound, at its speed: time to come again
constexpr int kMostSubsteps = 8;    // between two times
constexpr float kBeyond = 0.25f;    // spacings beyond the thickness that distances are measured to
constexpr float kClose = 0.25f;     // spacings that neighbours are kept apart
constexpr std::size_t kAtOnce = 256;  // pairs that are measured in one call
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
    metrics.push_back(
        {s.lattice->columns, s.lattice->rows, s.uu, s.uv, s.vv, 0.01f * std::min(s.uu, s.vv)});
  return metrics;
}

float length(const float* a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
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

SurfaceContact::SurfaceContact(std::vector<Sheet> sheets, const KernelTable& kernels)
    : sheets_(std::move(sheets)),
      kernels_(kernels),
      search_(count_particles(sheets_), metrics_of(sheets_), true, kernels) {
  std::size_t n = 0;
  float spacing = 0, thickness = 0;
  close_ = floor_ = std::numeric_limits<float>::max();
  for (const Sheet& s : sheets_) {
    first_.push_back(n);
    n += std::size_t(s.lattice->columns) * std::size_t(s.lattice->rows);
    spacing = std::max({spacing, std::sqrt(s.uu), std::sqrt(s.vv)});
    thickness = std::max(thickness, s.thickness);
    close_ = std::min({close_, kClose * std::sqrt(s.uu), kClose * std::sqrt(s.vv)});
    floor_ = std::min({floor_, kFloor * s.thickness, kFloor * close_});
  }
  reach_ = thickness + kBeyond * spacing;
  sorted_.resize(n);
  squares_.resize(n);
  boxes_.resize(n);
  sums_.resize(n);
  near_squared_.resize(n);
  places_.resize(n);
}

// The middles of all squares that are whole, for the search; returns the greatest distance of a corner
// from the middle.
float SurfaceContact::list_squares(Spread& box, std::size_t& count) {
  box = nothing();
  count = 0;
  float widest = 0;
  const Row3 to = search_.points();
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    Lattice& l = *sheets_[s].lattice;
    const float most = kOverstretched * half_diagonal(sheets_[s]);
    for (int j = 0; j < l.rows; ++j) {
      const Row3 row = l.x.row(j), below = l.x.row(std::min(j + 1, l.rows - 1));
      for (int i = 0; i < l.columns; ++i) {
        const int beyond = std::min(i + 1, l.columns - 1);
        const auto corners = [&](const float* r, const float* b) {
          return std::array{r[i], r[beyond], b[i], b[beyond]};
        };
        const std::array<float, 4> x[3] = {corners(row.x, below.x), corners(row.y, below.y),
                                           corners(row.z, below.z)};
        float middle[3], square[4] = {};
        for (int k = 0; k < 3; ++k) {
          middle[k] = 0.25f * (x[k][0] + x[k][1] + x[k][2] + x[k][3]);
          for (std::size_t c = 0; c < 4; ++c)
            square[c] += (x[k][c] - middle[k]) * (x[k][c] - middle[k]);
        }
        const float radius = std::sqrt(*std::max_element(square, square + 4));
        if (!(radius <= most)) {
          sorted_[number(s, j, i)] = -1;
          continue;
        }
        widest = std::max(widest, radius);
        to.x[count] = middle[0];
        to.y[count] = middle[1];
        to.z[count] = middle[2];
        for (int k = 0; k < 3; ++k) {
          box.low[k] = std::min(box.low[k], middle[k]);
          box.high[k] = std::max(box.high[k], middle[k]);
        }
        search_.sites()[count++] = {std::uint16_t(s), std::uint16_t(j), std::uint16_t(i)};
      }
    }
  }
  return widest;
}

// The corners of one square, and the box about them.
void SurfaceContact::fill_square(std::size_t sorted) {
  const Site site = search_.site(sorted);
  const Sheet& s = sheets_[site.cloth];
  Lattice& l = *s.lattice;
  sorted_[number(site.cloth, site.row, site.column)] = std::int32_t(sorted);
  Square& q = squares_[sorted];
  SquareBox& box = boxes_[sorted];
  for (int c = 0; c < 4; ++c) {
    const int i = std::min(site.column + (c & 1), l.columns - 1),
              j = std::min(site.row + (c >> 1), l.rows - 1);
    for (int k = 0; k < 3; ++k) {
      q.x[c][k] = l.x.at(k, j, i);
      q.v[c][k] = l.v.at(k, j, i);
      box.low[k] = c == 0 ? q.x[c][k] : std::min(box.low[k], q.x[c][k]);
      box.high[k] = c == 0 ? q.x[c][k] : std::max(box.high[k], q.x[c][k]);
    }
    q.w[c] = l.w(j, i);
    q.corner[c] = std::int32_t(number(site.cloth, j, i));
  }
  constexpr float kBetweenSheets = 1e5f;  // columns
  q.place[0] = float(site.column) + kBetweenSheets * float(site.cloth);
  q.place[1] = float(site.row);
  q.place[2] = s.thickness;
  q.friction = s.friction;
}

// The pairs of a chunk whose boxes are in range, measured.
void SurfaceContact::measure_chunk(std::size_t chunk) {
  const PairSearch::Pairs pairs = search_.pairs(chunk);
  Measured& m = chunks_[chunk];
  if (m.owner.size() < pairs.count + kPadding) {
    m.owner.resize(2 * pairs.count + kPadding);
    m.neighbour.resize(m.owner.size());
    m.near_squared.resize(m.owner.size());
  }
  m.count = std::size_t(
      kernels_.squares_within({boxes_.data(), int(pairs.count), pairs.owner, pairs.neighbour,
                               reach_, m.owner.data(), m.neighbour.data()}));
  m.touches = 0;
  for (std::size_t first = 0; first < m.count; first += kAtOnce) {
    if (m.touching.size() < m.touches + kAtOnce) m.touching.resize(2 * m.touches + kAtOnce);
    SquaresTouching* const touching = m.touching.data() + m.touches;
    const int touches = kernels_.surface_pairs(
        {squares_.data(), int(std::min(m.count - first, kAtOnce)), m.owner.data() + first,
         m.neighbour.data() + first, reach_, close_, m.near_squared.data() + first, touching});
    for (int k = 0; k < touches; ++k) touching[k].pair += std::int32_t(first);
    m.touches += std::size_t(touches);
  }
}

// What all pairs say of the squares from `begin` to `end`, in the order of the pairs.
void SurfaceContact::sum_up(std::size_t begin, std::size_t end) {
  std::fill(sums_.begin() + std::ptrdiff_t(begin), sums_.begin() + std::ptrdiff_t(end),
            SquareChange{});
  std::fill(near_squared_.begin() + std::ptrdiff_t(begin),
            near_squared_.begin() + std::ptrdiff_t(end), reach_ * reach_);
  const auto ours = [&](std::int32_t square) { return std::size_t(square) - begin < end - begin; };
  for (std::size_t k = 0; k < search_.chunks() && search_.begin(k) < end; ++k) {
    const Measured& m = chunks_[k];
    for (std::size_t i = 0; i < m.count; ++i)
      for (const std::int32_t square : {m.owner[i], m.neighbour[i]})
        if (ours(square)) {
          float& near = near_squared_[std::size_t(square)];
          near = std::min(near, m.near_squared[i]);
        }
    for (std::size_t t = 0; t < m.touches; ++t) {
      const SquaresTouching& pair = m.touching[t];
      const auto i = std::size_t(pair.pair);
      const std::int32_t square[2] = {m.owner[i], m.neighbour[i]};
      for (int n = 0; n < 2; ++n)
        if (ours(square[n])) add(pair.change[n], sums_[std::size_t(square[n])]);
    }
  }
}

void SurfaceContact::measure(Threads& threads) {
  Spread box;
  std::size_t count = 0;
  const float widest = list_squares(box, count), range = reach_ + 2 * widest;
  search_.sort(count, box, range, threads);
  const std::size_t chunks = search_.chunks();
  threads.share(chunks, search_.few(), [&](std::size_t k) {
    for (std::size_t p = search_.begin(k); p < search_.begin(k + 1); ++p) fill_square(p);
  });
  search_.find(range, threads);
  if (chunks_.size() < chunks) chunks_.resize(chunks);
  threads.share(chunks, false, [&](std::size_t k) { measure_chunk(k); });
  // Each goes through all pairs.
  const auto parts = std::size_t(threads.count());
  threads.share(parts, false,
                [&](std::size_t k) { sum_up(k * count / parts, (k + 1) * count / parts); });
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const Lattice& l = *sheets_[s].lattice;
    threads.share(std::size_t(l.rows), l.rows * l.columns < 4096,
                  [&](std::size_t j) { set_places_and_push(s, int(j)); });
  }
  valid_ = true;
  since_ = 0;
  ++measured_;
}

// A vertex belongs to up to four squares: its bound is of the nearest of all, its push of all.
void SurfaceContact::set_places_and_push(std::size_t sheet, int row) {
  Lattice& l = *sheets_[sheet].lattice;
  for (int i = 0; i < l.columns; ++i) {
    Place& place = places_[number(sheet, row, i)];
    float push[3] = {}, gain[3] = {}, weight = 0, near_squared = reach_ * reach_;
    for (int c = 0; c < 4; ++c) {
      const int column = i - (c & 1), above = row - (c >> 1);
      if (column < 0 || above < 0) continue;
      const std::int32_t square = sorted_[number(sheet, above, column)];
      if (square < 0) continue;
      const SquareChange& sum = sums_[std::size_t(square)];
      near_squared = std::min(near_squared, near_squared_[std::size_t(square)]);
      weight += sum.weight[c];
      for (int k = 0; k < 3; ++k) {
        push[k] += sum.push[c][k];
        gain[k] += sum.gain[c][k];
      }
    }
    const float nearest = std::sqrt(near_squared);
    float pushed = 0;
    if (weight > 0 && l.w(row, i) > 0) {
      const float far = length(push) / weight, most = kMostPush * nearest;
      const float share = (far > most ? most / far : 1) / weight;
      pushed = std::min(far, most);
      for (int k = 0; k < 3; ++k) {
        l.x.at(k, row, i) += push[k] * share;
        l.v.at(k, row, i) += gain[k] / weight;
      }
    }
    place.bound = std::max(0.0f, kBound * (nearest - floor_) - pushed);
    for (int k = 0; k < 3; ++k) place.x[k] = l.x.at(k, row, i);
  }
}

// Puts back what has left its bound, and tells how near to them the rest is. What is pinned or asleep
// stays where it is: then nothing is common to all.
SurfaceContact::Motion SurfaceContact::hold(double seconds) {
  Spread moved = nothing(), speed = moved;
  const auto each = [&](auto&& work) {
    for (std::size_t s = 0; s < sheets_.size(); ++s) {
      Lattice& l = *sheets_[s].lattice;
      for (int j = 0; j < l.rows; ++j)
        for (int i = 0; i < l.columns; ++i) work(l, j, i, places_[number(s, j, i)]);
    }
  };
  bool all_free = true;
  each([&](Lattice& l, int j, int i, const Place&) { all_free &= l.w(j, i) > 0; });
  if (all_free)
    each([&](Lattice& l, int j, int i, const Place& place) {
      for (int k = 0; k < 3; ++k) {
        const float d = l.x.at(k, j, i) - place.x[k], v = l.v.at(k, j, i);
        moved.low[k] = std::min(moved.low[k], d);
        moved.high[k] = std::max(moved.high[k], d);
        speed.low[k] = std::min(speed.low[k], v);
        speed.high[k] = std::max(speed.high[k], v);
      }
    });
  Motion m{};
  float drift[3] = {};
  for (int k = 0; k < 3 && all_free; ++k) {
    m.common[k] = 0.5f * (moved.low[k] + moved.high[k]);
    drift[k] = 0.5f * (speed.low[k] + speed.high[k]);
  }
  each([&](Lattice& l, int j, int i, const Place& place) {
    float d[3], u[3];
    for (int k = 0; k < 3; ++k) {
      d[k] = l.x.at(k, j, i) - place.x[k] - m.common[k];
      u[k] = l.v.at(k, j, i) - drift[k];
    }
    const float far_off = length(d), bound = std::max(place.bound, 1e-12f);
    m.rate = std::max(m.rate, length(u) / bound);
    m.share = std::max(m.share, std::min(1.0f, far_off / bound));
    if (far_off <= bound || l.w(j, i) <= 0) return;
    ++held_back_;
    const float back = bound / far_off;
    const float out = (u[0] * d[0] + u[1] * d[1] + u[2] * d[2]) / far_off;
    const float lost =
        std::clamp(float((far_off - bound) / std::max(seconds, 1e-9)), 0.0f, std::max(out, 0.0f));
    for (int k = 0; k < 3; ++k) {
      l.x.at(k, j, i) = place.x[k] + m.common[k] + d[k] * back;
      l.v.at(k, j, i) -= d[k] / far_off * lost;
    }
  });
  return m;
}

void SurfaceContact::begin(Threads& threads) {
  measure(threads);
  hold(0);
}

int SurfaceContact::run(double dt, int since, Threads& threads) {
  since_ += since;
  Motion m = hold(since * dt);
  if (m.share > kMeasureAt || since_ >= kMostSubsteps) {
    measure(threads);
    m = hold(dt);
  }
  const double steps = kComeAt * (1 - m.share) / std::max(double(m.rate) * dt, 1e-12);
  return int(std::clamp(steps, 1.0, double(std::max(1, kMostSubsteps - since_))));
}

std::size_t SurfaceContact::bytes() const {
  std::size_t bytes = search_.bytes();
  bytes += squares_.size() *
           (sizeof(Square) + sizeof(SquareBox) + sizeof(SquareChange) + sizeof(Place) + 8);
  for (const Measured& m : chunks_)
    bytes += 12 * m.owner.capacity() + sizeof(SquaresTouching) * m.touching.capacity();
  return bytes;
}

}  // namespace weft::physics
