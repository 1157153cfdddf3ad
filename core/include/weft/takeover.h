// An interrupt that a frame does not wait for.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace weft {

// A run stops between two frames. Where a frame is still going on kGrace after the signal, `end` is called
// on a thread of its own and ends the process; the simulation is not to be touched. The thread starts
// before those of the simulation, which take what is left of a limit on processes. Where it cannot be had,
// an interrupt waits for the frame.
inline constexpr std::chrono::seconds kGrace{2};

class Takeover {
 public:
  Takeover();
  ~Takeover();
  Takeover(const Takeover&) = delete;
  Takeover& operator=(const Takeover&) = delete;

  // From now on `end` ends the process; before, nothing is kept.
  void on_interrupt(std::function<void()> end);
  // What `end` works on may be changed while this is held, and only then.
  std::unique_lock<std::mutex> hold() { return std::unique_lock(mutex_); }
  // From now on `end` is not called.
  void stop();

 private:
  void wait();

  std::function<void()> end_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool over_ = false;
  std::thread thread_;
};

}  // namespace weft
