// Stages "wind": air on the triangles of one cloth. Gusts are waves in space whose phases move with
// the wind and turn in time, chosen by the seed: the same for any order of work.
//
// Air changes far more slowly than springs do: within a frame it pushes once for up to a millisecond
// of substeps, with the impulse of all of them (multiple time steps: Tuckerman, Berne, Martyna 1992).
#pragma once

#include "physics/kernels/wind.h"
#include "physics/model/cloth_model.h"

namespace weft::physics {

// What all cloths have in common; a triangle reaches its row and the next.
class WindStage : public RowStage {
 public:
  // `triangles`: how many there are.
  WindStage(const ClothParts& parts, std::uint64_t seed, std::int64_t triangles);

  // What it reads, predict has brought up to date.
  Velocities velocities() const override { return Velocities::left_alone; }
  void reserve_slots(int slots) override;
  std::size_t bytes() const override { return force_.bytes() + resistance_.bytes(); }
  void start(const Substep& s) override;
  void run(int j, const Substep& s) override;

 protected:
  // Adds up what air does to the triangles of row j.
  virtual void blow(int j, const Substep& s) = 0;

  // The sums of a row: two rows in turn.
  AirRow sums(int row, const Substep& s);
  void set_air(Air& air, const Substep& s) const;

 private:
  struct Wave {
    Vec3 k;              // 1/m
    double rate, phase;  // turns a second, turns
  };
  int substeps_pushed(const Substep& s) const;

  ClothParts parts_;
  std::array<Wave, kGusts> waves_;
  Rows force_, resistance_;  // two rows in turn per slot; of the resistance, drag and lift
};

// Whether air acts on cloth at all.
inline bool blows(const Wind& wind) {
  return wind.drag > 0 || wind.lift > 0;
}

}  // namespace weft::physics
