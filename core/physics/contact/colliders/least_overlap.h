// The shortest way on which a triangle leaves the core of a shape.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/contact/colliders/shapes.h"

namespace weft::physics {

// Any direction along which core and triangle overlap leads out, by so much; one along which they do not shows
// that they are apart, and ends the search. The least lies along the triangle's normal, across one of its edges,
// or, above a corner, along a normal of the core. support(n): the point of the core furthest along a unit vector.
template <class Support>
class LeastOverlap {
 public:
  LeastOverlap(const Triangle& t, Support support) : t_(t), support_(support) {
    along(normal_of(t[0], t[1], t[2]));
  }

  // Looks along a direction of any length, there and back.
  void along(const Vec3& direction) {
    const double size = length(direction);
    if (size == 0) return;
    for (const double side : {-1.0, 1.0}) towards(times(direction, side / size));
  }
  // Looks along a unit vector.
  void towards(const Vec3& n) {
    if (best_.depth > 0) furthest(n);
  }
  // Looks across all edges at a core that is round, to a hundredth of the depth.
  void across_edges() {
    const Vec3 normal = normal_of(t_[0], t_[1], t_[2]);
    const double size = length(normal);
    if (size == 0) return;
    const Vec3 up = times(normal, 1 / size);
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 edge = minus(t_[(k + 1) % 3], t_[k]);
      const View view{t_[k], times(cross(up, edge), 1 / length(edge)), up};
      narrow(view, seen(view, 0, -1), seen(view, 0, 1), kChords);
    }
  }

  // No depth where the two are apart, or where the triangle has shrunk so that no direction was there to look along.
  Overlap found() const {
    return best_.depth > 0 && std::isfinite(best_.depth) ? best_ : Overlap{};
  }

 private:
  static constexpr int kChords = 10;  // within each other, at most

  // What is seen along an edge: a point of it, the way into the triangle, and that along its normal.
  struct View {
    Vec3 from, in, up;
  };
  struct Point {
    double in, up;
  };

  Vec3 furthest(const Vec3& n) {
    double low = 1e300;
    for (const Vec3& x : t_) low = std::min(low, dot(n, x));
    const Vec3 point = support_(n);
    const double depth = dot(n, point) - low;
    if (depth < best_.depth) best_ = {depth, n};
    return point;
  }
  Point seen(const View& view, double in, double up) {
    const Vec3 p = minus(furthest(plus(times(view.in, in), times(view.up, up))), view.from);
    return {dot(p, view.in), dot(p, view.up)};
  }
  // The core's outline runs from a to b outside of their chord, so that no direction in between has less depth than
  // that across the chord.
  void narrow(const View& view, const Point& a, const Point& b, int chords) {
    const double in = b.up - a.up, up = a.in - b.in, length = std::sqrt(in * in + up * up);
    if (chords == 0 || length == 0 || best_.depth <= 0) return;
    if (a.in * in + a.up * up > 0.99 * best_.depth * length) return;
    const Point middle = seen(view, in / length, up / length);
    narrow(view, a, middle, chords - 1);
    narrow(view, middle, b, chords - 1);
  }

  const Triangle& t_;
  Support support_;
  Overlap best_{std::numeric_limits<double>::infinity(), {}};
};

}  // namespace weft::physics
