// One frame of a scene, run again and again from the same state: its time on threads that there are, and its tasks
// as more of them would get them.
#pragma once

#include <memory>

#include "task_graph.h"
#include "weft/scene.h"
#include "weft/simulation.h"

namespace bench {

class RecordedFrame {
 public:
  // The frame after next, once `first` of them have been run.
  RecordedFrame(const weft::Scene& scene, int first);
  ~RecordedFrame();

  int substeps() const { return substeps_; }
  // The fastest time on one thread and on so many [ns], measured in turns, `repeats` times.
  struct Times {
    double one = 0, several = 0;
  };
  Times measure(int threads, int repeats);
  TaskGraph record(int threads, int repeats);

 private:
  weft::Scene scene_;
  weft::Snapshot before_;
  int substeps_ = 0;
};

}  // namespace bench
