// The one verdict on a frame that has run: it stands, it is run again with more substeps or by another
// method, or its energy is cut back.
//
// A frame is at fault where springs are stretched beyond what its substep allows, where springs or line
// sweeps hold more energy than was put in (energy_guard.h), where line sweeps stretch a sheet that
// nothing pulls at, or where strain limits do not hold (limit_guard.h). Simulation::State carries the verdict out.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "physics/frame/energy_guard.h"
#include "physics/frame/limit_guard.h"
#include "physics/frame/rollback_buffer.h"
#include "physics/frame/sleeping.h"
#include "physics/frame/time_step.h"

namespace weft::physics {

inline constexpr int kFinest = 16;               // times the substeps that are due, to save a frame
inline constexpr float kFarAway = 1e7f;          // m; nothing in a sane scene gets there
inline constexpr double kInteractionPasses = 1;  // s; what a person did has passed by then

// A frame that has run, as it is judged.
struct FrameRun {
  const Scene& scene;
  Method method;
  const Cloths& cloths;
  Threads& threads;
  std::span<const RollbackBuffer> starts;  // each cloth as it was at the frame's start
  const Sleeping* sleeping;                // or null
  std::int64_t frame;                      // frames before it
  double dt;                               // s
  bool finite;                             // all positions and velocities
  EnergySum energy;                        // of all cloths at its end, where that is finite
  double limit;                            // s; the stability limit at its end (springs)
  bool driven;                             // something but gravity did work in it
  bool alone;                              // nothing but gravity and paths of pins can do work
};

enum class Verdict {
  accept,
  refine_to_limit,    // run again within the stability limit
  refine,             // run again with twice the substeps
  refine_for_limits,  // the same, so that strain limits hold
  change_method,      // run again by a method that loses energy
  unstable,  // stands, though its substeps are longer than is stable, and none can be short enough
  clamp,     // velocities are reduced to what is left without the excess
  stop,      // not finite, and no substep helps
};

class StepGuard {
 public:
  // What is put in from outside counts there.
  EnergyGuard& energy() { return energy_; }
  LimitGuard& limits() { return limits_; }

  // Judges a frame; after one that is to be run again the next call judges it anew. Every frame that
  // failed but for the stability limit makes those after it finer.
  Verdict judge(const FrameRun& run);
  // How many times the substeps that are due frames take.
  int finer() const { return finer_ * limits_.finer(); }

  // A person did something, or goes on doing so; so much time has passed without.
  void interacted() { since_interaction_ = 0; }
  void pass(double seconds);
  // Whether all that failed was of a person's doing and has passed, so that the run may go on as it
  // began, when `beginning` was the guard of its energy.
  bool interaction_has_passed(const Scene& scene, const Cloths& cloths, bool driven,
                              const EnergyGuard& beginning) const;
  // Nothing has failed yet.
  void begin_anew();

 private:
  bool overshot(const FrameRun& run) const;
  bool keeps_on(const FrameRun& run);

  EnergyGuard energy_;
  LimitGuard limits_;
  Upkeep upkeep_;
  int finer_ = 1;
  // Frames that failed soon after a person did something say little of the frames to come.
  double since_interaction_ = kInteractionPasses;  // s, at most that
  bool failed_by_interaction_ = false, failed_by_itself_ = false;
};

}  // namespace weft::physics
