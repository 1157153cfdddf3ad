// What is written down of a cloth in a frame: its rows as they lie at the start, to go back to, and
// how large positions are and what the motion holds at the end. The wavefront does both where the rows
// are in the cache anyway: as it first comes to them, and as it leaves them.
#pragma once

#include <cstddef>
#include <vector>

#include "physics/model/particles.h"
#include "physics/step/stage.h"

namespace weft::physics {

class RollbackBuffer final : public RowObserver {
 public:
  // Particles and kernels outlive the record. `gravity` [m/s²].
  RollbackBuffer(Particles& particles, const Vec3& gravity, const KernelTable& kernels);

  // Keeps rows as they are at the frame's start; measures them at its end.
  void before(RowSpan rows) override;
  void after(RowSpan rows) override;
  void keep() { before({0, particles_.rows}); }
  void measure() { after({0, particles_.rows}); }
  // Puts all rows back to how they were kept.
  void restore();

  // At the frame's start.
  const Rows& x() const { return x_; }
  const Rows& v() const { return v_; }
  // At its end, summed in the order of the rows.
  EnergySum energy_sum() const;
  std::size_t bytes() const { return x_.bytes() + v_.bytes() + seen_.size() * sizeof(EnergySum); }

 private:
  Particles& particles_;
  const Vec3 gravity_;
  const KernelTable& kernels_;
  Rows x_, v_;
  std::vector<EnergySum> seen_;  // of every row
};

}  // namespace weft::physics
