// Substeps from stability limits (time_step.h).
#include "physics/frame/time_step.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "physics/frame/projection_substep.h"
#include "physics/frame/step_guard.h"
#include "physics/model/clamp_to_int.h"

namespace weft::physics {
namespace {

constexpr double kGrabbed = 1.6;  // on ω², at least: room for what a hand may do in a frame

// What folds onto a line that stretches nothing has up to twice the flat sheet's ω², and no stretch adds
// to that (a sheet without shear springs, or with nothing else); and up to twice its damping along springs.
constexpr double kFolded = 2;

// What is stretched a little more needs no other change.
int with_room(int substeps) {
  constexpr int kRoom = 6;
  return substeps + substeps / kRoom;
}

}  // namespace

int FollowedSubsteps::next(int needed, double time, bool hand) {
  const auto begin = [&] { since_ = time, most_ = 0; };
  if (hand || std::exchange(hand_, hand)) {
    hand_ = hand;
    begin();
    calm_ = kCalm;
    return now_ = needed;
  }
  if (needed > now_) {
    begin();
    return now_ = with_room(needed);
  }
  most_ = std::max(most_, needed);
  if (time >= since_ && time - since_ < calm_) return now_;
  const int fewer = most_;
  begin();
  if (with_room(with_room(fewer)) >= now_) return now_;  // not worth a change
  calm_ *= 2;
  return now_ = fewer;
}

void FollowedSubsteps::take(int substeps, double time) {
  now_ = substeps, since_ = time, most_ = 0;
}

StableSubsteps stable_substeps(const Cloths& cloths, std::span<const Spectrum> spectra) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  StableSubsteps stable{kNone, kNone};
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    stable.largest = std::min(stable.largest, spectra[c].largest_substep());
    Spectrum folded = spectra[c];
    if (cloths[c]->model().folds_freely()) {
      folded.omega_squared *= kFolded;
      folded.damping *= kFolded;
    }
    stable.safe = std::min(stable.safe, folded.largest_substep());
  }
  return stable;
}

// Stretched springs resist sideways too, which raises the largest frequency:
// ω² <= ω²_flat + t (ω²_all - ω²_flat), t = max (1 - l/|e|).
double stretched_limit(const Cloths& cloths, std::span<const Spectrum> spectra, bool grabbed) {
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const ClothStep& step = *cloths[c];
    const float most = step.model().greatest_stretch(step.particles().x);
    double more = step.model().stiffening(std::sqrt(double(most)));
    if (grabbed) more = std::max(more, kGrabbed);
    Spectrum stretched = spectra[c];
    const bool folds = step.model().folds_freely();
    stretched.omega_squared *= folds ? kFolded : more;
    if (folds) stretched.damping *= kFolded;
    if (const Load* load = step.model().load()) stretched.load = load->omega_squared();
    limit = std::min(limit, stretched.largest_substep());
  }
  return limit;
}

int substeps_within(double limit, const Time& time, int finer) {
  const int asked = time.substeps;
  const double shortest = std::max(kLimitShare * limit, kLeastStretched);
  const int needed = clamp_to_int(std::ceil(time.frame / shortest), 1, kFinest * kMostSubsteps);
  if (asked == kAutoSubsteps) return finer * needed;
  if (time.frame / asked <= limit) return finer * asked;
  return finer * asked * ((needed + asked - 1) / asked);
}

int projection_substeps(const Scene& scene) {
  if (scene.time.substeps != kAutoSubsteps) return scene.time.substeps;
  return clamp_to_int(std::round(scene.time.frame / projection_substep(scene)), 1, kMostSubsteps);
}

}  // namespace weft::physics
