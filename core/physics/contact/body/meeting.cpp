#include "physics/contact/body/meeting.h"

#include <algorithm>
#include <cmath>

namespace weft::physics {
namespace {

constexpr double kEdge = 1e-9;  // of a triangle, beyond its sides

struct Cubic {
  double c[4];
  double at(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
};

// Times the volume over the triangle, which is zero in its plane; all that it is made of is linear in time.
Cubic volume_of(const Vec3& from, const Vec3& to, const Triangle& begin, const Triangle& end) {
  const Vec3 x = minus(from, begin[0]), e = minus(begin[1], begin[0]),
             f = minus(begin[2], begin[0]);
  const Vec3 dx = minus(minus(to, end[0]), x), de = minus(minus(end[1], end[0]), e),
             df = minus(minus(end[2], end[0]), f);
  const Vec3 n0 = cross(e, f), n1 = plus(cross(de, f), cross(e, df)), n2 = cross(de, df);
  return {{dot(x, n0), dot(dx, n0) + dot(x, n1), dot(dx, n1) + dot(x, n2), dot(dx, n2)}};
}

// Where the cubic turns, in ascending order between 0 and 1, which come first and last.
int pieces_of(const Cubic& v, double (&ends)[4]) {
  const double a = 3 * v.c[3], b = 2 * v.c[2], c = v.c[1], square = b * b - 4 * a * c;
  int count = 0;
  ends[count++] = 0;
  if (square > 0) {
    const double q = -(b + (b < 0 ? -1 : 1) * std::sqrt(square)) / 2;
    double one = a != 0 ? q / a : -1, two = q != 0 ? c / q : -1;
    if (one > two) std::swap(one, two);
    for (const double t : {one, two})
      if (t > ends[count - 1] && t < 1) ends[count++] = t;
  }
  ends[count++] = 1;
  return count;
}

bool within_sides(const Vec3& p, const Triangle& t, Weights& w) {
  const Vec3 e = minus(t[1], t[0]), f = minus(t[2], t[0]), x = minus(p, t[0]), n = cross(e, f);
  const double square = dot(n, n);
  if (!(square > 0)) return false;
  const double u = dot(cross(x, f), n) / square, v = dot(cross(e, x), n) / square;
  w = {1 - u - v, u, v};
  return u >= -kEdge && v >= -kEdge && u + v <= 1 + kEdge;
}

}  // namespace

Met meets(const Vec3& from, const Vec3& to, const Triangle& t) {
  const Vec3 way = minus(to, from);
  const Vec3 e = minus(t[1], t[0]), f = minus(t[2], t[0]), s = minus(from, t[0]);
  const Vec3 across = cross(way, f), q = cross(s, e);
  const double det = dot(e, across);
  if (det == 0) return {};
  const double u = dot(s, across) / det, v = dot(way, q) / det, at = dot(f, q) / det;
  const bool met = u >= -kEdge && v >= -kEdge && u + v <= 1 + kEdge && at >= 0 && at <= 1;
  return met ? Met{at, {1 - u - v, u, v}} : Met{};
}

Met meets_moving(const Vec3& from, const Vec3& to, const Triangle& begin, const Triangle& end) {
  constexpr int kHalvings = 52;
  const Cubic volume = volume_of(from, to, begin, end);
  double ends[4];
  const int count = pieces_of(volume, ends);
  for (int n = 1; n < count; ++n) {
    double low = ends[n - 1], high = ends[n];
    const double at_low = volume.at(low), at_high = volume.at(high);
    if ((at_low > 0 && at_high > 0) || (at_low < 0 && at_high < 0)) continue;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = (low + high) / 2;
      ((volume.at(middle) > 0) == (at_low > 0) ? low : high) = middle;
    }
    const auto then = [&](const Vec3& a, const Vec3& b) {
      return plus(times(a, 1 - high), times(b, high));
    };
    Met met{high, {}};
    const Triangle t{then(begin[0], end[0]), then(begin[1], end[1]), then(begin[2], end[2])};
    if (within_sides(then(from, to), t, met.weights)) return met;
  }
  return {};
}

}  // namespace weft::physics
