// The processor time of the calling thread, which other programs do not lengthen.
#pragma once

#include <time.h>

namespace weft::viewer {

inline double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace weft::viewer
