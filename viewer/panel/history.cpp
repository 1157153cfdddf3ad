// Values over time.
#include "panel/history.h"

#include <algorithm>

namespace weft::viewer {

void Series::add(float value) {
  values_[std::size_t(count_ % kLength)] = value;
  ++count_;
  if (count_ >= 3 * kLength) count_ -= kLength;
}

float Series::greatest() const {
  return count() > 0 ? *std::max_element(values_.begin(), values_.begin() + count()) : 0;
}

float Series::least() const {
  return count() > 0 ? *std::min_element(values_.begin(), values_.begin() + count()) : 0;
}

void History::add(const Telemetry& telemetry, std::uint64_t scene_serial, const Turn& turn) {
  window_ms.add(static_cast<float>(turn.all_ms));
  panel_ms.add(static_cast<float>(turn.panel_ms));
  if (turn.surface_ms > 0) surface_ms.add(static_cast<float>(turn.surface_ms));
  smoothed_ms_ += 0.1 * (turn.all_ms - smoothed_ms_);
  turns_per_second = 1000 / std::max(smoothed_ms_, 1.0);
  if (telemetry.frames != frames_) frame_ms.add(static_cast<float>(telemetry.frame_ms));
  frames_ = telemetry.frames;
  if (telemetry.measured == measured_) return;
  measured_ = telemetry.measured;
  const Report& r = telemetry.report;
  if (serial_ != scene_serial || r.frames < frames_before_) {
    serial_ = scene_serial;
    before_.clear();
    stages.clear();
    frames_before_ = 0;
    if (r.frames == 0)
      for (Series* s : {&kinetic, &elastic, &total, &strain_max, &strain_mean}) s->clear();
  }
  kinetic.add(static_cast<float>(r.energy.kinetic));
  elastic.add(static_cast<float>(r.energy.elastic));
  total.add(static_cast<float>(r.energy.total));
  strain_max.add(static_cast<float>(100 * r.strain.max));
  strain_mean.add(static_cast<float>(100 * r.strain.mean));
  if (r.frames == frames_before_) return;
  const auto frames = static_cast<double>(r.frames - frames_before_);
  for (const StageTime& stage : r.stages) {
    const double ms = std::max(0.0, stage.ms - before_[stage.name].ms);
    stages[stage.name].add(static_cast<float>(ms / frames));
    before_[stage.name] = stage;
  }
  frames_before_ = r.frames;
}

}  // namespace weft::viewer
