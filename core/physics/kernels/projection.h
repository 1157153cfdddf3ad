// What the projection kernels share: where the ends of constraints lie, and their moves.
//
// The sweeps of method `positional` move the positions themselves. Those of `compliant` gather the
// corrections u in arrays of their own and see positions x + u: a velocity must gain just what the
// sweeps have moved a particle by, and the difference of rounded positions over a small dt is not
// that. `Displaced` tells the two apart.
#pragma once

#include <cstddef>

#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

// What differs between the sweeps, so that each kernel holds just its own.
enum class Rule { rigid, compliant, multipliers, limit, carry, hold, settle };
constexpr bool displaced(Rule r) {
  return r == Rule::compliant || r == Rule::multipliers;
}
// The rules of the strain limit (lattice.h, LimitSweep).
constexpr bool limits(Rule r) {
  return r >= Rule::limit;
}

struct ProjectedRow {
  float *x, *u;          // first component
  std::ptrdiff_t plane;  // floats from one component to the next
  const float* w;
};

// Lane a of the result is an end of constraint a.
WEFT_INLINE ProjectedRow projected_row(const ProjectRows& p, int j, int first) {
  const std::ptrdiff_t at = std::ptrdiff_t(j) * p.stride + first;
  return {p.x.x + at, p.u.x ? p.u.x + at : nullptr, p.x.y - p.x.x, p.w + at};
}

template <bool Displaced>
WEFT_INLINE Wide3 position(const ProjectedRow& r, std::ptrdiff_t i) {
  if constexpr (Displaced) return load_planes(r.x + i, r.plane) + load_planes(r.u + i, r.plane);
  return load_planes(r.x + i, r.plane);
}

// What the sweeps change.
template <bool Displaced>
WEFT_INLINE float* movable(const ProjectedRow& r) {
  return Displaced ? r.u : r.x;
}

template <bool Displaced>
WEFT_INLINE void shift(const ProjectedRow& r, std::ptrdiff_t i, Wide3 change) {
  float* const at = movable<Displaced>(r) + i;
  store_planes(at, r.plane, load_planes(at, r.plane) + change);
}

// Constraints a … of row j that are not torn.
WEFT_INLINE WideInt alive_lanes(const ProjectRows& p, int j, int a) {
  return lanes_at(p.alive + std::ptrdiff_t(j) * p.stride + a);
}

}  // namespace weft::WEFT_KERNELS
