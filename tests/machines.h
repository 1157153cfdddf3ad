// Numbers of threads and instruction sets on which one scene has one result.
#pragma once

#include <utility>
#include <vector>

#include "cases.h"
#include "weft/simulation.h"

namespace weft {

// Those that this machine runs, all with seed 1.
inline std::vector<Options> machines() {
  std::vector<std::pair<int, Simd>> asked{
      {1, Simd::best}, {3, Simd::scalar}, {8, Simd::sse2}, {2, Simd::avx2}};
  if (whole_sweeps())
    asked.insert(asked.end(), {{1, Simd::scalar}, {3, Simd::best}, {8, Simd::best}});
  std::vector<Options> all;
  for (const auto& [threads, simd] : asked)
    if (simd_available(simd)) all.push_back({threads, simd, 1, false});
  return all;
}

// One that is not scalar, and that every build has one of.
inline Simd wide_simd() {
  return simd_available(Simd::sse2) ? Simd::sse2 : Simd::avx2;
}

}  // namespace weft
