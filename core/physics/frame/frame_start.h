// What a frame goes back to when it has to be run again.
#pragma once

#include <span>
#include <vector>

#include "physics/frame/rollback_buffer.h"
#include "physics/frame/sleeping.h"
#include "physics/frame/time_step.h"

namespace weft::physics {

class FrameStart {
 public:
  // Watches these cloths, which live longer, in place of those before.
  void watch(const Cloths& cloths, const Vec3& gravity, const KernelTable& kernels);

  // Keeps time step and tears; and, where `all_rows`, the rows of cloths that are not all asleep: else
  // those who run them keep rows as they come to them.
  void save(const Cloths& cloths, const Sleeping* sleeping, const TimeStep& step, bool all_rows);
  // Puts all that back.
  void restore(const Cloths& cloths, const Sleeping* sleeping, TimeStep& step, double frame);

  std::span<RollbackBuffer> rows() { return rows_; }
  std::span<const RollbackBuffer> rows() const { return rows_; }
  std::size_t bytes() const;

 private:
  std::vector<RollbackBuffer> rows_;  // of every cloth
  int substeps_ = 1;
  double lag_ = 0;
};

}  // namespace weft::physics
