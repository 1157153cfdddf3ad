// The fixed-step clock: arithmetic on times that are passed in.
#include "weft/clock.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace weft {

namespace {
// Rounding in `now` must not make a display of exactly one step per frame alternate between none
// and two: a shortfall below this share of a step is none.
constexpr double kRounding = 1e-6;
}  // namespace

FixedStepClock::FixedStepClock(double step, int max_catch_up)
    : step_(step), max_catch_up_(max_catch_up) {
  if (!(std::isfinite(step) && step > 0)) {
    throw std::invalid_argument("the step of a clock is a finite time above 0");
  }
  if (max_catch_up < 1) throw std::invalid_argument("a clock catches up by at least 1 step");
}

int FixedStepClock::advance(double now) {
  lag_ = 0;
  const bool first = !std::exchange(started_, started_ || std::isfinite(now));
  double passed = 0;
  if (std::isfinite(now)) {
    if (!first) passed = std::max(0.0, now - last_);
    last_ = now;
  }
  if (paused_) {
    const int due = std::min(singles_, max_catch_up_);
    singles_ -= due;
    steps_ += due;
    return due;
  }
  behind_ += passed * speed_;
  if (behind_ <= step_ * kRounding) return 0;
  const double wanted = std::ceil(behind_ / step_ - kRounding);
  const int due = static_cast<int>(std::min(wanted, static_cast<double>(max_catch_up_)));
  behind_ -= due * step_;
  if (wanted > max_catch_up_) {
    lag_ = behind_;
    dropped_ += lag_;
    behind_ = 0;
  }
  steps_ += due;
  return due;
}

void FixedStepClock::single_step() {
  paused_ = true;
  ++singles_;
}

void FixedStepClock::set_speed(double speed) {
  if (!(std::isfinite(speed) && speed >= 0)) {
    throw std::invalid_argument("the speed of a clock is finite and not below 0");
  }
  speed_ = speed;
}

double FixedStepClock::time() const {
  return static_cast<double>(steps_) * step_;
}

double FixedStepClock::blend() const {
  return std::clamp(1 + behind_ / step_, 0.0, 1.0);
}

}  // namespace weft
