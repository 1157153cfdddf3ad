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

// How much faster than `carried`, the mean over the substep, the collider moves at its end where a particle is at p.
WEFT_INLINE Wide3 faster_at_end(const CollideRow& r, Wide3 p, Wide3 u) {
  // Half of what the turn before and the one to come make of p: along the circle, where each is a chord.
  const auto row = [&](int k) {
    return 0.5f * dot(p, wide3(r.turning[k][0] - r.turning[0][k], r.turning[k][1] - r.turning[1][k],
                               r.turning[k][2] - r.turning[2][k]));
  };
  return place_velocity(r) + Wide3{row(0), row(1), row(2)} - u;
}

// A direction of the collider as it stands at the end, where it pointed before the substep: `turning` takes a place then
// to its velocity, and so 1 + dt turning to where it is now; its transpose turns back.
WEFT_INLINE Wide3 turned_back(const CollideRow& r, Wide3 n) {
  if (!r.turns) return n;
  const auto column = [&](int m) {
    return dot(n, wide3(r.turning[0][m], r.turning[1][m], r.turning[2][m]));
  };
  return n + Wide3{column(0), column(1), column(2)} * wide(r.dt);
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
