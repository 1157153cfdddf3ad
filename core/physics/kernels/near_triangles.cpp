// Which triangles may be the nearest to a point (body.h): distances in single precision, and how exact they are.
//
// A triangle is as far as the nearest of its sides, or as its plane where the point lies above its inside. Where
// rounding takes a point for one above the outside, or the other way round, the two differ by no more than that
// moves it along the plane: by the rounding of positions, times how much longer a triangle is than high. Of slivers
// only the sides count, which are nearer to each other than they are high.
#include "physics/kernels/body.h"
#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::NearestOfThem;
using physics::TrianglesAbout;
using physics::TrianglesOnWay;

constexpr float kSliver = 1e-3f;  // of its longest side: how high one is
constexpr float kTiny = 1e-30f;   // m², m⁴

// Rows of a placed triangle: a corner, the sides from there, the reciprocals of the squared sides, the normal, the
// gradients of the two weights, and the greatest sum of these.
enum Row {
  kCorner = 0,
  kAb = 3,
  kAc = 6,
  kSides = 9,
  kNormal = 12,
  kB = 15,
  kC = 18,
  kInside = 21
};
static_assert(kInside + 1 == physics::kPlacedRows);

struct Rows {
  float* at;
  int stride;
  WEFT_INLINE float* row(int n) const { return at + std::ptrdiff_t(n) * stride; }
  WEFT_INLINE void put(int n, Wide3 v) const {
    store(row(n), v.x);
    store(row(n + 1), v.y);
    store(row(n + 2), v.z);
  }
};

WEFT_INLINE Wide3 three(const float* p, std::ptrdiff_t stride) {
  return {load(p), load(p + stride), load(p + 2 * stride)};
}

// Squared distance from a segment that begins at the origin.
WEFT_INLINE Wide from_side(Wide3 p, Wide3 side, Wide inverse_square) {
  const Wide t = max(min(dot(p, side) * inverse_square, wide(1)), Wide{});
  const Wide3 d = fnma(side, t, p);
  return dot(d, d);
}

}  // namespace

float place_triangles(const TrianglesOnWay& given) {
  const TrianglesOnWay s = given;
  Wide slack = wide(s.rounding);
  for (int k = 0; k < s.stride; k += kLanes) {
    Wide3 corner[3];
    for (int n = 0; n < 3; ++n) {
      const std::ptrdiff_t at = std::ptrdiff_t(3 * n) * s.stride + k;
      corner[n] = three(s.from + at, s.stride);
      if (s.way) corner[n] = fma(three(s.way + at, s.stride), wide(s.share), corner[n]);
    }
    const Wide3 ab = corner[1] - corner[0], ac = corner[2] - corner[0], bc = corner[2] - corner[1];
    const Wide3 sides = {dot(ab, ab), dot(ac, ac), dot(bc, bc)}, n = cross(ab, ac);
    const Wide longest = max(max(max(sides.x, sides.y), sides.z), wide(kTiny)), square = dot(n, n);
    const WideInt high = square > max(longest * longest * (kSliver * kSliver), wide(kTiny));
    const Wide inverse = 1 / select(high, square, wide(1));
    slack = max(slack, select(high, s.rounding * (1 + longest * sqrt(inverse)),
                              s.rounding + sqrt(square / longest)));
    const Rows out{s.placed + k, s.stride};
    out.put(kCorner, corner[0]);
    out.put(kAb, ab);
    out.put(kAc, ac);
    out.put(kSides, {1 / max(sides.x, wide(kTiny)), 1 / max(sides.y, wide(kTiny)),
                     1 / max(sides.z, wide(kTiny))});
    out.put(kNormal, n * sqrt(inverse));
    out.put(kB, cross(ac, n) * inverse);
    out.put(kC, cross(n, ab) * inverse);
    store(out.row(kInside), select(high, wide(1), wide(-1)));
  }
  return greatest(slack);
}

NearestOfThem nearest_triangles(const TrianglesAbout& given) {
  const TrianglesAbout s = given;
  const Wide3 p = wide3(s.x, s.y, s.z);
  Wide nearest = wide(1e38f);
  for (int k = 0; k < s.count; k += kLanes) {
    const float* const at = s.placed + s.first + k;
    const auto rows = [&](int n) { return three(at + std::ptrdiff_t(n) * s.stride, s.stride); };
    const Wide3 ap = p - rows(kCorner), ab = rows(kAb), ac = rows(kAc), sides = rows(kSides);
    const Wide from_sides = min(min(from_side(ap, ab, sides.x), from_side(ap, ac, sides.y)),
                                from_side(ap - ab, ac - ab, sides.z));
    const Wide b = dot(rows(kB), ap), c = dot(rows(kC), ap), off = dot(rows(kNormal), ap);
    const WideInt inside =
        (b >= 0.0f) & (c >= 0.0f) & (b + c <= load(at + std::ptrdiff_t(kInside) * s.stride));
    const Wide square = select(lanes_below(s.count - k),
                               select(inside, min(off * off, from_sides), from_sides), wide(1e38f));
    store(s.squares + k, square);
    nearest = min(square, nearest);
  }
  const float distance = __builtin_sqrtf(least(nearest));
  const float most = distance + 2 * s.slack;
  int count = 0;
  for (int k = 0; k < s.count; k += kLanes)
    count += store_lanes(s.nearest + count, where_less(load(s.squares + k), wide(most * most)),
                         lanes_at(s.numbers + s.first + k));
  return {count, distance};
}

}  // namespace weft::WEFT_KERNELS
