// How long a frame's tasks take on so many workers: a greedy list schedule (Graham 1966), in which whoever is idle
// takes the task that has been ready for longest, and whoever ends a task goes on with the first that it has made
// ready, as the wavefront does. Tasks that come from memory share its bandwidth.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "task_graph.h"

namespace bench {

// The machine that is foretold.
struct Host {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  int workers = 1;
  double start_ns = 0;                     // to take a task and to tell that it is done
  double signal_ns = 0;                    // until another worker that stands by sees it
  double wake_ns = 0;                      // until one that sleeps does
  double handover_ns = 0;                  // for a byte that another worker has written last
  double cache_bytes = kNone;              // of what rows keep, of all workers together
  double core_rate = kNone, rate = kNone;  // bytes a ns from memory: of one worker, of all
};

// What a stage takes, all substeps together.
struct StageTime {
  std::string stage;
  double work_ns = 0;     // of its tasks,
  double alone_ns = 0;    // and of those that one thread runs while the others wait
  double elapsed_ns = 0;  // on this host
};

struct Forecast {
  double ns = 0;
  double memory_bytes = 0;        // that rows bring from memory
  std::vector<StageTime> stages;  // in the order in which they come first
};

Forecast foretell(const TaskGraph& graph, const Host& host);

}  // namespace bench
