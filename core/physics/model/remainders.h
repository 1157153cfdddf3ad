// What rounding leaves of a cloth's positions and velocities. In fine substeps it goes into the next steps
// (kernels/kept.h).
#pragma once

#include <memory>
#include <optional>
#include <utility>

#include "physics/model/cloth_model.h"

namespace weft::physics {

struct Remainders {
  // Whether substeps of dt [s] are fine for sweeps. To keep what rounding leaves takes them a sixth longer; in others it
  // is less than 1e-4 of the energy.
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

// Forces keep what rounding leaves in substeps shorter than this [s]: in fixed ones four times as short as stability
// asks for, which somebody chose for exact paths. What is rounded off would be most of their error there, and grow as
// they get shorter. In automatic ones, 0: near the stability limit the error of the step itself is far greater, and to
// keep what is rounded off takes a tenth to a third longer. Steps that are the course's (full_first_kick) come from its
// scenes, not from a choice, and are to end where the course does: they keep it where they are fine for sweeps, too.
double forces_keep_below(const ClothParts& parts);

// A stage that moves particles by forces, and what rounding leaves of that; `left` may be shared with stages that
// change velocities before it does.
template <class Base>
class Leapfrog : public Base {
 public:
  template <class... Arguments>
  Leapfrog(const ClothParts& parts, std::shared_ptr<Remainders> left, Arguments&&... arguments)
      : Base(std::forward<Arguments>(arguments)...), left_(std::move(left)), moved_(parts) {}
  bool moves_particles() const override { return true; }
  void prepare(double dt) override {
    if (!below_) below_ = forces_keep_below(moved_);
    left_->prepare(dt < *below_, moved_.particles);
  }
  void restart() override { left_->clear(); }
  void keep(Keeper& keeper) override { left_->keep(moved_.particles, keeper); }
  std::size_t bytes() const override { return Base::bytes() + left_->bytes(); }

 protected:
  const std::shared_ptr<Remainders> left_;

 private:
  ClothParts moved_;
  std::optional<double> below_;  // s; known once there was a substep
};

}  // namespace weft::physics
