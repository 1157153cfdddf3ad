// Stages "predict" and "velocity" of the methods that project positions, of the first order and the second,
// for particles of any model; and what they keep from one substep to the next.
#pragma once

#include "physics/model/push.h"
#include "physics/model/remainders.h"

namespace weft::physics {

// Lagrange multipliers of the compliant method, kept over the sweeps of one substep: one array of rows for
// each stencil.
struct Multipliers {
  Multipliers(const Particles& particles, std::size_t stencils);
  float* row(std::size_t stencil, int j);
  void clear(int begin, int end);  // rows
  std::size_t bytes() const { return data.size() * sizeof(float); }
  int rows, stride;
  std::size_t stencils;
  AlignedArray<float> data;
};

// `multipliers`: to be cleared before the sweeps; `corrections`: what these have found since the positions that
// they were taken to, if they gather it; `left`: where all that changes positions by sweeps keeps it. Each may be null.
std::unique_ptr<RowStage> make_predict(const ClothParts& parts, Multipliers* multipliers,
                                       Rows* corrections, std::shared_ptr<Remainders> left);
// After the sweeps: positions and velocities gain the corrections, which are then zero again.
std::unique_ptr<RowStage> make_corrections(const ClothParts& parts, Rows& corrections,
                                           std::shared_ptr<Remainders> left);

// Moves a place or a velocity by a step and what rounding had left of those before, and keeps what it leaves now.
inline void move_keeping(float& value, float& left, double step) {
  const double to = double(value) + double(left) + step;
  value = float(to);
  left = float(to - double(value));
}

// What the second-order substep keeps of the substep before (Particles::previous is its position).
struct History {
  explicit History(const Particles& particles);
  std::size_t bytes() const {
    return v_before.bytes() + v_end.bytes() + left.bytes() + inverse_mass.size() * sizeof(float);
  }
  // Whether a particle's velocity is what the last substep left, so that it has a smooth past.
  bool goes_on(const Particles& particles, int row, int column) const;
  // A change of velocity that was so all along: the past is another one by that, and by so much in one
  // component of the position before [m].
  void shift(Particles& particles, int component, int row, int column, float previous, float v);
  Rows v_before, v_end;
  Remainders left;
  AlignedArray<float> inverse_mass;
};
std::unique_ptr<RowStage> make_predict_second_order(const ClothParts& parts, History& history,
                                                    Multipliers* multipliers, Rows* corrections);
// As make_corrections, and keeps velocities for the next substep.
std::unique_ptr<RowStage> make_velocity_second_order(const ClothParts& parts, History& history,
                                                     Rows* corrections);

}  // namespace weft::physics
