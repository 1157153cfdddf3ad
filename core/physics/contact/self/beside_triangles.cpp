// Triangles beside each other (beside_triangles.h).
#include "physics/contact/self/beside_triangles.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace weft::physics {
namespace {

// Of all normals about a vertex: the greatest diagonal of the box about them, φ = 29°; with s cos φ is 0.65.
constexpr float kSpread = 0.9f;
constexpr float kLeastStretch = 0.75f;  // s
constexpr std::size_t kFew = 4096;      // triangles that one thread does faster

void subtract(const float* a, const float* b, float (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = a[k] - b[k];
}
float dot(const float (&a)[3], const float (&b)[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

BesideTriangles::BesideTriangles(std::span<const Square> triangles, std::int32_t first,
                                 const std::vector<RestPlace>& rest)
    : triangles_(triangles), first_(first), lies_(triangles.size()), bent_(rest.size()) {
  for (const Square& t : triangles) {
    float b[3], c[3];
    const RestPlace& a = rest[std::size_t(t.corner[0])];
    subtract(&rest[std::size_t(t.corner[1])].x, &a.x, b);
    subtract(&rest[std::size_t(t.corner[2])].x, &a.x, c);
    const float bb = dot(b, b), bc = dot(b, c), cc = dot(c, c);
    const float square = std::max(bb * cc - bc * bc, 1e-30f);
    rest_.push_back({cc / square, -2 * bc / square, bb / square, std::sqrt(square)});
  }
  list_fans(rest.size());
  list_beside();
  pairs_.resize((triangles.size() + kAtOnce - 1) / kAtOnce);
}

void BesideTriangles::list_fans(std::size_t bodies) {
  std::vector<std::vector<std::int32_t>> about(bodies);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int c = 0; c < 3; ++c)
      about[std::size_t(triangles_[t].corner[c])].push_back(std::int32_t(t));
  for (std::size_t body = 0; body < bodies; ++body) {
    if (about[body].empty()) continue;
    std::set<std::int32_t> spokes;
    for (const std::int32_t t : about[body])
      for (const std::int32_t c : triangles_[std::size_t(t)].corner) spokes.insert(c);
    const bool joined = spokes.size() - 1 <= about[body].size() + 1;
    fans_.push_back(
        {std::int32_t(body), std::int32_t(fan_.size()), std::int32_t(about[body].size()), joined});
    fan_.insert(fan_.end(), about[body].begin(), about[body].end());
  }
}

void BesideTriangles::list_beside() {
  std::vector<std::vector<std::int32_t>> beside(triangles_.size());
  for (const Fan& fan : fans_)
    for (std::int32_t i = fan.first; i < fan.first + fan.count; ++i)
      for (std::int32_t j = i + 1; j < fan.first + fan.count; ++j)
        beside[std::size_t(fan_[std::size_t(i)])].push_back(fan_[std::size_t(j)]);
  for (std::vector<std::int32_t>& of : beside) {
    begin_.push_back(std::int32_t(beside_.size()));
    std::sort(of.begin(), of.end());
    of.erase(std::unique(of.begin(), of.end()), of.end());
    beside_.insert(beside_.end(), of.begin(), of.end());
  }
  begin_.push_back(std::int32_t(beside_.size()));
}

// With F the triangle's gradient, σ its least stretch, T = |F|² and D = det F: σ >= s where
// T <= s² + D²/s² and D >= s².
auto BesideTriangles::lie_of(std::size_t triangle, const Place* place) const -> Lie {
  const Square& t = triangles_[triangle];
  const Rest& rest = rest_[triangle];
  float b[3], c[3];
  const float* const a = place[t.corner[0]].x;
  subtract(place[t.corner[1]].x, a, b);
  subtract(place[t.corner[2]].x, a, c);
  const float n[3] = {b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2],
                      b[0] * c[1] - b[1] * c[0]};
  const float area = std::sqrt(dot(n, n)), d = area / rest.area;
  const float trace = rest.bb * dot(b, b) + rest.bc * dot(b, c) + rest.cc * dot(c, c);
  constexpr float s2 = kLeastStretch * kLeastStretch;
  if (!(d >= s2 && trace <= s2 + d * d / s2)) return {{0, 0, 0}, 0};
  return {{n[0] / area, n[1] / area, n[2] / area}, 1};
}

bool BesideTriangles::is_flat(const Fan& fan) const {
  if (!fan.joined) return false;
  float low[3] = {1, 1, 1}, high[3] = {-1, -1, -1}, whole = 1;
  for (std::int32_t i = fan.first; i < fan.first + fan.count; ++i) {
    const Lie& lie = lies_[std::size_t(fan_[std::size_t(i)])];
    whole *= lie.whole;
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], lie.normal[k]);
      high[k] = std::max(high[k], lie.normal[k]);
    }
  }
  float spread[3];
  subtract(high, low, spread);
  return whole > 0 && dot(spread, spread) <= kSpread * kSpread;
}

void BesideTriangles::list(const Place* place, const std::vector<std::uint8_t>& passing,
                           Threads& threads) {
  const bool few = triangles_.size() < kFew;
  const auto for_each_part = [&](std::size_t count, const auto& work) {
    threads.share((count + kAtOnce - 1) / kAtOnce, few,
                  [&](std::size_t k) { work(k, k * kAtOnce, std::min(count, (k + 1) * kAtOnce)); });
  };
  for_each_part(triangles_.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) lies_[t] = lie_of(t, place);
  });
  for_each_part(fans_.size(), [&](std::size_t, std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n)
      bent_[std::size_t(fans_[n].body)] = !is_flat(fans_[n]);
  });
  for_each_part(triangles_.size(), [&](std::size_t k, std::size_t begin, std::size_t end) {
    list_some(begin, end, passing, pairs_[k]);
  });
}

void BesideTriangles::list_some(std::size_t begin, std::size_t end,
                                const std::vector<std::uint8_t>& passing,
                                SquarePairs& found) const {
  found.count = 0;
  found.reserve(std::size_t(begin_[end] - begin_[begin]));
  for (std::size_t t = begin; t < end; ++t) {
    const Square& own = triangles_[t];
    if (!has_corner_in(own, bent_) || has_corner_in(own, passing)) continue;
    for (std::int32_t i = begin_[t]; i < begin_[t + 1]; ++i) {
      const Square& other = triangles_[std::size_t(beside_[std::size_t(i)])];
      const auto shared_and_bent = [&](std::int32_t corner) {
        return bent_[std::size_t(corner)] &&
               std::find(other.corner, other.corner + 3, corner) != other.corner + 3;
      };
      if (!std::any_of(own.corner, own.corner + 3, shared_and_bent)) continue;
      if (has_corner_in(other, passing)) continue;
      found.owner[found.count] = first_ + std::int32_t(t);
      found.neighbour[found.count++] = first_ + beside_[std::size_t(i)];
    }
  }
}

std::size_t BesideTriangles::bytes() const {
  std::size_t bytes = triangles_.size() * (sizeof(Rest) + sizeof(Lie) + 4) + bent_.size() +
                      fans_.size() * sizeof(Fan) + 4 * (fan_.size() + beside_.size());
  for (const SquarePairs& p : pairs_) bytes += p.bytes();
  return bytes;
}

}  // namespace weft::physics
