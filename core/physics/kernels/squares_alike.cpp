// Pairs of squares that share a corner, or are one and the same: whether they lie so much alike that they cannot
// touch.
//
// Two points of them that are a columns and b rows apart are a A + b B from each other, with A a mean of
// their edges along rows and B of those along columns. So they are at least ρ times as far apart as on the
// flat sheet, with
//
//   ρ² (1 + |u·v|/(|u||v|)) = min(min |A|²/|u|², min |B|²/|v|²) - max |A·B|/(|u||v|)
//
// where u and v are the edges at rest. Contact keeps half of that distance.
// Edges change by no more than corners come from each other.
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"
#include "physics/kernels/surface.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::SquaresAlike;

constexpr int kRecord = 4;      // floats
constexpr float kApart = 0.6f;  // ρ, with what an interval may change
// Of the shorter edge at rest: looked at again after the first of these by which they may change. Flat squares may
// by 0.07.
constexpr float kChanges[] = {0.065f, 0.03f, 0};

// How squares lie: their mean edges along rows and columns, the squares of these, and how far edges are off them.
struct Lie {
  Wide3 u, v;
  Wide uu, vv, warp;
};

WEFT_INLINE Lie lie_of(const SquaresAlike& s, const std::int32_t* numbers) {
  const Wide4 square = records_at((const float*)s.squares->corner, kRecord, numbers);
  const WideInt corner[4] = {(WideInt)square.xyz.x, (WideInt)square.xyz.y, (WideInt)square.xyz.z,
                             (WideInt)square.last};
  Wide3 x[4];
  for (int n = 0; n < 4; ++n)
    x[n] = records_at(s.place->x, kRecord, (const std::int32_t*)&corner[n]).xyz;
  const Wide3 first = x[1] - x[0], second = x[3] - x[2];
  const Wide3 u = (first + second) * wide(0.5f), v = (x[2] - x[0] + x[3] - x[1]) * wide(0.5f);
  const Wide3 off = (second - first) * wide(0.5f);
  return {u, v, dot(u, u), dot(v, v), sqrt(dot(off, off))};
}

// The least length of a mean of two vectors, by their squares and their product.
WEFT_INLINE Wide least_between(Wide aa, Wide bb, Wide ab) {
  const Wide least = min(aa, bb);
  const Wide across = max(Wide{}, aa * bb - ab * ab) / (aa + bb - 2.0f * ab);
  return sqrt(select(ab >= least, least, across));
}

WEFT_INLINE Wide change(const SquaresAlike& s, int at, const float (&changes)[3], float rest) {
  const Lie a = lie_of(s, s.owner + at), b = lie_of(s, s.neighbour + at);
  const Wide askew =
      max(max(abs(dot(a.u, a.v)), abs(dot(a.u, b.v))), max(abs(dot(b.u, a.v)), abs(dot(b.u, b.v))));
  const Wide warp = max(a.warp, b.warp);
  const Wide least_u = least_between(a.uu, b.uu, dot(a.u, b.u));
  const Wide least_v = least_between(a.vv, b.vv, dot(a.v, b.v));
  const Wide longest = sqrt(max(max(a.uu, b.uu), max(a.vv, b.vv)));
  const float apart = kApart * kApart * (1 + (s.uv < 0 ? -s.uv : s.uv) / rest), inverse = 1 / rest;
  // Whether they lie alike when edges are others by so much.
  const auto holds = [&](float by) {
    const Wide off = warp + 2 * by, u = least_u - off, v = least_v - off;
    const Wide needed = apart + (askew + off * (2.0f * (longest + by) + off)) * inverse;
    return (u > 0.0f) & (v > 0.0f) & (u * u >= needed * s.uu) & (v * v >= needed * s.vv);
  };
  Wide by = wide(-1);
  for (int k = 2; k >= 0; --k) by = select(holds(changes[k]), wide(changes[k]), by);
  return by;
}

}  // namespace

void squares_alike(const SquaresAlike& given) {
  const SquaresAlike s = given;
  const float rest = __builtin_sqrtf(s.uu * s.vv);
  const float shorter = __builtin_sqrtf(s.uu < s.vv ? s.uu : s.vv);
  const float changes[3] = {kChanges[0] * shorter, kChanges[1] * shorter, kChanges[2] * shorter};
  for (int k = 0; k < s.pairs; k += kLanes) store(s.change + k, change(s, k, changes, rest));
}

}  // namespace weft::WEFT_KERNELS
