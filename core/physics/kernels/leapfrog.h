// The leapfrog move of particles, and what it keeps of rounding in fine substeps (kept.h).
#pragma once

#include "physics/kernels/kept.h"

namespace weft::WEFT_KERNELS {

WEFT_INLINE void move_finely(Row3 x, Row3 v, const physics::Left& left, WideInt free, Wide gain,
                             Wide3 f, const Advance& a, std::ptrdiff_t i) {
  Kept place = kept_at<true>(x, left.x, i), velocity = kept_at<true>(v, left.v, i);
  drop_where_at_rest(place, velocity);
  velocity.move<true>(gained(velocity.value, free, gain, f, a));
  place.move<true>(velocity.value * wide(a.dt));
  store_kept<true>(x, v, left, i, place, velocity);
}

// v <- c v + kick (f/m + g), x <- x + dt v.
WEFT_INLINE void move(Row3 x, Row3 v, const physics::Left& left, const float* inverse_mass, Wide3 f,
                      const Advance& a, std::ptrdiff_t i) {
  const Wide w = load(inverse_mass + i), gain = w * a.kick;
  if (left.x.x) return move_finely(x, v, left, w > 0.0f, gain, f, a, i);
  const Wide3 velocity = moved(load3(v, i), w > 0.0f, gain, f, a);
  store3(v, i, velocity);
  store3(x, i, fma(velocity, wide(a.dt), load3(x, i)));
}

// Moves the block at `x` in the positions of a sheet's rows, of whose row `left` columns are left from its
// first lane on. kSides: columns at the sides stand for half of an inner one; kAlike: all that the rows
// hold is free, and of one mass but for that.
template <bool kSides, bool kAlike>
WEFT_INLINE void leapfrog(const physics::LeapfrogRows& r, float* x, int left, Wide3 force) {
  const std::ptrdiff_t lane = x - r.x.x, plane = r.x.y - r.x.x;
  Wide gain;
  WideInt free;
  if constexpr (kAlike) {
    free = lanes_below(left);
    gain = wide(r.alike * r.advance.kick);
    if constexpr (kSides) gain = gain * load(r.inverse_width + (r.columns - left));
  } else {
    const Wide w = load(r.w + lane);
    free = w > 0.0f;
    gain = w * r.advance.kick;
  }
  if (r.left.x.x) return move_finely(r.x, r.v, r.left, free, gain, force, r.advance, lane);
  const Wide3 before = load_planes(r.v.x + lane, plane);
  const Wide3 velocity = kAlike ? select(free, moved_free(before, gain, force, r.advance), Wide3{})
                                : moved(before, free, gain, force, r.advance);
  store_planes(r.v.x + lane, plane, velocity);
  store_planes(x, plane, fma(velocity, wide(r.advance.dt), load_planes(x, plane)));
}

}  // namespace weft::WEFT_KERNELS
