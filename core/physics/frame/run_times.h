// How long a run takes: wall time of its frames and, where asked for, of its stages.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <vector>

#include "physics/frame/cloth_step.h"

namespace weft::physics {

class RunTimes {
 public:
  // `frames`: room for the times of so many; a longer run keeps those of its last.
  explicit RunTimes(std::size_t frames) { frames_.reserve(frames); }

  // Measures the stages of these cloths, if asked for. Those of a cloth that are others than before begin
  // anew.
  void follow(const Cloths& cloths, bool profile);
  // Frame `number`, from 1 on, took so long.
  void add_frame(std::int64_t number, std::chrono::nanoseconds spent);

  const std::vector<float>& frames() const { return frames_; }  // ms
  double total() const { return total_; }                       // ms
  double stage(std::size_t cloth, std::size_t stage) const {    // ms
    return double(stages_[cloth][stage].load()) * 1e-6;
  }

 private:
  std::vector<float> frames_;
  double total_ = 0;
  std::deque<std::vector<std::atomic<std::int64_t>>> stages_;  // of every cloth [ns]
};

}  // namespace weft::physics
