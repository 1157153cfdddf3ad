// Wall times (run_times.h).
#include "physics/frame/run_times.h"

namespace weft::physics {

void RunTimes::follow(const Cloths& cloths, bool profile) {
  if (stages_.size() != cloths.size()) stages_.resize(cloths.size());
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    Schedule& schedule = cloths[c]->schedule();
    const std::size_t count = cloths[c]->stages().size();
    if (stages_[c].size() == count && profile == schedule.profiled()) continue;
    stages_[c] = std::vector<std::atomic<std::int64_t>>(count);
    if (profile) schedule.profile(stages_[c]);
  }
}

void RunTimes::add_frame(std::int64_t number, std::chrono::nanoseconds spent) {
  const double ms = std::chrono::duration<double, std::milli>(spent).count();
  total_ += ms;
  if (frames_.size() < frames_.capacity())
    frames_.push_back(float(ms));
  else
    frames_[std::size_t(number) % frames_.size()] = float(ms);
}

}  // namespace weft::physics
