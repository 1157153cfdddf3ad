// The last values of what is plotted.
#pragma once

#include <array>
#include <map>
#include <string>

#include "run/telemetry.h"
#include "window/figures.h"

namespace weft::viewer {

// A ring of the last values.
class Series {
 public:
  static constexpr int kLength = 240;
  void add(float value);
  void clear() { count_ = 0; }
  const float* data() const { return values_.data(); }
  int count() const { return std::min(count_, kLength); }
  int start() const { return count_ > kLength ? count_ % kLength : 0; }
  float last() const { return count_ > 0 ? values_[std::size_t((count_ - 1) % kLength)] : 0; }
  float greatest() const;
  float least() const;

 private:
  std::array<float, kLength> values_{};
  int count_ = 0;
};

class History {
 public:
  // Once a turn of the window.
  void add(const Telemetry& telemetry, std::uint64_t scene_serial, const Turn& turn);

  Series window_ms, surface_ms, panel_ms, frame_ms, kinetic, elastic, total, strain_max,
      strain_mean;
  std::map<std::string, Series> stages;  // ms a frame
  double turns_per_second = 60;

 private:
  double smoothed_ms_ = 16;
  std::int64_t frames_ = 0, measured_ = 0;
  std::map<std::string, StageTime> before_;
  std::int64_t frames_before_ = 0;
  std::uint64_t serial_ = 0;
};

}  // namespace weft::viewer
