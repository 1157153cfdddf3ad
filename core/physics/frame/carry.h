// Stage "carry" (carry.cpp): in the plan only while a hand carries what is held.
#pragma once

#include "physics/model/cloth_model.h"

namespace weft::physics {

class Carry final : public RowStage {
 public:
  explicit Carry(const ClothParts& parts)
      : RowStage("carry", "held particles moved by a hand", 0, parts.particles.count(),
                 "particles"),
        parts_(parts) {}
  // From `time` [s] on all that is held now moves at `velocity` [m/s].
  void begin(double time, const Vec3& velocity);
  // From where the particles are at `time` [s], in place of where they would have come to.
  void begin_anew(double time);
  double speed() const;  // m/s
  void keep(Keeper& keeper) override;
  void run(int j, const Substep& s) override;

 private:
  struct Held {
    int lane;
    Vec3 start;  // m
  };
  ClothParts parts_;
  std::vector<std::vector<Held>> by_row_;
  double time_ = 0;
  Vec3 velocity_{};
};

}  // namespace weft::physics
