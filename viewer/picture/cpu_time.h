// Processor time, which other programs do not lengthen.
#pragma once

#include <time.h>

namespace weft::viewer {

// Of the calling thread, or, by CLOCK_PROCESS_CPUTIME_ID, of all threads together.
inline double cpu_ms(clockid_t clock = CLOCK_THREAD_CPUTIME_ID) {
  timespec now{};
  clock_gettime(clock, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

}  // namespace weft::viewer
