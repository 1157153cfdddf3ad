// Runs the stages of one cloth: consecutive row stages together as one wavefront (wavefront.h),
// whole stages between them by themselves. Without whole stages one wavefront runs through all the
// substeps of a frame; with them every substep is run to its end before the next begins. A substep may be run
// in two parts, with something else in between.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "physics/step/wavefront.h"

namespace weft::physics {

class Schedule {
 public:
  enum class Part { whole, first, second };

  // The stages outlive the passes. `row_bytes`: of one row of the lattice. `second`: the stage that the second
  // part begins with; none where substeps are never parted.
  Schedule(const Stages& stages, int rows, std::size_t row_bytes,
           std::optional<std::size_t> second = {});

  // Rows outside `awake` are passed over (empty: none). The `observer` keeps all rows as they are before
  // and looks at them after. Parts are those of a single substep.
  void run(const Substeps& substeps, Threads& threads, std::span<const RowSpan> awake = {},
           RowObserver* observer = nullptr, Part part = Part::whole);

  // Adds to nanoseconds[q] the time that stage q took.
  void profile(std::span<std::atomic<std::int64_t>> nanoseconds);
  bool profiled() const { return !profile_.empty(); }

  // About what a substep costs one thread [ns]: as it was the last time, at first by what stages touch.
  double cost(Part part) const { return costs_[std::size_t(part)].alone; }

  // Whether so many substeps of so many particles are work enough for several threads, that stand by or have to be
  // woken: of this cloth, or of several side by side that cost so much together, a thread each.
  bool worth_sharing(int particles, int substeps, bool standing_by, Part part) const;
  static bool worth_running_apart(double cost, int substeps, bool standing_by);

  // Whether one wavefront runs everything.
  bool rows_only() const { return whole_stages_ == 0 && second_ >= passes_.size(); }

 private:
  struct Pass {
    std::size_t first;            // stage
    WholeStage* whole = nullptr;  // or
    std::unique_ptr<Wavefront> wavefront;
    std::size_t count = 1;  // stages
  };
  // Of a substep [ns].
  struct Cost {
    double alone = 0;
    double shared = 0;  // as the threads took it last; 0: one thread ran it last
    // `threads` took so much.
    void took(double nanoseconds, int threads);
  };
  void prepare(double dt);
  void run_all(const Substeps& substeps, Threads& threads, std::span<const RowSpan> awake,
               RowObserver* observer, Part part);
  void run_substep(const Substeps& substeps, int s, Threads& threads,
                   std::span<const RowSpan> awake, Part part);

  const Stages& stages_;
  const int rows_;
  std::vector<Pass> passes_;
  std::size_t second_;              // pass that the second part begins with
  bool velocities_between_ = true;  // substeps
  std::size_t whole_stages_ = 0;
  double prepared_dt_ = 0;
  std::array<Cost, 3> costs_;  // by part
  std::span<std::atomic<std::int64_t>> profile_;
};

}  // namespace weft::physics
