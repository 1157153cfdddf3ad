// A triangle against the shape of a collider, in double precision, seen from the shape's place and in its
// own axes: the deepest point of one in the other.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/contact/colliders/shapes.h"

namespace weft::physics {

using Weights = std::array<double, 3>;

// One triangle's corners, seen from the collider's place at the end of the substep.
struct Corners {
  Triangle x, path;  // and how far each came in this substep
  Vec3 at(const Weights& b) const {
    return plus(plus(times(x[0], b[0]), times(x[1], b[1])), times(x[2], b[2]));
  }
};

inline double longest_side(const Triangle& t) {
  double square = 0;
  for (int k = 0; k < 3; ++k) {
    const Vec3 side = minus(t[(k + 1) % 3], t[k]);
    square = std::max(square, dot(side, side));
  }
  return std::sqrt(square);
}

// The point of a triangle nearest to q (Ericson, Real-Time Collision Detection, 5.1.5).
inline Weights nearest_on(const Triangle& t, const Vec3& q) {
  const Vec3 ab = minus(t[1], t[0]), ac = minus(t[2], t[0]), aq = minus(q, t[0]);
  const double d1 = dot(ab, aq), d2 = dot(ac, aq);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bq = minus(q, t[1]);
  const double d3 = dot(ab, bq), d4 = dot(ac, bq);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double s = d1 / std::max(d1 - d3, 1e-300);
    return {1 - s, s, 0};
  }
  const Vec3 cq = minus(q, t[2]);
  const double d5 = dot(ab, cq), d6 = dot(ac, cq);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double s = d2 / std::max(d2 - d6, 1e-300);
    return {1 - s, 0, s};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double s = (d4 - d3) / std::max((d4 - d3) + (d5 - d6), 1e-300);
    return {0, 1 - s, s};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

struct Deepest {
  Weights weights{};
  Nearest nearest;
};

// The point of a triangle nearest to the core of a shape.
struct Approach {
  Weights weights{1 / 3., 1 / 3., 1 / 3.};
  bool apart = false;  // the two do not cut each other
  bool far = false;    // and are further apart than is asked for
};

inline constexpr int kProjections = 12;  // between triangle and core

// By alternating projections between the two, which mostly need two or three. They end early at a plane
// that holds the two further apart than `enough`. `exact`: whether the last plane proves the distance to
// `tolerance` [m].
template <class Shape>
Approach project(const Shape& shape, const Corners& c, double enough, double edge, double tolerance,
                 bool& exact) {
  Approach a;
  Core core = core_of(shape, c.at(a.weights));
  for (int n = 0; n < kProjections; ++n) {
    const Weights before = a.weights;
    a.weights = nearest_on(c.x, core.nearest);
    const Vec3 here = c.at(a.weights);
    core = core_of(shape, here);
    const Vec3 way = minus(here, core.nearest);
    const double square = dot(way, way);
    double least = 1e300;
    for (const Vec3& x : c.x) least = std::min(least, dot(way, minus(x, here)));
    const double apart = std::sqrt(std::max(square, 1e-300)), gap = (square + least) / apart;
    a.apart |= gap > 1e-6 * edge;  // more than rounding
    a.far = a.apart && gap >= enough;
    exact = a.far || apart - gap < tolerance;
    const Vec3 change = minus(a.weights, before);
    if (a.far || dot(change, change) < 1e-12) break;
  }
  return a;
}

// Up to four differences between corners of a triangle and points of a core, and where among them the
// origin's nearest point lies (Gilbert, Johnson, Keerthi 1988).
class Differences {
 public:
  bool holds(const Vec3& y) const { return std::find(y_, y_ + count_, y) != y_ + count_; }
  void add(const Vec3& y, int corner) {
    y_[count_] = y;
    corner_[count_++] = corner;
  }
  // Finds the nearest point and keeps only what it lies between. False: the origin is inside.
  bool reduce() {
    if (count_ == 4) return reduce_four();
    const Triangle t{y_[0], y_[count_ > 1 ? 1 : 0], y_[count_ - 1]};
    const Weights w = nearest_on(t, {});
    if (count_ == 3)
      keep({0, 1, 2}, w);
    else
      keep({0, count_ - 1, count_ - 1}, {w[0], count_ > 1 ? w[1] + w[2] : 0, 0});
    return true;
  }
  Vec3 nearest() const {
    Vec3 v{};
    for (int n = 0; n < count_; ++n) v = plus(v, times(y_[n], weight_[n]));
    return v;
  }
  Weights on_triangle() const {
    Weights w{};
    for (int n = 0; n < count_; ++n) w[std::size_t(corner_[n])] += weight_[n];
    return w;
  }

 private:
  bool reduce_four() {
    double least = 1e300;
    std::array<int, 3> best{};
    Weights weights{};
    for (int out = 0; out < 4; ++out) {
      const std::array<int, 3> f{(out + 1) % 4, (out + 2) % 4, (out + 3) % 4};
      const Triangle t{y_[f[0]], y_[f[1]], y_[f[2]]};
      const Vec3 n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
      if (-dot(n, t[0]) * dot(n, minus(y_[out], t[0])) > 0)
        continue;  // the origin is on its inner side
      const Weights w = nearest_on(t, {});
      const Vec3 p = plus(plus(times(t[0], w[0]), times(t[1], w[1])), times(t[2], w[2]));
      if (dot(p, p) >= least) continue;
      least = dot(p, p);
      best = f;
      weights = w;
    }
    if (least == 1e300) return false;
    keep(best, weights);
    return true;
  }
  void keep(const std::array<int, 3>& which, const Weights& weights) {
    const auto y = std::to_array(y_);
    const auto corner = std::to_array(corner_);
    count_ = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      if (weights[n] <= 0) continue;
      weight_[count_] = weights[n];
      add(y[std::size_t(which[n])], corner[std::size_t(which[n])]);
    }
  }

  int count_ = 0;
  Vec3 y_[4];
  int corner_[4];
  double weight_[4];
};

inline constexpr int kDifferences = 40;  // looked at, at most

// The same for triangle and core of any proportions. Where both are polytopes the search ends; the core of a
// cylinder is round, and what planes between the two prove counts where it does not end in time.
template <class Shape>
Approach search(const Shape& shape, const Corners& c, double enough, double edge) {
  Differences found;
  found.add(minus(c.x[0], support_of(shape, minus(Vec3{}, c.x[0]))), 0);
  Approach a;
  double proved = 0;  // m; they are at least so far apart
  bool ended = false;
  for (int n = 0; n < kDifferences && !ended; ++n) {
    if (!found.reduce()) return a;
    const Vec3 v = found.nearest();
    const double square = dot(v, v);
    a.weights = found.on_triangle();
    if (square < 1e-12 * edge * edge) return a;
    int k = 0;
    for (int m = 1; m < 3; ++m)
      if (dot(v, c.x[std::size_t(m)]) < dot(v, c.x[std::size_t(k)])) k = m;
    const Vec3 y = minus(c.x[std::size_t(k)], support_of(shape, v));
    proved = std::max(proved, dot(v, y) / std::sqrt(square));
    ended = square - dot(v, y) <= 1e-9 * square || found.holds(y);
    if (!ended) found.add(y, k);
  }
  const Vec3 v = found.nearest();
  a.apart = ended || proved > 1e-6 * edge;
  a.far = ended ? dot(v, v) >= enough * enough : proved >= enough;
  return a;
}

template <class Shape>
Approach approach(const Shape& shape, const Corners& c, double enough, double edge,
                  double tolerance) {
  bool exact = false;
  const Approach a = project(shape, c, enough, edge, tolerance * edge, exact);
  return exact ? a : search(shape, c, enough, edge);
}

inline constexpr double kExact = 1e-4;  // of an edge

// The deepest point of a triangle in a shape, to a tolerance in edges: where several points are as deep but
// for that, one that alternating projections come to. One that cuts the core is first moved out of it, along
// the way of least overlap.
template <class Shape>
Deepest deepest_on(const Shape& shape, Corners c, double offset, double edge,
                   double tolerance = kExact) {
  const double radius = core_of(shape, c.x[0]).radius;
  Approach a = approach(shape, c, radius + offset, edge, tolerance);
  if (a.far) return {a.weights, {offset, {}}};
  if (!a.apart) {
    if (const Overlap overlap = overlap_of(shape, c.x); overlap.depth > 0) {
      for (Vec3& x : c.x) x = plus(x, times(overlap.normal, overlap.depth + 1e-3 * edge));
      a = approach(shape, c, std::numeric_limits<double>::infinity(), edge, tolerance);
      return {a.weights, {-overlap.depth - radius, overlap.normal}};
    }
  }
  return {a.weights, nearest_of(shape, c.at(a.weights))};
}

// A shape in its own axes: a box is looked at there.
struct Upright {
  Shape shape;
  std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

  explicit Upright(const Shape& given) : shape(given) {
    if (auto* box = std::get_if<Box>(&shape)) {
      axes = axes_of(*box);
      for (Vec3& axis : axes)  // as the kernels have them
        for (double& value : axis) value = float(value);
      box->rotation = {};
    }
  }
  Vec3 into(const Vec3& p) const { return {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)}; }
  Vec3 out_of(const Vec3& p) const {
    return plus(plus(times(axes[0], p[0]), times(axes[1], p[1])), times(axes[2], p[2]));
  }
};

}  // namespace weft::physics
