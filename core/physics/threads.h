// The threads that a simulation may use: a oneTBB arena of fixed size.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <cstddef>
#include <memory>
#include <utility>

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

  // work(0) … work(tasks - 1), in any order; `alone`: on this thread, because they are short.
  template <class Work>
  void share(std::size_t tasks, bool alone, Work&& work) {
    if (alone || count_ == 1) {
      for (std::size_t k = 0; k < tasks; ++k) work(k);
      return;
    }
    arena_.execute([&] { oneapi::tbb::parallel_for(std::size_t(0), tasks, work); });
  }

 private:
  int count_;
  // oneTBB keeps to one worker per core unless told otherwise.
  std::unique_ptr<oneapi::tbb::global_control> allowed_;
  oneapi::tbb::task_arena arena_;
};

}  // namespace weft::physics
