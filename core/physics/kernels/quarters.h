// Wide values as quarters of four lanes: taken apart, put together, and turned as tiles of 4 by 4.
#pragma once

#include <utility>

#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

typedef float Four __attribute__((vector_size(16), may_alias));
typedef Four FourLoose __attribute__((aligned(4), may_alias));

WEFT_INLINE Four load_four(const float* p) {
  return *reinterpret_cast<const FourLoose*>(p);
}
WEFT_INLINE void store_four(float* p, Four v) {
  *reinterpret_cast<FourLoose*>(p) = v;
}

// In every quarter: the lanes of a (0 … 3) and b (4 … 7) that are asked for.
template <int A, int B, int C, int D, class V, int... I>
WEFT_INLINE V pick(V a, V b, std::integer_sequence<int, I...>) {
  constexpr int lane[] = {A, B, C, D}, lanes = sizeof...(I);
  return __builtin_shufflevector(a, b, (lane[I % 4] % 4 + I / 4 * 4 + lane[I % 4] / 4 * lanes)...);
}

// The quarters of four values as rows of tiles, each tile turned: its rows become its columns.
template <class V>
WEFT_INLINE void turn(V (&r)[4]) {
  constexpr std::make_integer_sequence<int, sizeof(V) / sizeof(float)> lanes;
  const V a = pick<0, 4, 1, 5>(r[0], r[1], lanes), b = pick<0, 4, 1, 5>(r[2], r[3], lanes);
  const V c = pick<2, 6, 3, 7>(r[0], r[1], lanes), d = pick<2, 6, 3, 7>(r[2], r[3], lanes);
  r[0] = pick<0, 1, 4, 5>(a, b, lanes);
  r[1] = pick<2, 3, 6, 7>(a, b, lanes);
  r[2] = pick<0, 1, 4, 5>(c, d, lanes);
  r[3] = pick<2, 3, 6, 7>(c, d, lanes);
}

#if WEFT_LANES >= 4
// at(0), at(4) … at(kLanes - 4) side by side. (By the instructions' names: of plain shuffles the
// compiler makes half as many again.)
template <class At>
WEFT_INLINE Wide join_quarters(At&& at) {
#if WEFT_LANES == 4
  return (Wide)at(0);
#else
  const auto eight = [&](int lane) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256((__m128)at(lane)), (__m128)at(lane + 4), 1);
  };
#if WEFT_LANES == 8
  return (Wide)eight(0);
#else
  return (Wide)_mm512_insertf32x8(_mm512_castps256_ps512(eight(0)), eight(8), 1);
#endif
#endif
}

// visit(first lane, the quarter) of each.
template <class Visit>
WEFT_INLINE void for_each_quarter(Wide v, Visit&& visit) {
  const auto one = [&](auto quarter) {
    constexpr int l = 4 * decltype(quarter)::value;
    visit(l, (Four)__builtin_shufflevector(v, v, l, l + 1, l + 2, l + 3));
  };
  [&]<int... Q>(std::integer_sequence<int, Q...>) {
    (one(std::integral_constant<int, Q>{}), ...);
  }
  (std::make_integer_sequence<int, kLanes / 4>{});
}
#endif

}  // namespace weft::WEFT_KERNELS
