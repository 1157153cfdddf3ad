// Measures the machine (limits.h): the fastest of many short repetitions.
#include "limits.h"

#include <immintrin.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

template <class Work>
double fastest_ns(int repetitions, Work&& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int n = 0; n < repetitions; ++n) {
    const auto start = Clock::now();
    work();
    best = std::min(best, std::chrono::duration<double, std::nano>(Clock::now() - start).count());
  }
  return best;
}

// Eight independent chains hide the latency of both operations.
constexpr int kChains = 8, kRounds = 2000;

#define WEFT_RATE(name, isa, wide, set1, one)                       \
  __attribute__((target(isa))) float name() {                       \
    wide v[kChains];                                                \
    for (int c = 0; c < kChains; ++c) v[c] = set1(1.5f + float(c)); \
    for (int n = 0; n < kRounds; ++n)                               \
      for (int c = 0; c < kChains; ++c) v[c] = one;                 \
    float sum = 0;                                                  \
    for (int c = 0; c < kChains; ++c) sum += v[c][0];               \
    return sum;                                                     \
  }

typedef float One __attribute__((vector_size(4)));
inline One one_set(float s) {
  return One{s};
}

WEFT_RATE(rate_scalar, "sse2", One, one_set, (One{2.5f / __builtin_sqrtf(v[c][0])}))
WEFT_RATE(rate_sse2, "sse2", __m128, _mm_set1_ps, _mm_div_ps(_mm_set1_ps(2.5f), _mm_sqrt_ps(v[c])))
WEFT_RATE(rate_avx2, "avx2", __m256, _mm256_set1_ps,
          _mm256_div_ps(_mm256_set1_ps(2.5f), _mm256_sqrt_ps(v[c])))
WEFT_RATE(rate_avx512, "avx512f", __m512, _mm512_set1_ps,
          _mm512_div_ps(_mm512_set1_ps(2.5f), _mm512_maskz_sqrt_ps(0xffff, v[c])))
#undef WEFT_RATE

double rate_ns(float (*rate)(), int lanes) {
  volatile float sink = 0;
  return fastest_ns(400, [&] { sink = rate(); }) / (double(kRounds) * kChains * lanes);
}

__attribute__((target_clones("avx512f", "avx2", "default"))) void triad(std::size_t n, float s,
                                                                        const float* __restrict b,
                                                                        const float* __restrict c,
                                                                        float* __restrict a) {
  for (std::size_t i = 0; i < n; ++i) a[i] = b[i] + s * c[i];
}

double triad_gigabytes(std::size_t bytes) {
  const std::size_t n = bytes / (3 * sizeof(float));
  std::vector<float> a(n), b(n, 1.0f), c(n, 2.0f);
  const std::size_t passes = std::max<std::size_t>(1, (1u << 20) / bytes);
  const int repetitions = bytes > (8u << 20) ? 8 : 100;
  const double ns = fastest_ns(repetitions, [&] {
    for (std::size_t p = 0; p < passes; ++p) triad(n, float(p), b.data(), c.data(), a.data());
  });
  return double(passes * n) * 12 / ns;
}

Limits measure() {
  Limits l;
  struct Size {
    const char* name;
    std::size_t kilobytes;
  };
  for (const Size& s : {Size{"L1", 24}, Size{"L2", 512}, Size{"L3", 8192}, Size{"memory", 196608}})
    l.triad.push_back({s.name, triad_gigabytes(s.kilobytes * 1024)});
  l.sqrt_div_ns[0] = rate_ns(rate_scalar, 1);
  l.sqrt_div_ns[1] = rate_ns(rate_sse2, 4);
  if (weft::simd_available(weft::Simd::avx2)) l.sqrt_div_ns[2] = rate_ns(rate_avx2, 8);
  if (weft::simd_available(weft::Simd::avx512)) l.sqrt_div_ns[3] = rate_ns(rate_avx512, 16);
  return l;
}

}  // namespace

double Limits::sqrt_div(weft::Simd simd) const {
  return sqrt_div_ns[std::size_t(simd)];
}

double Limits::yardstick_ns(weft::Simd simd, double constraints, double bytes) const {
  return std::max(constraints * sqrt_div(simd), bytes / triad[1].gigabytes);
}

const Limits& limits() {
  static const Limits measured = measure();
  return measured;
}

}  // namespace bench
