// Judges frames (step_guard.h).
#include "physics/frame/step_guard.h"

#include <algorithm>

namespace weft::physics {
namespace {

// Squared lengths of constraints in those at rest: stretched; noticed where that doubled within the
// frame; kept up where it lasts.
constexpr float kStretched = 1.25f * 1.25f, kNoticed = 1.01f * 1.01f, kLasting = 1.02f * 1.02f;

// Whether something was so fast at the frame's start that it leaves all bounds by any method.
bool flies_away(const FrameRun& run) {
  return std::any_of(run.starts.begin(), run.starts.end(), [&](const RollbackBuffer& start) {
    const float fastest = start.v().greatest(run.cloths.front()->parts().kernels);
    return !(fastest * run.scene.time.frame < kFarAway);
  });
}

}  // namespace

Verdict StepGuard::judge(const FrameRun& run) {
  if (run.sleeping && run.sleeping->all_asleep()) return Verdict::accept;
  const double start = double(run.frame) * run.scene.time.frame;
  for (const auto& step : run.cloths)
    energy_.drive(
        fastest_follower(*step, start, start + run.scene.time.frame) +
        fastest_turning(run.scene, step->particles(), start, start + run.scene.time.frame));
  if (run.finite) energy_.look(run.energy, run.driven);
  const bool springs = is_explicit(run.method);
  const bool lines = !springs && run.scene.solver.sweep == Sweep::line;
  const bool beyond_limit = run.finite && springs && run.dt > run.limit;
  const bool finest = finer_ == kFinest || run.dt < 2 * kLeastSubstep;
  bool failed = !run.finite || beyond_limit || !energy_.holds();
  if (!failed && lines) failed = (!finest && overshot(run)) || keeps_on(run);
  if (!failed)
    return run.scene.time.substeps == kAutoSubsteps && limits_.asks_again(run.cloths, run.sleeping)
               ? Verdict::refine_for_limits
               : Verdict::accept;
  const bool unresolved = beyond_limit && kLimitShare * run.limit < kLeastSubstep;
  const bool hopeless = unresolved || (!beyond_limit && finest);
  if (!(springs || lines) || (hopeless && flies_away(run))) {
    if (!run.finite) return Verdict::stop;
    if (!energy_.holds()) return Verdict::clamp;
    return beyond_limit ? Verdict::unstable : Verdict::accept;
  }
  (since_interaction_ < kInteractionPasses ? failed_by_interaction_ : failed_by_itself_) = true;
  if (hopeless) return Verdict::change_method;
  if (beyond_limit) return Verdict::refine_to_limit;
  finer_ *= 2;
  return Verdict::refine;
}

void StepGuard::pass(double seconds) {
  since_interaction_ = std::min(since_interaction_ + seconds, kInteractionPasses);
}

bool StepGuard::interaction_has_passed(const Scene& scene, const Cloths& cloths, bool driven,
                                       const EnergyGuard& beginning) const {
  if (!failed_by_interaction_ || failed_by_itself_ || since_interaction_ < kInteractionPasses)
    return false;
  EnergyGuard guard = beginning;
  guard.look(scene, cloths, driven);
  return guard.holds();
}

void StepGuard::begin_anew() {
  finer_ = 1;
  limits_.begin_anew();
  upkeep_.restart();
  failed_by_interaction_ = failed_by_itself_ = false;
  since_interaction_ = kInteractionPasses;
}

// Whether line sweeps stretched a sheet by what gravity and pins on paths, where they alone do work,
// cannot have put into this frame. A line is solved by one Newton step a substep, which overshoots
// where much happens in one, as when a straight line is pressed together from its ends.
bool StepGuard::overshot(const FrameRun& run) const {
  if (!run.alone) return false;
  const double start = double(run.frame) * run.scene.time.frame;
  for (std::size_t c = 0; c < run.cloths.size(); ++c) {
    if (is_asleep(run.sleeping, c)) continue;
    const ClothStep& step = *run.cloths[c];
    const float most = step.model().greatest_stretch(step.particles().x);
    if (!(most > kNoticed)) continue;
    const float at_start = step.model().greatest_stretch(run.starts[c].x());
    const bool doubled = most - 1 > 2 * (at_start - 1);
    if (most <= at_start || !(most > kStretched || doubled)) continue;
    if (gained(run.scene, step, run.starts[c].x(), run.starts[c].v(), run.dt, start,
               start + run.scene.time.frame, run.threads))
      return true;
  }
  return false;
}

// Whether line sweeps keep stretched sheets moving that drag should have slowed down.
bool StepGuard::keeps_on(const FrameRun& run) {
  const double start = double(run.frame) * run.scene.time.frame;
  const Cloths& cloths = run.cloths;
  bool stretched = false;
  if (run.alone && !works(run.scene, start, start + run.scene.time.frame))
    for (std::size_t c = 0; c < cloths.size(); ++c)
      stretched |= cloths[c]->cloth().drag > 0 && !is_asleep(run.sleeping, c) &&
                   cloths[c]->model().greatest_stretch(cloths[c]->particles().x) > kLasting;
  Balance all;
  for (std::size_t c = 0; c < cloths.size() && stretched; ++c) {
    const Balance one = balance(run.scene, *cloths[c], run.dt, run.threads);
    all.inner += one.inner;
    all.potential += one.potential;
    all.lost += one.lost;
  }
  if (stretched && !upkeep_.kept_up(all)) return false;
  upkeep_.restart();
  return stretched;
}

}  // namespace weft::physics
