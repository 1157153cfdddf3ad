// Which instruction set to run: the names, what this machine has, and the kernels built for it.
#include <initializer_list>

#include "physics/kernels/kernels.h"

namespace weft {

#define WEFT_EACH_SIMD(apply) apply(scalar) apply(sse2) apply(avx2) apply(avx512)

#define WEFT_DECLARE(simd)               \
  namespace kernels_##simd {             \
    const physics::KernelTable& table(); \
  }
WEFT_EACH_SIMD(WEFT_DECLARE)
#undef WEFT_DECLARE

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

const KernelTable& kernel_table(Simd simd) {
  switch (simd) {
#define WEFT_CASE(name) \
  case Simd::name:      \
    return kernels_##name::table();
    WEFT_EACH_SIMD(WEFT_CASE)
#undef WEFT_CASE
    case Simd::best:
      break;
  }
  for (Simd widest : {Simd::avx512, Simd::avx2})
    if (simd_available(widest)) return kernel_table(widest);
  return kernel_table(Simd::sse2);
}

}  // namespace physics
}  // namespace weft
