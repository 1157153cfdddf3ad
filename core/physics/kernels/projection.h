// What the projection kernels share: where the ends of constraints lie, and their moves.
//
// Sweeps gather the corrections u in arrays of their own and see positions x + u: a velocity must gain
// just what the sweeps have moved a particle by, and the difference of rounded positions over a small dt
// is not that. Rounded at every constraint, positions would lose momentum that ends give each other. Strain
// limits move positions and velocities themselves.
#pragma once

#include <cstddef>

#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

// What differs between the sweeps, so that each kernel holds just its own.
enum class Rule { rigid, compliant, multipliers, limit, carry, hold, settle };
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

WEFT_INLINE Wide3 position(const ProjectedRow& r, std::ptrdiff_t i) {
  return load_planes(r.x + i, r.plane);
}
// With the corrections so far.
WEFT_INLINE Wide3 corrected(const ProjectedRow& r, std::ptrdiff_t i) {
  return position(r, i) + load_planes(r.u + i, r.plane);
}

WEFT_INLINE void gather(const ProjectedRow& r, std::ptrdiff_t i, Wide3 change) {
  store_planes(r.u + i, r.plane, load_planes(r.u + i, r.plane) + change);
}

// Constraints a … of row j that are not torn.
WEFT_INLINE WideInt alive_lanes(const ProjectRows& p, int j, int a) {
  return lanes_at(p.alive + std::ptrdiff_t(j) * p.stride + a);
}

}  // namespace weft::WEFT_KERNELS
