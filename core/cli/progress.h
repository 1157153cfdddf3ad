// The lines that tell a person at a terminal how a run is getting on, and what came of it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "weft/report.h"

namespace weft::cli {

// Prints one line a second while standard output is a terminal, else nothing.
class Progress {
 public:
  // `frame_seconds`: simulated time per frame.
  Progress(std::int64_t frames, double frame_seconds);
  // To be called after every frame with the number of frames done.
  void update(std::int64_t done);

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  std::int64_t frames_;
  double frame_seconds_;
  Clock::time_point start_, last_;
  std::int64_t done_at_last_ = 0;
};

// The summary after a run: `notes` of its plan, and the files that were `written`.
std::string summary(const Report& report, const std::vector<std::string>& notes,
                    const std::vector<std::string>& written);

}  // namespace weft::cli
