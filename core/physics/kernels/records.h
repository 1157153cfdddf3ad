// Records of four floats in memory as four wide values, and back: moved whole, and turned.
#pragma once

#include <utility>

#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

typedef float Four __attribute__((vector_size(16), may_alias));
typedef Four FourLoose __attribute__((aligned(4), may_alias));

// One of the four of kLanes records.
struct Wide4 {
  Wide3 xyz;
  Wide last;
};

WEFT_INLINE Four four_at(const float* p) {
  return *reinterpret_cast<const FourLoose*>(p);
}

#if WEFT_LANES >= 4
// In every quarter of four lanes: those of a (0 … 3) and b (4 … 7) that are asked for.
template <int A, int B, int C, int D, int... I>
WEFT_INLINE Wide quarters(Wide a, Wide b, std::integer_sequence<int, I...>) {
  constexpr int lane[] = {A, B, C, D};
  return __builtin_shufflevector(a, b, (lane[I % 4] % 4 + I / 4 * 4 + lane[I % 4] / 4 * kLanes)...);
}

// Every quarter of four values as rows of a square, turned.
WEFT_INLINE void turn(Wide (&r)[4]) {
  constexpr auto lanes = std::make_integer_sequence<int, kLanes>{};
  const Wide a = quarters<0, 4, 1, 5>(r[0], r[1], lanes),
             b = quarters<0, 4, 1, 5>(r[2], r[3], lanes);
  const Wide c = quarters<2, 6, 3, 7>(r[0], r[1], lanes),
             d = quarters<2, 6, 3, 7>(r[2], r[3], lanes);
  r[0] = quarters<0, 1, 4, 5>(a, b, lanes);
  r[1] = quarters<2, 3, 6, 7>(a, b, lanes);
  r[2] = quarters<0, 1, 4, 5>(c, d, lanes);
  r[3] = quarters<2, 3, 6, 7>(c, d, lanes);
}
#endif

// Record k has its four floats at records + stride * number[k].
WEFT_INLINE Wide4 records_at(const float* records, int stride, const std::int32_t* number) {
#if WEFT_LANES >= 4
  const auto at = [&](int k) { return four_at(records + std::ptrdiff_t(stride) * number[k]); };
  Wide r[4];
  for (int k = 0; k < 4; ++k) {
#if WEFT_LANES == 4
    r[k] = (Wide)at(k);
#else
    typedef float Eight __attribute__((vector_size(32)));
    const auto eight = [&](int first) -> Eight {
      return __builtin_shufflevector(at(first), at(first + 4), 0, 1, 2, 3, 4, 5, 6, 7);
    };
#if WEFT_LANES == 8
    r[k] = (Wide)eight(k);
#else
    r[k] = (Wide)__builtin_shufflevector(eight(k), eight(k + 8), 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10,
                                         11, 12, 13, 14, 15);
#endif
#endif
  }
  turn(r);
  return {{r[0], r[1], r[2]}, r[3]};
#else
  const float* r = records + std::ptrdiff_t(stride) * *number;
  return {wide3(r[0], r[1], r[2]), wide(r[3])};
#endif
}

// Record k goes to records + stride * k.
WEFT_INLINE void put_records(float* records, [[maybe_unused]] int stride, Wide4 v) {
#if WEFT_LANES >= 4
  Wide r[4] = {v.xyz.x, v.xyz.y, v.xyz.z, v.last};
  turn(r);
  const auto put = [&](auto quarter) {
    constexpr int l = 4 * decltype(quarter)::value;
    for (int k = 0; k < 4; ++k)
      *reinterpret_cast<FourLoose*>(records + std::ptrdiff_t(stride) * (l + k)) =
          (Four)__builtin_shufflevector(r[k], r[k], l, l + 1, l + 2, l + 3);
  };
  const auto put_all = [&]<int... Q>(std::integer_sequence<int, Q...>) {
    (put(std::integral_constant<int, Q>{}), ...);
  };
  put_all(std::make_integer_sequence<int, kLanes / 4>{});
#else
  *reinterpret_cast<FourLoose*>(records) = Four{v.xyz.x[0], v.xyz.y[0], v.xyz.z[0], v.last[0]};
#endif
}

}  // namespace weft::WEFT_KERNELS
