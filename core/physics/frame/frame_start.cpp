// Keeping and putting back (frame_start.h).
#include "physics/frame/frame_start.h"

namespace weft::physics {

void FrameStart::watch(const Cloths& cloths, const Vec3& gravity, const KernelTable& kernels) {
  rows_.clear();
  for (const auto& step : cloths) rows_.emplace_back(step->particles(), gravity, kernels);
}

void FrameStart::save(const Cloths& cloths, const Sleeping* sleeping, const TimeStep& step,
                      bool all_rows) {
  substeps_ = step.substeps;
  lag_ = step.lag;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (is_asleep(sleeping, c)) continue;
    if (all_rows) rows_[c].keep();
    if (Tearing* tearing = cloths[c]->model().tearing()) tearing->remember();
  }
}

void FrameStart::restore(const Cloths& cloths, const Sleeping* sleeping, TimeStep& step,
                         double frame) {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (is_asleep(sleeping, c)) continue;
    rows_[c].restore();
    if (Tearing* tearing = cloths[c]->model().tearing()) tearing->go_back();
  }
  step.take(substeps_, frame);
  step.lag = lag_;
}

std::size_t FrameStart::bytes() const {
  std::size_t bytes = 0;
  for (const RollbackBuffer& rows : rows_) bytes += rows.bytes();
  return bytes;
}

}  // namespace weft::physics
