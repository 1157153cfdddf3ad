// Stage "grab" (grab.cpp): in the plan only while something is held.
#pragma once

#include "physics/model/cloth_model.h"

namespace weft::physics {

class Grab final : public RowStage {
 public:
  explicit Grab(const ClothParts& parts)
      : RowStage("grab", "a particle drawn to a target", 0, 1, "particles"), parts_(parts) {}
  double energy() const;  // J; in the spring as it is stretched now
  // What it reads, predict has brought up to date.
  Velocities velocities() const override { return Velocities::left_alone; }
  void keep(Keeper& keeper) override;
  void run(int j, const Substep& s) override;

  bool holds(const Particles::Place& p) const { return p.j == place.j && p.i == place.i; }

  Particles::Place place{0, 0};  // of the particle
  Vec3 target{};
  double stiffness = 0;  // N/m

 private:
  double held_stiffness() const;

  ClothParts parts_;
};

}  // namespace weft::physics
