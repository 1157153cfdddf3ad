// Runs the stages of one cloth: consecutive row stages together as one wavefront (wavefront.h),
// whole stages between them by themselves. Without whole stages one wavefront runs through all the
// substeps of a frame; with them every substep is run to its end before the next begins.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "physics/step/wavefront.h"

namespace weft::physics {

class Schedule {
 public:
  // The stages outlive the passes. `row_bytes`: of one row of the lattice.
  Schedule(const Stages& stages, int rows, std::size_t row_bytes);

  // Rows outside `awake` are passed over (empty: none). The `record` keeps all rows as they are before
  // and looks at them after.
  void run(const Substeps& substeps, Threads& threads, std::span<const RowSpan> awake = {},
           RowObserver* observer = nullptr);

  // Adds to ticks[q] the time that stage q took.
  void profile(std::span<std::atomic<std::int64_t>> nanoseconds);
  bool profiled() const { return !profile_.empty(); }

  // Whether so many substeps of so many particles are work enough for several threads, that stand by
  // or have to be woken: of this cloth, or of several side by side, a thread each.
  bool worth_sharing(int particles, int substeps, bool standing_by) const;
  static bool worth_running_apart(std::int64_t particles, int substeps, bool standing_by);

  // Whether one wavefront runs everything.
  bool rows_only() const { return whole_stages_ == 0; }

 private:
  struct Pass {
    std::size_t first;            // stage
    WholeStage* whole = nullptr;  // or
    std::unique_ptr<Wavefront> wavefront;
    std::size_t count = 1;  // stages
  };
  void prepare(double dt);
  void run_substep(const Substeps& substeps, int s, Threads& threads,
                   std::span<const RowSpan> awake);

  const Stages& stages_;
  const int rows_;
  std::vector<Pass> passes_;
  bool velocities_between_ = true;  // substeps
  std::size_t whole_stages_ = 0;
  double prepared_dt_ = 0;
  std::span<std::atomic<std::int64_t>> profile_;
};

}  // namespace weft::physics
