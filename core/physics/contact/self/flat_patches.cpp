// Flat patches (flat_patches.h).
#include "physics/contact/self/flat_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "weft/vec3.h"

namespace weft::physics {
namespace {

constexpr double kFlat = 1e-3;  // mean edges that vertices may be off a plane, or beyond an edge

// Three floats and one of no account.
using Four [[gnu::vector_size(16)]] = float;

struct FourSpread {
  Four low, high;
  void add(Four x) {
    low = x < low ? x : low;
    high = x > high ? x : high;
  }
  Spread spread() const { return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}; }
};

float square(Four x) {
  const Four s = x * x;
  return s[0] + s[1] + s[2];
}

}  // namespace

FlatPatches::FlatPatches(MeshPatches& patches, double reach) : patches_(patches) {
  begin_.resize(std::size_t(patches.points().rows) + 1);
  std::vector<Flat> at;
  if (!lay_flat(at)) return;
  add_triangles(at);
  add_pairs(at, reach);
}

// Places in the plane of the largest triangle, by axes along those of the scene as far as they lie in it, since
// so do most folds of most cloths; false where the mesh does not lie in it, or folds over.
bool FlatPatches::lay_flat(std::vector<Flat>& at) const {
  const std::vector<Vec3>& rest = patches_.rest();
  Vec3 normal{};
  double largest = 0, edges = 0;
  const auto& triangles = patches_.triangles();
  for (const auto& t : triangles) {
    const Vec3 &a = rest[std::size_t(t[0])], &b = rest[std::size_t(t[1])];
    const Vec3 n = normal_of(a, b, rest[std::size_t(t[2])]), e = minus(b, a);
    edges += length(e);
    if (dot(n, n) <= largest) continue;
    largest = dot(n, n), normal = n;
  }
  const double tolerance = kFlat * edges / double(triangles.size());
  normal = times(normal, 1 / std::sqrt(largest));
  const auto steep = [](double a, double b) { return std::abs(a) < std::abs(b); };
  Vec3 side{};
  side[std::size_t(std::min_element(normal.begin(), normal.end(), steep) - normal.begin())] = 1;
  side = minus(side, times(normal, dot(normal, side)));
  side = times(side, 1 / length(side));
  const Vec3 across = cross(normal, side), origin = rest[std::size_t(triangles[0][0])];
  for (const Vec3& x : rest) {
    const Vec3 from = minus(x, origin);
    if (std::abs(dot(from, normal)) > tolerance) return false;
    at.push_back({dot(from, side), dot(from, across)});
  }
  return std::all_of(triangles.begin(), triangles.end(), [&](const auto& t) {
    return dot(normal, normal_of(rest[std::size_t(t[0])], rest[std::size_t(t[1])],
                                 rest[std::size_t(t[2])])) > 0;
  });
}

// Each belongs to the patch of its first corner.
void FlatPatches::add_triangles(const std::vector<Flat>& at) {
  const Particles& points = patches_.points();
  std::vector<std::vector<Triangle>> of(std::size_t(points.rows));
  for (const auto& t : patches_.triangles()) {
    Triangle one;
    for (std::size_t k = 0; k < 3; ++k) one.corner[k] = patches_.record(t[k]);
    const Flat &a = at[std::size_t(t[0])], &b = at[std::size_t(t[1])], &c = at[std::size_t(t[2])];
    const double bx = b[0] - a[0], by = b[1] - a[1], cx = c[0] - a[0], cy = c[1] - a[1];
    const double area = bx * cy - by * cx;
    one.u[0] = float(cy / area), one.u[1] = float(-by / area);
    one.v[0] = float(-cx / area), one.v[1] = float(bx / area);
    of[std::size_t(points.place(t[0]).j)].push_back(one);
  }
  for (std::size_t p = 0; p < of.size(); ++p) {
    triangles_.insert(triangles_.end(), of[p].begin(), of[p].end());
    begin_[p + 1] = triangles_.size();
  }
}

void FlatPatches::measure(int patch, BlockBounds& bounds) const {
  const std::size_t begin = begin_[std::size_t(patch)], end = begin_[std::size_t(patch) + 1];
  constexpr float kFar = std::numeric_limits<float>::max();
  const Four low{kFar, kFar, kFar, 0}, high = -low;
  FourSpread along{low, high}, across{low, high};
  float change_along = 0, change_across = 0;
  const auto four = [](const Place& p) { return Four{p.x[0], p.x[1], p.x[2], p.x[3]}; };
  for (std::size_t n = begin; n < end; ++n) {
    const Triangle& t = triangles_[n];
    const auto sides = [&](const std::vector<Place>& of) {
      const Four a = four(of[std::size_t(t.corner[0])]);
      return std::pair(four(of[std::size_t(t.corner[1])]) - a,
                       four(of[std::size_t(t.corner[2])]) - a);
    };
    const auto [b, c] = sides(patches_.x());
    along.add(b * t.u[0] + c * t.u[1]);
    across.add(b * t.v[0] + c * t.v[1]);
    const auto [vb, vc] = sides(patches_.v());
    change_along = std::max(change_along, square(vb * t.u[0] + vc * t.u[1]));
    change_across = std::max(change_across, square(vb * t.v[0] + vc * t.v[1]));
  }
  bounds.along = along.spread();
  bounds.across = across.spread();
  bounds.change_along = change_along;
  bounds.change_across = change_across;
}

void FlatPatches::add_pairs(const std::vector<Flat>& at, double reach) {
  const Particles& points = patches_.points();
  const Box none{{1e300, 1e300}, {-1e300, -1e300}};
  std::vector<Box> vertices(std::size_t(points.rows), none), reached = vertices;
  const auto widen = [&](Box& box, const Flat& x) {
    for (std::size_t k = 0; k < 2; ++k) {
      box.low[k] = std::min(box.low[k], x[k]);
      box.high[k] = std::max(box.high[k], x[k]);
    }
  };
  for (std::size_t n = 0; n < at.size(); ++n)
    widen(vertices[std::size_t(points.place(int(n)).j)], at[n]);
  std::map<std::array<int, 2>, int> sides;  // of triangles, by their ends
  for (const auto& t : patches_.triangles())
    for (std::size_t k = 0; k < 3; ++k) {
      widen(reached[std::size_t(points.place(t[0]).j)], at[std::size_t(t[k])]);
      // A triangle's side is turned the other way by the next triangle.
      const std::array<int, 2> side{t[k], t[(k + 1) % 3]}, back{side[1], side[0]};
      if (const auto other = sides.find(back); other != sides.end())
        sides.erase(other);
      else
        sides[side] = 1;
    }
  std::vector<std::array<int, 2>> border;
  for (const auto& [side, once] : sides) border.push_back(side);
  const auto meet = [](const Box& a, const Box& b, double within) {
    return std::max({a.low[0] - b.high[0], b.low[0] - a.high[0], a.low[1] - b.high[1],
                     b.low[1] - a.high[1]}) <= within;
  };
  for (int a = 0; a < points.rows; ++a)
    for (int b = a; b < points.rows; ++b) {
      if (!meet(vertices[std::size_t(a)], vertices[std::size_t(b)], reach)) continue;
      Box both = vertices[std::size_t(a)];
      widen(both, {vertices[std::size_t(b)].low[0], vertices[std::size_t(b)].low[1]});
      widen(both, {vertices[std::size_t(b)].high[0], vertices[std::size_t(b)].high[1]});
      if (!keeps_within(a, b, both, at, border)) continue;
      Pair pair{a, b, {}};
      for (int c = 0; c < points.rows; ++c)
        if (meet(both, reached[std::size_t(c)], 0)) pair.crossed.push_back(c);
      pairs_.push_back(std::move(pair));
    }
}

// Whether the vertices of two patches lie on the inner side of every side of the mesh about them.
bool FlatPatches::keeps_within(int a, int b, const Box& about, const std::vector<Flat>& at,
                               const std::vector<std::array<int, 2>>& border) const {
  const Particles& points = patches_.points();
  return std::all_of(border.begin(), border.end(), [&](const std::array<int, 2>& side) {
    const Flat &p = at[std::size_t(side[0])], &q = at[std::size_t(side[1])];
    for (std::size_t k = 0; k < 2; ++k)
      if (std::max(p[k], q[k]) < about.low[k] || std::min(p[k], q[k]) > about.high[k]) return true;
    const double x = q[0] - p[0], y = q[1] - p[1], tolerance = kFlat * (x * x + y * y);
    for (const int patch : {a, b})
      for (int i = 0; i < points.count(patch); ++i) {
        const Flat& r = at[std::size_t(points.number(patch, i))];
        if (x * (r[1] - p[1]) - y * (r[0] - p[0]) < -tolerance) return false;
      }
    return true;
  });
}

int FlatPatches::pair(int a, int b) const {
  const auto found = std::lower_bound(
      pairs_.begin(), pairs_.end(), std::pair(a, b),
      [](const Pair& p, const std::pair<int, int>& of) { return std::pair(p.a, p.b) < of; });
  return found != pairs_.end() && found->a == a && found->b == b ? int(found - pairs_.begin()) : -1;
}

std::size_t FlatPatches::bytes() const {
  std::size_t bytes = triangles_.size() * sizeof(Triangle) + 8 * begin_.size();
  for (const Pair& p : pairs_) bytes += sizeof p + 4 * p.crossed.capacity();
  return bytes;
}

}  // namespace weft::physics
