// Values of places that lie anywhere, one for each lane.
#pragma once

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

WEFT_INLINE Wide gathered(const float* from, const std::int32_t* at) {
  alignas(64) float values[kLanes];
  for (int l = 0; l < kLanes; ++l) values[l] = from[at[l]];
  return load(values);
}
WEFT_INLINE Wide3 gathered(ConstRow3 from, const std::int32_t* at) {
  return {gathered(from.x, at), gathered(from.y, at), gathered(from.z, at)};
}

}  // namespace weft::WEFT_KERNELS
