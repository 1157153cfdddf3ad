// The threads that a simulation may use: a oneTBB arena of fixed size.
#pragma once

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "physics/step/task_record.h"

namespace weft::physics {

// Waits for another thread: a little at a time, and before long such that others get the core.
class Patience {
 public:
  void wait();

 private:
  static constexpr int kBusyWaits = 100;  // a few microseconds
  int waits_ = 0;
};

class Threads {
 public:
  // `count` threads in all, the caller's included; 0 = one per core. Fewer where the system gives
  // fewer.
  explicit Threads(int count);
  int count() const { return count_; }
  int asked() const { return asked_; }
  // Of the calling thread within share(), 0 … count()-1.
  static int index() { return oneapi::tbb::this_task_arena::current_thread_index(); }

  // Calls work() with the other threads standing by until it returns: share() within it reaches them
  // in about a microsecond, where oneTBB may have to wake them. It must not wait for tasks of oneTBB.
  // Within it, together() does nothing more.
  template <class Work>
  void together(Work&& work) {
    if (count_ == 1 || together_) return work();
    arena_.execute([&] {
      const Together together(*this);
      work();
    });
  }

  bool standing_by() const { return together_; }

  // From here on the calling thread runs all tasks alone, cut as for count() threads, and `record` is told of them.
  // Null: threads run them again. Not to be called within together() and share().
  void record(TaskRecord* record) { record_ = record; }
  TaskRecord* record() const { return record_; }
  // How many run at once.
  int running() const { return record_ ? 1 : count_; }

  // work(0) … work(tasks - 1), in any order; `alone`: on this thread, because they are short. Shares
  // do not share out again, and do not throw.
  template <class Work>
  void share(std::size_t tasks, bool alone, Work&& work) {
    if (alone || count_ == 1) {
      for (std::size_t k = 0; k < tasks; ++k) work(k);
      return;
    }
    if (!together_) {
      arena_.execute([&] {
        if (record_) return run_recorded(tasks, work);
        oneapi::tbb::parallel_for(std::size_t(0), tasks, work);
      });
      return;
    }
    if (record_) return run_recorded(tasks, work);
    for (std::size_t first = 0; first < tasks; first += kMostShares) {
      const auto some = [&](int n) { work(first + std::size_t(n)); };
      share_out(int(std::min(tasks - first, kMostShares)), &some,
                [](const void* w, int n) { (*static_cast<const decltype(some)*>(w))(n); });
    }
  }

 private:
  using Call = void (*)(const void* work, int n);
  static constexpr std::size_t kMostShares = 1 << 15;

  struct Pile;
  struct Together {
    explicit Together(Threads& of) : threads(of) {
      threads.over_.store(false, std::memory_order_release);
      threads.together_ = true;
      if (threads.record_) threads.record_->gather();
      for (int n = 1; n < threads.running(); ++n) helpers.run([this] { threads.help(); });
    }
    ~Together() {
      threads.together_ = false;
      if (threads.record_) threads.record_->leave();
      threads.over_.store(true, std::memory_order_release);
      helpers.wait();
    }
    Together(const Together&) = delete;
    Together& operator=(const Together&) = delete;

    Threads& threads;
    oneapi::tbb::task_group helpers;
  };
  template <class Work>
  void run_recorded(std::size_t tasks, const Work& work) {
    record_->open();
    for (std::size_t k = 0; k < tasks; ++k) {
      record_->begin(int(k));
      work(k);
      record_->end();
    }
    record_->close();
  }
  void share_out(int shares, const void* work, Call call);
  bool take(Pile& pile);
  bool take_any();
  void help();

  int asked_, count_;
  // oneTBB keeps to one worker per core unless told otherwise.
  std::unique_ptr<oneapi::tbb::global_control> allowed_;
  oneapi::tbb::task_arena arena_;

  // The shares of a round that are meant for one thread: the number of the round, and which are not
  // yet taken, in one word, so that whoever takes a share takes it of the round that is there.
  struct alignas(64) Pile {
    std::atomic<std::uint64_t> left = 0;
  };

  TaskRecord* record_ = nullptr;
  bool together_ = false;
  std::uint64_t round_ = 0;
  std::unique_ptr<Pile[]> piles_;
  const void* work_ = nullptr;
  Call call_ = nullptr;
  alignas(64) std::atomic<int> done_ = 0;  // shares of this round
  alignas(64) std::atomic<bool> over_ = false;
};

}  // namespace weft::physics
