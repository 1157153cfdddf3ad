// Shared by the kernel sources: wide loads of a row, and how velocities gain by forces.
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

// c v + kick (f/m + g); nothing is added where a particle is pinned. `gain`: kick over the mass, 0 if pinned.
WEFT_INLINE Wide3 moved(Wide3 v, WideInt free, Wide gain, Wide3 f, const Advance& a) {
  const Wide3 g = select(free, wide3(a.gx, a.gy, a.gz), Wide3{});
  return fma(f, gain, fma(v, wide(a.drag), g));
}
// What it has more than v: drag is lost, of which a factor near 1 tells little.
WEFT_INLINE Wide3 gained(Wide3 v, WideInt free, Wide gain, Wide3 f, const Advance& a) {
  const Wide3 g = wide3(a.gx, a.gy, a.gz) - v * wide(a.lost);
  return select(free, fma(f, gain, g), Wide3{});
}
// As moved() where all particles are free.
WEFT_INLINE Wide3 moved_free(Wide3 v, Wide gain, Wide3 f, const Advance& a) {
  return fma(f, gain, fma(v, wide(a.drag), wide3(a.gx, a.gy, a.gz)));
}

}  // namespace weft::WEFT_KERNELS
