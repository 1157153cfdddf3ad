// Self-collision among surfaces (surface.h).
#include "physics/self_collision/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::physics {
namespace {

constexpr float kBound = 0.2f;       // of the least distance beyond the floor
constexpr float kMostPush = 0.25f;   // of the least distance, at once
constexpr float kFloor = 0.05f;      // of the thickness: what is nearer is only pushed apart
constexpr float kMeasureAt = 0.7f;   // of a bound, moved: all is measured anew
constexpr float kComeAt = 0.8f;      // of the rest of a bound, at its speed: time to come again
constexpr int kMostSubsteps = 8;     // between two times
constexpr float kBeyond = 0.25f;     // spacings beyond the thickness that distances are measured to
constexpr float kClose = 0.25f;      // spacings that neighbours are kept apart
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
      search_(count_particles(sheets_), metrics_of(sheets_), kernels) {
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
  squares_.resize(n + 1);
  listed_.resize(n);
  boxes_.resize(n + 1);
  sums_.resize(n);
  places_.resize(n);
  Square& far_away = squares_[n];
  far_away = {};
  for (auto& corner : far_away.x)
    for (float& x : corner) x = 1e8f;
  std::fill_n(far_away.corner, 4, -1);
  boxes_[n] = {{1e8f, 1e8f, 1e8f, 0}, {1e8f, 1e8f, 1e8f, 0}};
}

// The corners of one square, and the box about them.
void SurfaceContact::fill_square(std::size_t sheet, int row, int column) {
  const Sheet& s = sheets_[sheet];
  const Lattice& l = *s.lattice;
  Square& q = squares_[number(sheet, row, column)];
  for (int c = 0; c < 4; ++c) {
    const int i = std::min(column + (c & 1), l.columns - 1),
              j = std::min(row + (c >> 1), l.rows - 1);
    for (int k = 0; k < 3; ++k) {
      q.x[c][k] = l.x.at(k, j, i);
      q.v[c][k] = l.v.at(k, j, i);
    }
    q.w[c] = l.w(j, i);
    q.corner[c] = std::int32_t(number(sheet, j, i));
  }
  SquareBox& box = boxes_[number(sheet, row, column)];
  for (int k = 0; k < 3; ++k) {
    const float a = q.x[0][k], b = q.x[1][k], c = q.x[2][k], d = q.x[3][k];
    box.low[k] = std::min(std::min(a, b), std::min(c, d));
    box.high[k] = std::max(std::max(a, b), std::max(c, d));
  }
  constexpr float kBetweenSheets = 1e5f;  // columns
  q.place[0] = float(column) + kBetweenSheets * float(sheet);
  q.place[1] = float(row);
  q.place[2] = s.thickness;
  q.friction = s.friction;
}

// Fills all squares and lists those that are whole for the search; returns the greatest distance of a
// corner from the middle.
float SurfaceContact::list_squares(Threads& threads, Spread& box) {
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const Lattice& l = *sheets_[s].lattice;
    threads.share(std::size_t(l.rows), l.rows * l.columns < 4096, [&](std::size_t j) {
      for (int i = 0; i < l.columns; ++i) fill_square(s, int(j), i);
    });
  }
  constexpr float far = std::numeric_limits<float>::max();
  box = {{far, far, far}, {-far, -far, -far}};
  std::size_t count = 0;
  float widest = 0;
  for (std::size_t s = 0; s < sheets_.size(); ++s) {
    const Lattice& l = *sheets_[s].lattice;
    const float most = kOverstretched * half_diagonal(sheets_[s]);
    for (int j = 0; j < l.rows; ++j)
      for (int i = 0; i < l.columns; ++i) {
        const Square& q = squares_[number(s, j, i)];
        float middle[3], radius = 0;
        for (int k = 0; k < 3; ++k)
          middle[k] = 0.25f * (q.x[0][k] + q.x[1][k] + q.x[2][k] + q.x[3][k]);
        for (int c = 0; c < 4; ++c) {
          const float d[3] = {q.x[c][0] - middle[0], q.x[c][1] - middle[1], q.x[c][2] - middle[2]};
          radius = std::max(radius, length(d));
        }
        sums_[number(s, j, i)] = {};
        sums_[number(s, j, i)].nearest = reach_;
        if (!(radius <= most)) continue;
        widest = std::max(widest, radius);
        const Row3 to = search_.points();
        to.x[count] = middle[0];
        to.y[count] = middle[1];
        to.z[count] = middle[2];
        for (int k = 0; k < 3; ++k) {
          box.low[k] = std::min(box.low[k], middle[k]);
          box.high[k] = std::max(box.high[k], middle[k]);
        }
        search_.sites()[count] = {std::uint16_t(s), std::uint16_t(j), std::uint16_t(i)};
        listed_[count++] = std::int32_t(number(s, j, i));
      }
  }
  search_.sort(count, box, reach_ + 2 * widest, threads);
  return widest;
}

void SurfaceContact::compare(std::size_t chunk, std::vector<std::int32_t>& others) {
  const std::int32_t* near = search_.pairs(chunk).neighbour;
  for (std::size_t p = search_.begin(chunk); p < search_.begin(chunk + 1); ++p) {
    const auto count = std::size_t(search_.counts()[p]);
    if (others.size() < count + 16) others.resize(2 * count + 16);
    for (std::size_t i = 0; i < count; ++i)
      others[i] = listed_[std::size_t(search_.number(std::size_t(near[i])))];
    near += count;
    const std::int32_t owner = listed_[std::size_t(search_.number(p))];
    kernels_.surface_square({squares_.data(), boxes_.data(), owner, others.data(), int(count),
                             std::int32_t(squares_.size() - 1), reach_, close_,
                             &sums_[std::size_t(owner)]});
  }
}

void SurfaceContact::measure(Threads& threads) {
  Spread box;
  const float widest = list_squares(threads, box);
  search_.find(reach_ + 2 * widest, threads);
  const bool alone = threads.count() == 1;
  others_.resize(std::size_t(threads.count()));
  threads.share(search_.chunks(), alone, [&](std::size_t k) {
    compare(k, others_[alone ? 0 : std::size_t(Threads::index())]);
  });
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
    float push[3] = {}, gain[3] = {}, weight = 0, nearest = reach_;
    for (int c = 0; c < 4; ++c) {
      const int column = i - (c & 1), above = row - (c >> 1);
      if (column < 0 || above < 0) continue;
      const SquareSum& sum = sums_[number(sheet, above, column)];
      nearest = std::min(nearest, sum.nearest);
      weight += sum.weight[c];
      for (int k = 0; k < 3; ++k) {
        push[k] += sum.push[c][k];
        gain[k] += sum.gain[c][k];
      }
    }
    place.bound = kBound * std::max(0.0f, nearest - floor_);
    if (weight > 0 && l.w(row, i) > 0) {
      const float far = length(push) / weight, most = kMostPush * nearest;
      const float share = (far > most ? most / far : 1) / weight;
      for (int k = 0; k < 3; ++k) {
        l.x.at(k, row, i) += push[k] * share;
        l.v.at(k, row, i) += gain[k] / weight;
      }
    }
    for (int k = 0; k < 3; ++k) place.x[k] = l.x.at(k, row, i);
  }
}

// Puts back what has left its bound, and tells how near to them the rest is. What is pinned or asleep
// stays where it is: then nothing is common to all.
SurfaceContact::Motion SurfaceContact::hold(double seconds) {
  constexpr float far = std::numeric_limits<float>::max();
  Spread moved{{far, far, far}, {-far, -far, -far}}, speed = moved;
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
  return squares_.size() *
             (sizeof(Square) + sizeof(SquareSum) + sizeof(Place) + sizeof(SquareBox) + 4) +
         search_.bytes();
}

}  // namespace weft::physics
