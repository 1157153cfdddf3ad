// A place or a velocity, and what rounding has left of its steps. In fine substeps positions move by a few units in the
// last place only: what rounding leaves of a step goes into the next (Kahan 1965, compensated summation). Else what
// moves at one speed would lose the same share of every step, and what creeps to rest would stop before it.
#pragma once

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

struct Kept {
  Wide3 value, left{};
  // By a step and what was left of those before.
  template <bool kFine>
  WEFT_INLINE void move(Wide3 step) {
    const Wide3 by = kFine ? step + left : step, to = value + by;
    if constexpr (kFine) left = by - (to - value);
    value = to;
  }
};

template <bool kFine>
WEFT_INLINE Kept kept_at(ConstRow3 row, ConstRow3 left, std::ptrdiff_t i) {
  return {positive_zeros(load3(row, i)), kFine ? load3(left, i) : Wide3{}};
}

// What stands still was stopped by a body, which has put it back where it was: nothing is left of its way, or it would
// creep.
WEFT_INLINE void drop_where_at_rest(Kept& x, const Kept& v) {
  x.left.x = select(v.value.x == 0.0f, Wide{}, x.left.x);
  x.left.y = select(v.value.y == 0.0f, Wide{}, x.left.y);
  x.left.z = select(v.value.z == 0.0f, Wide{}, x.left.z);
}

template <bool kFine>
WEFT_INLINE void store_kept(Row3 x, Row3 v, const physics::Left& left, std::ptrdiff_t i,
                            const Kept& place, const Kept& velocity) {
  store3(x, i, place.value);
  store3(v, i, velocity.value);
  if constexpr (!kFine) return;
  store3(left.x, i, place.left);
  store3(left.v, i, velocity.left);
}

}  // namespace weft::WEFT_KERNELS
