// The thread that waits for a signal.
#include "takeover.h"

#include <chrono>

#include "output/interrupt.h"

namespace weft::cli {

namespace {

constexpr std::chrono::seconds kGrace{2};

}  // namespace

Takeover::Takeover(std::function<void()> end) : end_(std::move(end)), thread_([this] { wait(); }) {}

Takeover::~Takeover() {
  stop();
  thread_.join();
}

void Takeover::stop() {
  {
    const auto lock = hold();
    over_ = true;
  }
  wake_.notify_one();
  wake_waiting();
}

void Takeover::wait() {
  wait_for_interrupt();
  std::unique_lock lock(mutex_);
  if (!wake_.wait_for(lock, kGrace, [this] { return over_; })) end_();
}

}  // namespace weft::cli
