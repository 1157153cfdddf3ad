// What it costs this machine to share work out: measured here and now, on two of its cores.
#pragma once

#include "list_schedule.h"

namespace bench {

struct SharingCosts {
  double start_ns = 0;   // a share that does nothing
  double signal_ns = 0;  // from one thread to another that stands by
  double wake_ns = 0;    // to one that sleeps
  double handover_ns =
      0;  // a byte that the other thread has written, beyond one from the third level
  double core_rate = 0;    // bytes a ns that one core reads and writes in memory,
  double all_rate = 0;     // and all cores of this machine together
  double cache_bytes = 0;  // of the last level
  int cores = 0;
};

SharingCosts measure_sharing_costs();

}  // namespace bench
