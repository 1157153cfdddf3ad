// The threads that a simulation may use: a oneTBB arena of fixed size.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/task_arena.h>

#include <memory>

namespace weft::physics {

class Threads {
 public:
  // `count` threads in all, the caller's included; 0 = one per core.
  explicit Threads(int count);
  int count() const { return count_; }

  template <class Work>
  void run(Work&& work) {
    arena_.execute(std::forward<Work>(work));
  }

 private:
  int count_;
  // oneTBB keeps to one worker per core unless told otherwise.
  std::unique_ptr<oneapi::tbb::global_control> allowed_;
  oneapi::tbb::task_arena arena_;
};

}  // namespace weft::physics
