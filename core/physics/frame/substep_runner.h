// Who runs which cloth: the threads of a simulation, and how cloths are shared out to them.
#pragma once

#include <span>
#include <vector>

#include "physics/frame/cloth_step.h"
#include "physics/frame/rollback_buffer.h"
#include "physics/frame/sleeping.h"
#include "physics/step/threads.h"

namespace weft::physics {

class SubstepRunner {
 public:
  // `threads`: as of Threads; `cloths`: how many there are at most.
  SubstepRunner(int threads, std::size_t cloths);

  Threads& threads() { return threads_; }
  const Threads& threads() const { return threads_; }

  // Runs the stages of every cloth that is not all asleep. `sleeping`: or null; `observers`: of every cloth,
  // or none. A thread for each cloth where that keeps all of them busy; else cloths that are worth all
  // threads take them one after the other, and small ones run side by side.
  void run(const Cloths& cloths, const Substeps& substeps, const Sleeping* sleeping,
           std::span<RollbackBuffer> observers, Schedule::Part part = Schedule::Part::whole);

 private:
  bool worth_running_apart(const Cloths& cloths, int substeps, Schedule::Part part) const;
  bool keeps_busy(const Cloths& cloths, Schedule::Part part);

  Threads threads_;
  Threads one_thread_{1};           // for a cloth that one thread runs, whichever
  std::vector<std::size_t> apart_;  // cloths that take a thread each
  std::vector<double> busy_;        // of each thread, in a substep [ns]
};

}  // namespace weft::physics
