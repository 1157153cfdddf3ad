// The lanes of wide arithmetic (wide.h): its types, in a namespace of its own for each instruction set, so that the
// linker can never mix code built for different ones; in and out of memory, and choosing lane by lane.
#pragma once

#include <cstdint>
#include <utility>

#if WEFT_LANES > 1
#include <immintrin.h>
#endif

#define WEFT_JOIN_(a, b) a##b
#define WEFT_JOIN(a, b) WEFT_JOIN_(a, b)
#define WEFT_KERNELS WEFT_JOIN(kernels_, WEFT_SIMD)

#define WEFT_INLINE inline __attribute__((always_inline))

namespace weft::WEFT_KERNELS {

inline constexpr int kLanes = WEFT_LANES;

typedef float Wide __attribute__((vector_size(4 * kLanes)));
typedef std::int32_t WideInt __attribute__((vector_size(4 * kLanes)));
typedef Wide WideLoose __attribute__((aligned(4), may_alias));
typedef WideInt WideIntLoose __attribute__((aligned(4), may_alias));

WEFT_INLINE Wide load(const float* p) {
  return *reinterpret_cast<const WideLoose*>(p);
}
WEFT_INLINE void store(float* p, Wide v) {
  *reinterpret_cast<WideLoose*>(p) = v;
}
// (Wide{} + s would be an addition: -0 + 0 is not -0.)
template <int... I>
WEFT_INLINE Wide wide(float s, std::integer_sequence<int, I...>) {
  return Wide{(void(I), s)...};
}
WEFT_INLINE Wide wide(float s) {
  return wide(s, std::make_integer_sequence<int, kLanes>{});
}

// Where a mask is set (all bits), a; elsewhere b. With one lane by plain numbers: g++ 12 computes
// conditions of one-lane vectors wrongly at -O2 (it takes a signed 0/-1 for a truth value of one bit).
template <class Lanes>
WEFT_INLINE Lanes select_lanes(WideInt mask, Lanes a, Lanes b) {
#if WEFT_LANES == 1
  return Lanes{mask[0] != 0 ? a[0] : b[0]};
#else
  return mask ? a : b;
#endif
}
WEFT_INLINE Wide select(WideInt mask, Wide a, Wide b) {
  return select_lanes(mask, a, b);
}
WEFT_INLINE WideInt select(WideInt mask, WideInt a, WideInt b) {
  return select_lanes(mask, a, b);
}

}  // namespace weft::WEFT_KERNELS
