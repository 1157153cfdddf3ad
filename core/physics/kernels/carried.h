// How a collider and the particles of a row move past each other.
#pragma once

#include "physics/kernels/row_kernels.h"
#include "physics/kernels/shape_kernels.h"

namespace weft::WEFT_KERNELS {

WEFT_INLINE Wide3 place_velocity(const CollideRow& r) {
  return wide3(r.ux, r.uy, r.uz);
}

// Velocity of the collider where a particle was that is at p, seen from its place, and has velocity v: the mean over the
// substep. So dt (v - carried) is the path of the particle, seen from the collider as it stands at the end.
WEFT_INLINE Wide3 carried(const CollideRow& r, Wide3 p, Wide3 v) {
  const Wide3 u = place_velocity(r);
  if (!r.turns) return u;
  const Wide3 before = p - (v - u) * wide(r.dt);
  const auto row = [&](int k) {
    return dot(before, wide3(r.turning[k][0], r.turning[k][1], r.turning[k][2]));
  };
  return u + Wide3{row(0), row(1), row(2)};
}

// The square of the speed past the collider's place.
WEFT_INLINE Wide past_place(const CollideRow& r, Wide3 v) {
  const Wide3 past = v - place_velocity(r);
  return dot(past, past);
}

WEFT_INLINE WideInt free_lanes(const CollideRow& r, int i) {
  return (load(r.w + i) > 0.0f) & lanes_below(r.columns - i);
}

}  // namespace weft::WEFT_KERNELS
