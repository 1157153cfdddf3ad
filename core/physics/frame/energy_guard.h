// The last line against explosions: what a simulation's motion may come to, by the energy that was
// put into it.
//
//   ½ Σ m v² <= kBound (elastic energy and motion of the start + what gravity has released)
//
// Stiff springs turn the rounding of positions into motion, substep by substep: that is allowed for.
// A projected constraint counts as a spring of all that a sweep makes of it. The spring that a hand pulls with puts in what moving
// its far end stores in it. Where something else does work (pins and bodies on paths or carried by a
// hand, wind, contact of the sheet with itself), the motion may also come to kBound times that of a
// sheet that is 10 m/s faster than what drives it. A run that keeps its energy stays near a quarter of
// the bound.
#pragma once

#include <memory>
#include <vector>

#include "physics/frame/cloth_step.h"

namespace weft::physics {

// The greatest mean speed of a cloth's pins that follow bodies, between two times [m/s]: such a pin may be far off a
// body that turns.
double fastest_follower(const ClothStep& step, double from, double to);

// The greatest speed that planes have where a cloth is, by turning between two times [m/s].
double fastest_turning(const Scene& scene, const Particles& particles, double from, double to);

// Whether the motion and elastic energy of a cloth, as the method feels it, is more than twice what it
// was at `start` with positions x and velocities v, and besides more than what gravity, paths and wind
// can have put in until `end`.
bool gained(const Scene& scene, const ClothStep& step, const Rows& x, const Rows& v, double dt,
            double start, double end, Threads& threads);

// What a cloth holds at the end of a frame, as the method feels it, and what drag took of its motion in
// it [J].
struct Balance {
  double inner = 0;      // motion and elastic energy
  double potential = 0;  // of gravity
  double lost = 0;
};
Balance balance(const Scene& scene, const ClothStep& step, double dt, Threads& threads);

// Whether paths or wind do work between two times.
bool works(const Scene& scene, double from, double to);

// Watches sheets that nothing drives: whether they keep energy that drag must have taken. Sweeps that
// overshoot put in anew what it takes, frame by frame.
class Upkeep {
 public:
  void restart() { known_ = false; }
  // Counts one more frame; whether more than what moved at the lowest of all energies has been lost
  // since, and the energy is no lower.
  bool kept_up(const Balance& now);

 private:
  bool known_ = false;
  double least_ = 0, inner_ = 0, lost_ = 0;  // J
};

class EnergyGuard {
 public:
  static constexpr double kBound = 4;
  static constexpr double kMade = 2;  // times what was put in: no rounding

  // Gravity whose potential counts [m/s²]. One that changes over time has none; what it does counts as
  // driving instead, by the speed that it can give in every frame.
  static Vec3 counted_gravity(const Scene& scene);
  // Counts what the state holds that a run begins with, or goes on from after it was set.
  void open(const Scene& scene, Method method, const Cloths& cloths, double time, double dt,
            Threads& threads);
  // Something that a hand moves goes at so many m/s from now on.
  void drive(double speed);
  // So much more energy is there to move the sheets [J].
  void put_in(double energy) { put_in_ += energy; }
  // Looks at the end of a frame; `driven`: something but gravity did work in it.
  void look(const Scene& scene, const Cloths& cloths, bool driven);
  // The same, by what has been summed over all cloths.
  void look(const EnergySum& all, bool driven);
  // Whether the motion last looked at is within the bound.
  bool holds() const { return kinetic_ <= bound(); }
  // Takes the frame last looked at, of so many substeps, for good.
  void accept(int substeps);
  // Whether no frame has been taken since open().
  bool begins() const { return begins_; }
  // What was put in, and released by gravity, so far; the motion last looked at, and its potential of gravity [J].
  double given() const { return put_in_ + released_; }
  double kinetic() const { return kinetic_; }
  double potential() const { return potential_; }
  // Whether so much elastic energy [J] and the motion, of sheets that gravity alone moved so far, are more than that.
  bool is_made(double held) const { return held + kinetic_ > kMade * given(); }
  // What velocities must be multiplied with to be within the bound.
  double reduction() const;

 private:
  double bound() const;

  double put_in_ = 0;     // J; of the start, and by rounding since
  double rounding_ = 0;   // J; what stiff springs make of the rounding of positions in a substep
  double free_mass_ = 0;  // kg
  double fastest_ = 0;    // m/s; what drives the sheets, at most
  double gained_ = 0;     // m/s; by gravity that changes, in every frame
  double highest_ = 0;    // J; potential of gravity
  double released_ = 0;   // J; by gravity so far
  // J; of the frame last looked at: motion, potential, what gravity has released.
  double kinetic_ = 0, potential_ = 0, fall_ = 0;
  bool driven_ = false, begins_ = true;
};

}  // namespace weft::physics
