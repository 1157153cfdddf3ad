// An interrupt that a frame does not wait for.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace weft::cli {

// A run stops between two frames. Where a frame is still going on two seconds after the signal,
// `end` is called on a thread of its own and ends the process; the simulation is not to be touched.
class Takeover {
 public:
  explicit Takeover(std::function<void()> end);
  ~Takeover();
  Takeover(const Takeover&) = delete;
  Takeover& operator=(const Takeover&) = delete;

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

}  // namespace weft::cli
