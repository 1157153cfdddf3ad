// How a run goes through time: by which method, in how many substeps a frame, and what limits them.
#pragma once

#include <span>
#include <vector>

#include "physics/frame/cloth_step.h"
#include "physics/model/spectrum.h"

namespace weft::physics {

// A frame takes no more for the flat sheet; stretch may ask for 1.4 times as many.
inline constexpr int kMostSubsteps = 100000;
// s; below, single precision loses speeds of cm/s. The second is for substeps that stretch has made shorter.
inline constexpr double kLeastSubstep = 1e-6, kLeastStretched = 2.5e-7;
inline constexpr double kLimitShare = 0.85;  // of the stability limit, in automatic substeps

// How many substeps frames take as what they need changes. Leapfrog keeps an energy that depends on the substep: every
// change makes what vibrates near the stability limit grow by some per cent on average, and changes to and fro would
// heat a cloth without end. So fewer are taken only where they would have done for a while, and that gets twice as long
// each time.
class FollowedSubsteps {
 public:
  // The frame that ended at a time [s] needed so many; `hand`: while a hand acts, and when it has let go, frames take
  // what they need. Returns how many the next one takes.
  int next(int needed, double time, bool hand);
  // Frames have so many from a time on [s].
  void take(int substeps, double time);

 private:
  static constexpr double kCalm = 1;  // s
  double since_ = 0, calm_ = kCalm;   // s
  int most_ = 0;                      // needed since then
  int now_ = 0;
  bool hand_ = false;  // acted in the frame before
};

struct TimeStep {
  Method method;     // the scene's, or the stable one put in its place
  int substeps = 1;  // a frame
  double dt = 0;     // s
  // s; by which velocities lie behind the positions: half a substep with explicit springs and the first
  // order of methods that project, whose first substep takes them half of it ahead (step/stage.h).
  double lag = 0;
  FollowedSubsteps followed = {};  // explicit
  double limit = 0;                // s; the stability limit at the end of the last frame (explicit)
  std::vector<Spectrum> spectra;   // of every cloth as it starts (explicit)

  void take(int count, double frame) {
    substeps = count;
    dt = frame / count;
  }
  double lag_between_substeps(int order) const {
    return is_explicit(method) || order == 1 ? dt / 2 : 0;
  }
  // `count` substeps from number `first` on of a frame that begins at `start` [s].
  Substeps substeps_from(double start, int first, int count) const {
    return {start + first * dt, dt, count, first == 0 ? lag + dt / 2 : dt};
  }
};

// The largest stable substep of all cloths as they start [s]; `safe`: also where cloth that resists no
// pressing folds.
struct StableSubsteps {
  double largest, safe;
};
StableSubsteps stable_substeps(const Cloths& cloths, std::span<const Spectrum> spectra);

// The same as the cloths lie now, by how far they are stretched; `grabbed`: while a hand pulls at one.
double stretched_limit(const Cloths& cloths, std::span<const Spectrum> spectra, bool grabbed);

// Substeps a frame that stay inside a limit [s]: a share of it where they are automatic, else as many as
// asked for or, where those are too few, a multiple; and `finer` times that. Not so many that they are shorter
// than kLeastStretched for the limit's sake: no substep resolves what asks for that.
int substeps_within(double limit, const Time& time, int finer);

// Substeps a frame of methods that project.
int projection_substeps(const Scene& scene);

}  // namespace weft::physics
