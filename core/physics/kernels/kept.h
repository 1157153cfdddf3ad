// A place or a velocity, and what rounding has left of its steps: in fine substeps that goes into the next
// (second_order.cpp).
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

}  // namespace weft::WEFT_KERNELS
