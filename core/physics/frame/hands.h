// What a person's hands hold of a running simulation: one particle drawn to a target, and cloths whose held
// particles are carried. Each is a stage in its cloth's plan for as long as it lasts.
#pragma once

#include <vector>

#include "physics/frame/carry.h"
#include "physics/frame/cloth_step.h"
#include "physics/frame/energy_guard.h"
#include "physics/frame/grab.h"

namespace weft::physics {

class Hands {
 public:
  // Over so many cloths, which live longer.
  Hands(Cloths& cloths, std::size_t count) : cloths_(cloths), carried_(count) {}

  // The cloth that is grabbed, or -1.
  int grabbed() const { return grab_ ? grabbed_ : -1; }
  bool carries(std::size_t cloth) const { return carried_[cloth]; }
  bool act() const;

  // Draws a particle to a target. Returns how much energy that stores beyond what was stored [J].
  double grab(int cloth, Particles::Place particle, const Vec3& target, double stiffness);
  void release();
  // From `time` [s] on carries what is held of a cloth at a velocity [m/s]. Returns the speed.
  double carry(int cloth, const Vec3& velocity, double time);
  // What was carried rests.
  void put_down(int cloth);
  void let_go();

  // Positions are others than the stages left; from `time` [s] on all goes on from there.
  void begin_anew(double time);
  // Takes up what was held then, as it was, where it puts back; stages keep the rest (Stage::keep).
  void keep(Keeper& keeper);
  // Counts what they put in.
  void tell(EnergyGuard& guard) const;

 private:
  Cloths& cloths_;
  Grab* grab_ = nullptr;  // in the plan of cloth grabbed_
  int grabbed_ = 0;
  std::vector<Carry*> carried_;  // in the plan of each cloth; null while it rests
};

}  // namespace weft::physics
