// Numbers of threads and instruction sets on which one scene has one result.
#pragma once

#include <vector>

#include "weft/simulation.h"

namespace weft {

// Those that this machine runs, all with seed 1.
inline std::vector<Options> machines() {
  std::vector<Options> all;
  for (const auto& [threads, simd] : {std::pair{1, Simd::best}, std::pair{3, Simd::scalar},
                                      std::pair{8, Simd::sse2}, std::pair{2, Simd::avx2}})
    if (simd_available(simd)) all.push_back({threads, simd, 1, false});
  return all;
}

}  // namespace weft
