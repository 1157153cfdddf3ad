// Shared by the kernel sources: wide loads of a row, and the leapfrog move.
#pragma once

#include <cstddef>

#include "physics/kernels/lattice.h"
#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

using namespace physics;

WEFT_INLINE Wide3 load3(ConstRow3 r, std::ptrdiff_t i) {
  return {load(r.x + i), load(r.y + i), load(r.z + i)};
}
WEFT_INLINE void store3(Row3 r, std::ptrdiff_t i, Wide3 v) {
  store(r.x + i, v.x);
  store(r.y + i, v.y);
  store(r.z + i, v.z);
}

// Components whose arrays lie `plane` floats apart, from that of x on.
WEFT_INLINE Wide3 load_planes(const float* x, std::ptrdiff_t plane) {
  return {load(x), load(x + plane), load(x + 2 * plane)};
}
WEFT_INLINE void store_planes(float* x, std::ptrdiff_t plane, Wide3 v) {
  store(x, v.x);
  store(x + plane, v.y);
  store(x + 2 * plane, v.z);
}

// Delay3<N> for any N up to 16 known only at run time: through a buffer that holds the lanes before.
class LongDelay3 {
 public:
  explicit LongDelay3(int lanes) : lanes_(lanes) {}
  WEFT_INLINE Wide3 next(Wide3 block) {
    store3({x_ + 16, y_ + 16, z_ + 16}, 0, block);
    const Wide3 delayed = load3(ConstRow3(x_, y_, z_), 16 - lanes_);
    for (int i = 0; i < 16; ++i) {
      x_[i] = x_[i + kLanes];
      y_[i] = y_[i + kLanes];
      z_[i] = z_[i + kLanes];
    }
    return delayed;
  }

 private:
  int lanes_;
  alignas(64) float x_[32] = {}, y_[32] = {}, z_[32] = {};
};

// Rows are worked through in whole groups of 16 lanes at every width, so that lanes past the end see
// the same operations whatever the instruction set.
WEFT_INLINE int padded(int count) {
  return (count + 15) & ~15;
}

// c v + kick (f/m + g); nothing is added where the inverse mass w is 0, that of a pinned particle.
WEFT_INLINE Wide3 moved(Wide3 v, Wide w, Wide3 f, const Advance& a) {
  const WideInt free = w > 0.0f;
  const Wide3 g = select(free, wide3(a.gx, a.gy, a.gz), Wide3{});
  return fma(f, w * a.kick, fma(v, wide(a.drag), g));
}
// The same where all particles are free; `gain`: w kick.
WEFT_INLINE Wide3 moved_free(Wide3 v, Wide gain, Wide3 f, const Advance& a) {
  return fma(f, gain, fma(v, wide(a.drag), wide3(a.gx, a.gy, a.gz)));
}

// v <- c v + kick (f/m + g), x <- x + dt v.
WEFT_INLINE void move(Row3 x, Row3 v, const float* inverse_mass, Wide3 f, const Advance& a,
                      std::ptrdiff_t i) {
  const Wide3 velocity = moved(load3(v, i), load(inverse_mass + i), f, a);
  store3(v, i, velocity);
  store3(x, i, fma(velocity, wide(a.dt), load3(x, i)));
}

// Moves the block at `x` in the positions of a sheet's rows, of whose row `left` columns are left from its
// first lane on. kSides: columns at the sides stand for half of an inner one; kAlike: all that the rows
// hold is free, and of one mass but for that.
template <bool kSides, bool kAlike>
WEFT_INLINE void leapfrog(const physics::LeapfrogRows& r, float* x, int left, Wide3 force) {
  const std::ptrdiff_t lane = x - r.x.x, plane = r.x.y - r.x.x;
  const Wide3 before = load_planes(r.v.x + lane, plane);
  Wide3 velocity;
  if constexpr (kAlike) {
    Wide gain = wide(r.alike * r.advance.kick);
    if constexpr (kSides) gain = gain * load(r.inverse_width + (r.columns - left));
    velocity = moved_free(before, gain, force, r.advance);
    velocity = select(lanes_below(left), velocity, Wide3{});
  } else {
    velocity = moved(before, load(r.w + lane), force, r.advance);
  }
  store_planes(r.v.x + lane, plane, velocity);
  store_planes(x, plane, fma(velocity, wide(r.advance.dt), load_planes(x, plane)));
}

}  // namespace weft::WEFT_KERNELS
