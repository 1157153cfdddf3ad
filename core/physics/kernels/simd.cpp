// Which instruction set to run: the names, what this machine has, and the kernels built for it.
#include <cstdlib>
#include <initializer_list>

#include "physics/kernels/kernels.h"

namespace weft {

// WEFT_SETS: WEFT_SET(name) for each set that this build has kernels for (kernels.cmake).
#define WEFT_SET(name)                   \
  namespace kernels_##name {             \
    const physics::KernelTable& table(); \
  }
WEFT_SETS
#undef WEFT_SET

namespace {

bool built(Simd simd) {
#define WEFT_SET(name) \
  if (simd == Simd::name) return true;
  WEFT_SETS
#undef WEFT_SET
  return simd == Simd::best;
}

}  // namespace

const char* simd_name(Simd simd) {
  switch (simd) {
    case Simd::scalar:
      return "scalar";
    case Simd::sse2:
      return "sse2";
    case Simd::avx2:
      return "avx2";
    case Simd::avx512:
      return "avx512";
    case Simd::best:
      break;
  }
  return "best";
}

bool simd_available(Simd simd) {
  if (!built(simd)) return false;
  switch (simd) {
    case Simd::avx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    case Simd::avx512:
      return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
             __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    default:
      return true;
  }
}

namespace physics {

Simd resolved(Simd simd) {
  if (simd != Simd::best) return simd;
  for (const Simd widest : {Simd::avx512, Simd::avx2, Simd::sse2})
    if (simd_available(widest)) return widest;
  return Simd::scalar;
}

const KernelTable& kernel_table(Simd simd) {
  switch (resolved(simd)) {
#define WEFT_SET(name) \
  case Simd::name:     \
    return kernels_##name::table();
    WEFT_SETS
#undef WEFT_SET
    default:
      std::abort();  // simd_available() has said so
  }
}

}  // namespace physics
}  // namespace weft
