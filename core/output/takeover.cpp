// The thread that waits for a signal.
#include "weft/takeover.h"

#include <cstdlib>
#include <system_error>

#include "weft/interrupt.h"

namespace weft {

Takeover::Takeover() : end_([] { std::_Exit(128 + interrupted()); }) {
  try {
    thread_ = std::thread([this] { wait(); });
  } catch (const std::system_error&) {
  }
}

Takeover::~Takeover() {
  stop();
  if (thread_.joinable()) thread_.join();
}

void Takeover::on_interrupt(std::function<void()> end) {
  const auto lock = hold();
  end_ = std::move(end);
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

}  // namespace weft
