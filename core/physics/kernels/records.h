// Records of four floats, scattered in memory, as four wide values: loaded whole and turned.
#pragma once

#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

// One of the four of kLanes records.
struct Wide4 {
  Wide3 xyz;
  Wide last;
};

#if WEFT_LANES >= 4
typedef float Four __attribute__((vector_size(16), may_alias));
typedef Four FourLoose __attribute__((aligned(4), may_alias));

WEFT_INLINE void turn(const float* records, int stride, const std::int32_t* number,
                      Four (&out)[4]) {
  const auto at = [&](int l) -> Four {
    return *reinterpret_cast<const FourLoose*>(records + std::ptrdiff_t(stride) * number[l]);
  };
  const Four a = at(0), b = at(1), c = at(2), d = at(3);
  const Four ab = __builtin_shufflevector(a, b, 0, 4, 1, 5),
             cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Four ef = __builtin_shufflevector(a, b, 2, 6, 3, 7),
             gh = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  out[0] = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  out[1] = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  out[2] = __builtin_shufflevector(ef, gh, 0, 1, 4, 5);
  out[3] = __builtin_shufflevector(ef, gh, 2, 3, 6, 7);
}
#endif

// Record k has its four floats at records + stride * number[k].
WEFT_INLINE Wide4 records_at(const float* records, int stride, const std::int32_t* number) {
#if WEFT_LANES >= 4
  Four q[kLanes / 4][4];
  for (int l = 0; l < kLanes / 4; ++l) turn(records, stride, number + 4 * l, q[l]);
  const auto together = [&](int k) {
#if WEFT_LANES == 4
    return (Wide)q[0][k];
#else
    typedef float Eight __attribute__((vector_size(32)));
    const Eight low = __builtin_shufflevector(q[0][k], q[1][k], 0, 1, 2, 3, 4, 5, 6, 7);
#if WEFT_LANES == 8
    return (Wide)low;
#else
    const Eight high = __builtin_shufflevector(q[2][k], q[3][k], 0, 1, 2, 3, 4, 5, 6, 7);
    return (Wide)__builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13,
                                         14, 15);
#endif
#endif
  };
  return {{together(0), together(1), together(2)}, together(3)};
#else
  const float* r = records + std::ptrdiff_t(stride) * *number;
  return {wide3(r[0], r[1], r[2]), wide(r[3])};
#endif
}

}  // namespace weft::WEFT_KERNELS
