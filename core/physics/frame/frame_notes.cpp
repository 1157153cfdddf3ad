// Notes on frames (frame_notes.h).
#include "physics/frame/frame_notes.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/body/pierced.h"
#include "physics/frame/energy_now.h"
#include "physics/frame/projection_substep.h"
#include "physics/model/number.h"
#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

constexpr int kFramesBetweenLooks = 8;

// J
double energy_of(const Cloths& cloths, double time, const TimeStep& step) {
  double sum = 0;
  for (const auto& cloth : cloths)
    sum += energy_now(*cloth, cloth->particles().inverse_mass.span(),
                      measured_velocities(*cloth, time, step), time, {})
               .total();
  return sum;
}

// Until when bodies that were in cloths as they met grow, and so stretch it [s].
double last_growth(const Cloths& cloths) {
  double last = -1;
  for (const auto& cloth : cloths)
    for (const StartInside& start : cloth->starts())
      if (start.particles > 0 || start.triangles > 0)
        last = std::max(last, start.time + kPulledFrames * cloth->parts().scene.time.frame);
  return last;
}

}  // namespace

void add_once(std::vector<std::string>& notes, const std::string& note) {
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

void FrameNotes::look(const EndedFrame& frame, std::vector<std::string>& notes) {
  check_strain_limits(frame);
  note_clamps(frame, notes);
  note_stretch(frame, notes);
  note_pressed(frame, notes);
  driven_ |= frame.driven;
  // These looks take about as long as a sweep.
  if (frame.number % kFramesBetweenLooks != 0) return;
  if (frame.number % (2 * kFramesBetweenLooks) == 0) note_pinched(frame, notes);
  note_pierced(frame, notes);
  note_left_strain(frame, notes);
  note_shaking(frame, notes);
  if (frame.number % (4 * kFramesBetweenLooks) == 0) note_heating(frame, notes);
}

void FrameNotes::begin_anew(const Cloths& cloths, double time, const TimeStep& step) {
  driven_ = false;
  count_energy(cloths, time, step);
}

void FrameNotes::count_energy(const Cloths& cloths, double time, const TimeStep& step) {
  first_energy_ = is_explicit(step.method) ? energy_of(cloths, time, step) : 0;
  counted_at_ = time;
  greatest_motion_ = 0;
}

void FrameNotes::keep(Keeper& keeper) {
  keeper(overlong_);
  keeper(stretched_);
  keeper(pinched_);
  keeper(pierced_);
  keeper(pressed_);
  for (bool* told : {&clamps_, &left_strain_, &shaking_, &heating_, &driven_}) keeper(*told);
  keeper(told_);
  keeper(first_energy_);
  keeper(counted_at_);
  keeper(greatest_motion_);
}

void FrameNotes::check_strain_limits(const EndedFrame& frame) {
  constexpr double kTolerance = 1e-2;  // of the limit
  for (std::size_t c = 0; c < frame.cloths.size(); ++c) {
    const ClothStep& step = *frame.cloths[c];
    const double limit = step.cloth().strain_limit;
    if (limit == 0 || is_asleep(frame.sleeping, c)) continue;
    const double strain = step.model().limited_strain();
    if (strain <= limit * (1 + kTolerance)) continue;
    Overlong& o = overlong_[c];
    if (o.count++ == 0) o.first = frame.number;
    if (strain > o.strain) o.worst = frame.number, o.strain = strain;
  }
}

// Motion that contact had to cut short.
void FrameNotes::note_clamps(const EndedFrame& frame, std::vector<std::string>& notes) {
  if (clamps_ || !frame.contact || frame.contact->pairs().record().held == 0) return;
  clamps_ = true;
  notes.push_back("frame " + std::to_string(frame.number) +
                  ": sheets would have passed through each other; what met moves as one until "
                  "it comes apart (shorter substeps or a greater thickness avoid that)");
}

// Nothing passes through, so that what is drawn against something stretches instead.
void FrameNotes::note_stretch(const EndedFrame& frame, std::vector<std::string>& notes) {
  constexpr double kDoubled = 1;
  if (!frame.contact || !frame.contact->pairs().touched()) return;
  for (std::size_t c = 0; c < frame.cloths.size(); ++c) {
    if (stretched_[c] || is_asleep(frame.sleeping, c)) continue;
    const double strain = frame.cloths[c]->model().strain().max;
    if (strain < kDoubled) continue;
    stretched_[c] = 1;
    notes.push_back("frame " + std::to_string(frame.number) + ": cloth " + std::to_string(c) +
                    " is drawn against what it cannot pass, to " + number(1 + strain) +
                    " times its length (other ways of its pins, a strain limit or tear_strain "
                    "avoid that)");
  }
}

// Sheets that something holds nearer than their thickness.
void FrameNotes::note_pressed(const EndedFrame& frame, std::vector<std::string>& notes) {
  constexpr double kPressed = 0.5;  // of the thickness, that is missing
  constexpr int kLasting = 10;      // frames
  if (!frame.contact || pressed_ == kLasting) return;
  const double missing = frame.contact->pairs().record().missing_now;
  pressed_ = missing > kPressed ? pressed_ + 1 : 0;
  if (pressed_ == kLasting)
    notes.push_back("frame " + std::to_string(frame.number) + ": for " + std::to_string(kLasting) +
                    " frames sheets have been nearer to each other than half of their thickness (" +
                    number(std::max(0.0, 1 - missing)) +
                    " of it now): what presses them leaves less room than they need");
}

// Folds that hang about a needle or a ridge may be drawn through it from the side.
void FrameNotes::note_pierced(const EndedFrame& frame, std::vector<std::string>& notes) {
  for (std::size_t c = 0; c < frame.cloths.size(); ++c) {
    if (pierced_[c] || is_asleep(frame.sleeping, c)) continue;
    const Pierced found = pierced(frame.cloths[c]->model(), frame.time);
    if (found.places == 0) continue;
    pierced_[c] = 1;
    notes.push_back("frame " + std::to_string(frame.number) + ": edges of collider " +
                    std::to_string(found.collider) + " pass through cloth " + std::to_string(c) +
                    " in " + std::to_string(found.places) +
                    (found.places == 1 ? " place" : " places") +
                    "; finer cloth, shorter substeps, an offset or rounder edges hold it");
  }
}

// Cloth between two bodies that leave no room for it lies in one of them, or in both.
void FrameNotes::note_pinched(const EndedFrame& frame, std::vector<std::string>& notes) {
  for (std::size_t c = 0; c < frame.cloths.size(); ++c) {
    if (pinched_[c] || is_asleep(frame.sleeping, c)) continue;
    const ClothStep& step = *frame.cloths[c];
    const Pinched found = pinched_search_.look(step.parts(), frame.time);
    if (found.missing <= 0) continue;
    pinched_[c] = 1;
    notes.push_back("frame " + std::to_string(frame.number) + ": colliders " +
                    std::to_string(found.colliders[0]) + " and " +
                    std::to_string(found.colliders[1]) + " leave cloth " + std::to_string(c) + " " +
                    number(found.missing) +
                    " m less room than their offsets ask for; it lies in what they should keep "
                    "clear");
  }
}

// Sweeps that leave strain keep energy that nothing put in; so do sheets that are put apart faster than they give
// way.
void FrameNotes::note_left_strain(const EndedFrame& frame, std::vector<std::string>& notes) {
  if (left_strain_ || driven_ || frame.step.method != Method::compliant) return;
  double held = 0;
  for (std::size_t c = 0; c < frame.cloths.size(); ++c)
    if (!is_asleep(frame.sleeping, c)) {
      const ClothStep& step = *frame.cloths[c];
      held += step.model().held_energy(step.particles().x, 0, frame.threads);
    }
  if (!frame.energy.is_made(held)) return;
  left_strain_ = true;
  notes.push_back("frame " + std::to_string(frame.number) + ": the sweeps" +
                  (frame.contact ? ", or sheets put apart," : "") + " leave strain of " +
                  number(held) + " J that nothing put in: with the motion " +
                  number(held + frame.energy.kinetic()) + " J, of " + number(frame.energy.given()) +
                  " J; more substeps or iterations leave less");
}

// Lines that are drawn out in substeps too long for that.
void FrameNotes::note_shaking(const EndedFrame& frame, std::vector<std::string>& notes) {
  for (std::size_t c = 0; c < frame.cloths.size() && !shaking_; ++c) {
    const ClothStep& step = *frame.cloths[c];
    const Shaking from =
        shaking(step.parts().scene, step.cloth(), frame.step.method, frame.step.dt);
    if (std::isinf(from.strain) || is_asleep(frame.sleeping, c)) continue;
    const double strain = step.model().strain_in_line(step.particles().x, from.spread);
    if (strain <= from.strain) continue;
    shaking_ = true;
    notes.push_back("frame " + std::to_string(frame.number) + ": cloth " + std::to_string(c) +
                    " is drawn out by " + number(strain) + " along its lines; in substeps of " +
                    number(frame.step.dt) + " s line sweeps leave strain, or shake it, from " +
                    number(from.strain) + " on; more substeps or iterations hold it");
  }
}

// Forces make energy where vibrations near the stability limit grow.
void FrameNotes::note_heating(const EndedFrame& frame, std::vector<std::string>& notes) {
  constexpr double kNoticed = 0.1;  // of the greatest motion
  if (heating_ || driven_ || frame.contact || frame.sleeping || !is_explicit(frame.step.method))
    return;
  if (last_growth(frame.cloths) > counted_at_)
    return count_energy(frame.cloths, frame.time, frame.step);
  double held = 0;
  for (const auto& step : frame.cloths) {
    if (step->model().load() || !step->parts().scene.gravity_keys.empty()) return;
    held += step->model().held_energy(step->particles().x, 0, frame.threads);
  }
  greatest_motion_ = std::max(greatest_motion_, frame.energy.kinetic());
  const double most = first_energy_ + kNoticed * greatest_motion_;
  // Of the motion half a substep before, which costs little; then exactly.
  if (held + frame.energy.kinetic() + frame.energy.potential() <= most) return;
  const double energy = energy_of(frame.cloths, frame.time, frame.step);
  if (energy <= most) return;
  heating_ = true;
  notes.push_back("frame " + std::to_string(frame.number) + ": forces have made " +
                  number(energy - first_energy_) +
                  " J of nothing, as vibrations near the stability limit grow; substeps of " +
                  number(frame.step.dt / 2) + " s do not");
}

void FrameNotes::tell(const Cloths& cloths, std::int64_t frames, std::vector<std::string>& notes) {
  for (const std::string& old : told_) std::erase(notes, old);
  told_.clear();
  for (std::size_t c = 0; c < overlong_.size(); ++c) {
    const Overlong& o = overlong_[c];
    if (o.count == 0) continue;
    const std::string others =
        o.count == 1 ? "" : ", nor in " + std::to_string(o.count - 1) + " others";
    told_.push_back("cloth " + std::to_string(c) + ": the strain limit of " +
                    number(cloths[c]->cloth().strain_limit) + " did not hold in frame " +
                    std::to_string(o.first) + others + " (" + number(o.strain) +
                    (o.count == 1 ? "" : " in frame " + std::to_string(o.worst)) +
                    "); more substeps hold it better");
  }
  for (std::size_t c = 0; frames > 0 && c < cloths.size(); ++c) {
    const OpenSeams seams = cloths[c]->model().open_seams();
    if (seams.open == 0) continue;
    told_.push_back("cloth " + std::to_string(c) + ": " + std::to_string(seams.open) + " of " +
                    std::to_string(seams.all) + " seams are open after frame " +
                    std::to_string(frames) + ", their ends up to " + number(seams.widest) +
                    " m from the middle");
  }
  notes.insert(notes.end(), told_.begin(), told_.end());
}

}  // namespace weft::physics
