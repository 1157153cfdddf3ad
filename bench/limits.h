// What this machine can do at most, measured here and now, so that every figure can be told as a
// multiple of a yardstick instead of in nanoseconds of some processor.
#pragma once

#include <string>
#include <vector>

#include "weft/simulation.h"

namespace bench {

struct Limits {
  struct Level {
    std::string name;      // "L2"
    double gigabytes = 0;  // per second: a[i] = b[i] + s c[i], 12 bytes an element
  };
  std::vector<Level> triad;  // from the first level of the cache to memory, one thread

  // ns for one square root and one division a lane, at the rate of independent vectors: what the
  // length of a constraint takes by the processor's own instructions.
  double sqrt_div(weft::Simd simd) const;
  double sqrt_div_ns[4] = {};  // scalar, sse2, avx2, avx512; 0 = not on this machine

  // ns for `constraints` lengths by those, or for `bytes` of second-level traffic, whichever is longer.
  double yardstick_ns(weft::Simd simd, double constraints, double bytes) const;
};

const Limits& limits();

}  // namespace bench
