// Wide arithmetic: `Wide` is a vector of kLanes floats (16, 8, 4 or 1, as the build of each
// instruction set sets WEFT_LANES) with the plain operators + - * / of the compilers' vector
// extensions, and fma(a, b, c) = a b + c rounded once. A kernel written with it reads like its equation
// and gives the same bits at every width, because every operation here is exact per lane (IEEE 754, no
// estimates of the processor's own).
#pragma once

#include <cstdint>
#include <utility>

#include "physics/kernels/lanes.h"

namespace weft::WEFT_KERNELS {

// max and min give b where a or b is not a number.
// maskz: the plain forms trip a false warning of g++ 12 about uninitialised values.
#if WEFT_LANES == 16
WEFT_INLINE Wide max(Wide a, Wide b) {
  return (Wide)_mm512_maskz_max_ps(0xffff, (__m512)a, (__m512)b);
}
WEFT_INLINE Wide min(Wide a, Wide b) {
  return (Wide)_mm512_maskz_min_ps(0xffff, (__m512)a, (__m512)b);
}
WEFT_INLINE Wide sqrt(Wide v) {
  return (Wide)_mm512_maskz_sqrt_ps(0xffff, (__m512)v);
}
#elif WEFT_LANES == 8
WEFT_INLINE Wide max(Wide a, Wide b) {
  return (Wide)_mm256_max_ps((__m256)a, (__m256)b);
}
WEFT_INLINE Wide min(Wide a, Wide b) {
  return (Wide)_mm256_min_ps((__m256)a, (__m256)b);
}
WEFT_INLINE Wide sqrt(Wide v) {
  return (Wide)_mm256_sqrt_ps((__m256)v);
}
#elif WEFT_LANES == 4
WEFT_INLINE Wide max(Wide a, Wide b) {
  return (Wide)_mm_max_ps((__m128)a, (__m128)b);
}
WEFT_INLINE Wide min(Wide a, Wide b) {
  return (Wide)_mm_min_ps((__m128)a, (__m128)b);
}
WEFT_INLINE Wide sqrt(Wide v) {
  return (Wide)_mm_sqrt_ps((__m128)v);
}
#else
WEFT_INLINE Wide max(Wide a, Wide b) {
  return Wide{a[0] > b[0] ? a[0] : b[0]};
}
WEFT_INLINE Wide min(Wide a, Wide b) {
  return Wide{a[0] < b[0] ? a[0] : b[0]};
}
WEFT_INLINE Wide sqrt(Wide v) {
  return Wide{__builtin_sqrtf(v[0])};
}
#endif

// a b + c, c - a b and a b - c, each rounded once.
#if WEFT_LANES == 16
WEFT_INLINE Wide fma(Wide a, Wide b, Wide c) {
  return (Wide)_mm512_fmadd_ps((__m512)a, (__m512)b, (__m512)c);
}
WEFT_INLINE Wide fnma(Wide a, Wide b, Wide c) {
  return (Wide)_mm512_fnmadd_ps((__m512)a, (__m512)b, (__m512)c);
}
WEFT_INLINE Wide fms(Wide a, Wide b, Wide c) {
  return (Wide)_mm512_fmsub_ps((__m512)a, (__m512)b, (__m512)c);
}
#elif WEFT_LANES == 8
WEFT_INLINE Wide fma(Wide a, Wide b, Wide c) {
  return (Wide)_mm256_fmadd_ps((__m256)a, (__m256)b, (__m256)c);
}
WEFT_INLINE Wide fnma(Wide a, Wide b, Wide c) {
  return (Wide)_mm256_fnmadd_ps((__m256)a, (__m256)b, (__m256)c);
}
WEFT_INLINE Wide fms(Wide a, Wide b, Wide c) {
  return (Wide)_mm256_fmsub_ps((__m256)a, (__m256)b, (__m256)c);
}
#else
// Where no instruction does it: the product of two floats is exact in double precision. Its sum with the
// third is rounded there and once more to single precision, which is as rounding once but where the first
// result lies just between two floats, or below their normal range. There the sum is rounded to odd first
// (Boldo, Melquiond 2008, "Emulation of FMA and correctly rounded sums: proved algorithms using rounding
// to odd").
template <class Double, class Long>
Double sum_to_odd(Double a, Double b) {
  const Double sum = a + b, rest = sum - a;
  const Double error = (a - (sum - rest)) + (b - rest);
  const Long up = error > 0.0, down = error < 0.0;
  const Long even = ((Long)sum & 1) - 1;
  const Long farther =
      ((up ^ (sum < 0.0)) & 2) - 1;  // 1 where the odd neighbour is farther from zero
  return (Double)((Long)sum + ((up | down) & even & farther));
}

// kernels.cmake says where it is a call.
#ifdef WEFT_FMA_IS_CALLED
#define WEFT_FMA [[gnu::noinline]] inline
#else
#define WEFT_FMA WEFT_INLINE
#endif

#if WEFT_LANES == 4

WEFT_INLINE __m128d lower(Wide v) {
  return _mm_cvtps_pd((__m128)v);
}
WEFT_INLINE __m128d upper(Wide v) {
  return _mm_cvtps_pd(_mm_movehl_ps((__m128)v, (__m128)v));
}
WEFT_INLINE Wide single(__m128d low, __m128d high) {
  return (Wide)_mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
}

// Seldom called: by itself, compilers need half as long for all that multiplies.
[[gnu::noinline, gnu::cold]] inline Wide fma_to_odd(Wide a, Wide b, Wide c) {
  const auto sum = [](__m128d one, __m128d two, __m128d third) {
    return sum_to_odd<__m128d, __m128i>(one * two, third);
  };
  return single(sum(lower(a), lower(b), lower(c)), sum(upper(a), upper(b), upper(c)));
}

WEFT_FMA Wide fma(Wide a, Wide b, Wide c) {
  const __m128d sum[] = {lower(a) * lower(b) + lower(c), upper(a) * upper(b) + upper(c)};
  const __m128 halves[] = {_mm_castpd_ps(sum[0]), _mm_castpd_ps(sum[1])};
  const WideInt low = (WideInt)_mm_shuffle_ps(halves[0], halves[1], 0x88) & 0x1fffffff;
  const WideInt high = (WideInt)_mm_shuffle_ps(halves[0], halves[1], 0xdd) & 0x7fffffff;
  if (_mm_movemask_epi8((__m128i)((low == 0x10000000) | ((high > 0) & (high < 0x38100000)))))
      [[unlikely]]
    return fma_to_odd(a, b, c);
  return single(sum[0], sum[1]);
}

#else

typedef double One __attribute__((vector_size(8)));
typedef std::int64_t OneLong __attribute__((vector_size(8)));

[[gnu::noinline, gnu::cold]] inline float fma_to_odd(float a, float b, float c) {
  return float(sum_to_odd<One, OneLong>(One{double(a) * double(b)}, One{double(c)})[0]);
}

WEFT_FMA Wide fma(Wide a, Wide b, Wide c) {
  const One sum = One{double(a[0]) * double(b[0])} + One{double(c[0])};
  const std::int64_t bits = ((OneLong)sum)[0], size = bits >> 32 & 0x7fffffff;
  if ((bits & 0x1fffffff) == 0x10000000 || (size > 0 && size < 0x38100000)) [[unlikely]]
    return Wide{fma_to_odd(a[0], b[0], c[0])};
  return Wide{float(sum[0])};
}

#endif

WEFT_INLINE Wide fnma(Wide a, Wide b, Wide c) {
  return fma(-a, b, c);
}
WEFT_INLINE Wide fms(Wide a, Wide b, Wide c) {
  return fma(a, b, -c);
}
#endif

WEFT_INLINE Wide abs(Wide v) {
  return max(v, -v);
}

// The lanes N further on, from the last to the first.
template <int N, int... I>
WEFT_INLINE Wide turned(Wide v, std::integer_sequence<int, I...>) {
  return __builtin_shufflevector(v, v, ((I + N) % kLanes)...);
}

// The least and the greatest lane: exact, so the order does not matter.
template <int N = kLanes / 2>
WEFT_INLINE float least(Wide v) {
  if constexpr (N == 0)
    return v[0];
  else
    return least<N / 2>(min(v, turned<N>(v, std::make_integer_sequence<int, kLanes>{})));
}
WEFT_INLINE float greatest(Wide v) {
  return -least(-v);
}

// Rounded towards zero; what lies beyond ±2³⁰, or is not a number, becomes one of the two.
WEFT_INLINE WideInt whole(Wide v) {
  constexpr float kMost = 1 << 30;
  return __builtin_convertvector(max(min(v, wide(kMost)), wide(-kMost)), WideInt);
}

WEFT_INLINE WideInt lane_numbers() {
  WideInt r{};
  for (int i = 0; i < kLanes; ++i) r[i] = i;
  return r;
}

// Whole numbers or masks in memory.
WEFT_INLINE WideInt lanes_at(const std::int32_t* p) {
  return *reinterpret_cast<const WideIntLoose*>(p);
}

WEFT_INLINE void put_lanes(std::int32_t* p, WideInt v) {
  *reinterpret_cast<WideIntLoose*>(p) = v;
}

// All ones in the lanes whose number is below `count`.
WEFT_INLINE WideInt lanes_below(int count) {
  return lane_numbers() < count;
}

// The lanes N earlier along a row: Delay<N> d; then d.next(block) for successive blocks returns
// block shifted by N lanes, the first N coming from the block before (zeros at the row's start).
template <int N>
class Delay {
 public:
  WEFT_INLINE Wide next(Wide block) {
    if constexpr (N < kLanes) {
#if WEFT_LANES == 16
      const Wide r =
          (Wide)_mm512_maskz_alignr_epi32(0xffff, (__m512i)block, (__m512i)before_[0], kLanes - N);
#else
      const Wide r = align(before_[0], block, std::make_integer_sequence<int, kLanes>{});
#endif
      before_[0] = block;
      return r;
    } else {
      const Wide r = before_[N - 1];
      for (int i = N - 1; i > 0; --i) before_[i] = before_[i - 1];
      before_[0] = block;
      return r;
    }
  }

 private:
  template <int... I>
  WEFT_INLINE static Wide align(Wide a, Wide b, std::integer_sequence<int, I...>) {
    return __builtin_shufflevector(a, b, (I + kLanes - N)...);
  }
  static_assert(N < kLanes || kLanes == 1);
  Wide before_[N < kLanes ? 1 : N]{};
};

// Whether any lane of a mask is set.
WEFT_INLINE bool any(WideInt mask) {
#if WEFT_LANES == 16
  return _mm512_movepi32_mask((__m512i)mask) != 0;
#elif WEFT_LANES == 8
  return _mm256_movemask_ps((__m256)mask) != 0;
#elif WEFT_LANES == 4
  return _mm_movemask_ps((__m128)mask) != 0;
#else
  return mask[0] != 0;
#endif
}

// Some of the lanes, as bits, lane 0 lowest.
typedef std::uint32_t LaneBits;

WEFT_INLINE LaneBits bits(WideInt mask) {
#if WEFT_LANES == 16
  return _mm512_movepi32_mask((__m512i)mask);
#elif WEFT_LANES == 8
  return unsigned(_mm256_movemask_ps((__m256)mask));
#elif WEFT_LANES == 4
  return unsigned(_mm_movemask_ps((__m128)mask));
#else
  return mask[0] != 0;
#endif
}

#if WEFT_LANES == 8
// For each mask of eight lanes, the numbers of those that are set, a byte each.
struct SetLanes {
  std::uint64_t numbers[256] = {};
  constexpr SetLanes() {
    for (unsigned mask = 0; mask < 256; ++mask)
      for (unsigned lane = 0, at = 0; lane < 8; ++lane)
        if (mask >> lane & 1) numbers[mask] |= std::uint64_t(lane) << 8 * at++;
  }
};
inline constexpr SetLanes kSetLanes;
#endif

WEFT_INLINE LaneBits first_lanes(int count) {
  return count < kLanes ? (1u << count) - 1 : (1u << kLanes) - 1;
}
// Where a is less than b. (Directly: compilers make a mask of the comparison first.)
WEFT_INLINE LaneBits where_less(Wide a, Wide b) {
#if WEFT_LANES == 16
  return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
#else
  return bits(a < b);
#endif
}

// Where a whole number lies from low to high.
WEFT_INLINE LaneBits where_within(WideInt v, std::int32_t low, std::int32_t high) {
#if WEFT_LANES == 16
  return _mm512_cmple_epu32_mask((__m512i)(v - low), _mm512_set1_epi32(high - low));
#else
  return bits((v >= low) & (v <= high));
#endif
}

// Some lanes next to each other in memory; the lanes after those may be overwritten, whole groups of
// them. Returns how many.
template <class Lane, class V>
WEFT_INLINE int store_lanes(Lane* p, LaneBits which, V v) {
#if WEFT_LANES == 16
  _mm512_storeu_si512(p, _mm512_maskz_compress_epi32(__mmask16(which), (__m512i)v));
  return __builtin_popcount(which);
#elif WEFT_LANES == 8
  const __m128i bytes = _mm_cvtsi64_si128(std::int64_t(kSetLanes.numbers[which]));
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(p),
                      _mm256_permutevar8x32_epi32((__m256i)v, _mm256_cvtepu8_epi32(bytes)));
  return __builtin_popcount(which);
#else
  int count = 0;
  for (LaneBits set = which; set != 0; set &= set - 1) p[count++] = v[__builtin_ctz(set)];
  return count;
#endif
}

struct Wide3 {
  Wide x, y, z;
};

WEFT_INLINE Wide3 wide3(float x, float y, float z) {
  return {wide(x), wide(y), wide(z)};
}
WEFT_INLINE Wide3 operator+(Wide3 a, Wide3 b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
// +0 in the place of -0.
WEFT_INLINE Wide3 positive_zeros(Wide3 v) {
  return v + wide3(0, 0, 0);
}
WEFT_INLINE Wide3 operator-(Wide3 a, Wide3 b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
WEFT_INLINE Wide3 operator*(Wide3 a, Wide s) {
  return {a.x * s, a.y * s, a.z * s};
}
WEFT_INLINE Wide3 fma(Wide3 a, Wide s, Wide3 c) {
  return {fma(a.x, s, c.x), fma(a.y, s, c.y), fma(a.z, s, c.z)};
}
WEFT_INLINE Wide3 fnma(Wide3 a, Wide s, Wide3 c) {
  return {fnma(a.x, s, c.x), fnma(a.y, s, c.y), fnma(a.z, s, c.z)};
}
WEFT_INLINE Wide3 fms(Wide3 a, Wide s, Wide3 c) {
  return {fms(a.x, s, c.x), fms(a.y, s, c.y), fms(a.z, s, c.z)};
}
WEFT_INLINE Wide dot(Wide3 a, Wide3 b) {
  return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x));
}
WEFT_INLINE Wide3 select(WideInt m, Wide3 a, Wide3 b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

WEFT_INLINE Wide3 cross(Wide3 a, Wide3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <int N>
class Delay3 {
 public:
  WEFT_INLINE Wide3 next(Wide3 b) { return {x_.next(b.x), y_.next(b.y), z_.next(b.z)}; }

 private:
  Delay<N> x_, y_, z_;
};

}  // namespace weft::WEFT_KERNELS
