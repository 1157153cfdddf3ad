// What rounding leaves of a cloth's positions and velocities. In fine substeps it goes into the next steps
// (kernels/kept.h).
#pragma once

#include <optional>
#include <utility>

#include "physics/model/cloth_model.h"

namespace weft::physics {

struct Remainders {
  // Whether substeps of dt [s] are fine. To keep what rounding leaves takes them a sixth longer; in others it is less
  // than 1e-4 of the energy.
  static bool fine(double dt) { return dt < kFine; }
  static constexpr double kFine = 1e-4;  // s
  // Before substeps of these particles in which it is kept, or not.
  void prepare(bool keeps, const Particles& particles);
  // Null where nothing is kept.
  Left row(int j) { return kept ? Left{x.row(j), v.row(j)} : Left{}; }
  // The state was set from outside.
  void clear();
  void keep(const Particles& particles, Keeper& keeper);
  std::size_t bytes() const { return x.bytes() + v.bytes(); }

  bool kept = false;
  Rows x, v;  // m, m/s; there once they have been kept
};

// Forces keep what rounding leaves in substeps shorter than this [s]: fine ones that somebody asked for, of cloth from
// which drag or damping takes energy; else 0. What loses none is not slow for long. Automatic substeps are near the
// stability limit: there it takes a quarter longer, and forces that feel the rounding of positions in every substep would
// shake the cloth twice as much.
double forces_keep_below(const ClothParts& parts);

// A stage that moves particles by forces, and what rounding leaves of that where the cloth slows down.
template <class Base>
class Leapfrog : public Base {
 public:
  template <class... Arguments>
  explicit Leapfrog(const ClothParts& parts, Arguments&&... arguments)
      : Base(std::forward<Arguments>(arguments)...), moved_(parts) {}
  bool moves_particles() const override { return true; }
  void prepare(double dt) override {
    if (Remainders::fine(dt) && !below_) below_ = forces_keep_below(moved_);
    left_.prepare(dt < below_.value_or(0), moved_.particles);
  }
  void restart() override { left_.clear(); }
  void keep(Keeper& keeper) override { left_.keep(moved_.particles, keeper); }
  std::size_t bytes() const override { return Base::bytes() + left_.bytes(); }

 protected:
  Remainders left_;

 private:
  ClothParts moved_;
  std::optional<double> below_;  // s; known once substeps were fine
};

}  // namespace weft::physics
