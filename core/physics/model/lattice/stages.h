// The stages that a step plan chooses from; each is one file. A factory returns null when the cloth
// gives the stage nothing to do.
#pragma once

#include <memory>
#include <vector>

#include "physics/model/lattice/lattice.h"
#include "physics/model/lattice/stencil.h"
#include "physics/step/stage.h"

namespace weft::physics {

class Tearing;

// Whether a method integrates springs as forces, and so has a stability limit.
inline bool is_explicit(Method m) {
  return m == Method::spring || m == Method::spring_friction;
}

// What every stage of one cloth refers to; outlives the stages.
struct ClothParts {
  const Scene& scene;
  const Cloth& cloth;
  const Method& method;  // that runs: the scene's, or a stable one in its place
  Lattice& lattice;
  const std::vector<Stencil>& stencils;
  const KernelTable& kernels;
  const Tearing* tearing = nullptr;  // null: the cloth cannot tear
  // By row, written by the springs: whether a constraint was too long; null: they do not tell.
  std::uint8_t* overlong = nullptr;
  std::int64_t particles() const { return std::int64_t(lattice.columns) * lattice.rows; }
  std::int64_t constraints() const;
};

// The most rows that a constraint spans.
int greatest_reach(const ClothParts& parts);

// Constants of the leapfrog move over one substep.
Advance advance_of(const ClothParts& parts, const Substep& substep);

std::unique_ptr<RowStage> make_springs(const ClothParts& parts, bool damped);
// `corrections`: what sweeps have found, if they gather it.
std::unique_ptr<RowStage> make_predict(const ClothParts& parts, struct Multipliers* multipliers,
                                       Rows* corrections);
std::unique_ptr<RowStage> make_velocity(const ClothParts& parts, bool compliant);
std::unique_ptr<RowStage> make_keyed_pins(const ClothParts& parts);
// m, past which a constraint tears.
inline float tear_length(const Cloth& cloth, const Stencil& stencil) {
  return float(stencil.rest * (1 + cloth.tear_strain));
}
std::unique_ptr<RowStage> make_tear(const ClothParts& parts, Tearing& tearing);
std::unique_ptr<RowStage> make_wind(const ClothParts& parts, std::uint64_t seed);

// Lagrange multipliers of the compliant method, kept over the sweeps of one substep: one lattice of
// floats per stencil, null when a single sweep needs none.
struct Multipliers {
  Multipliers(const Lattice& lattice, std::size_t stencils);
  float* row(std::size_t stencil, int j);
  void clear(int begin, int end);  // rows
  std::size_t bytes() const { return data.size() * sizeof(float); }
  int rows, stride;
  std::size_t stencils;
  AlignedArray<float> data;
};

// The Gauss–Seidel sweep: one stage per row offset and colour, appended in the fixed order.
struct SweepOptions {
  bool compliant = false;
  Multipliers* multipliers = nullptr;
  Rows* corrections = nullptr;  // the compliant Gauss–Seidel sweep gathers what it finds there
  double limit = 0;             // > 0: the strain limit's one-sided sweep
};
void append_gauss_seidel(const ClothParts& parts, const SweepOptions& options, Stages& stages);
// After the sweeps: positions and velocities gain the corrections, which are then zero again.
std::unique_ptr<RowStage> make_corrections(const ClothParts& parts, Rows& corrections);
// What the second-order substep keeps of the substep before (Lattice::previous is its position).
struct History {
  explicit History(const Lattice& lattice);
  std::size_t bytes() const {
    return v_before.bytes() + v_end.bytes() + predicted.bytes() +
           inverse_mass.size() * sizeof(float);
  }
  Rows v_before, v_end, predicted;
  AlignedArray<float> inverse_mass;
};
// The share of the substep over which constraint forces act.
double implicit_share(const Solver& solver);

// Where velocities get what the sweeps did from: from how far particles were moved, or, where rounding
// of positions over dt would show, from every correction as it is computed (which costs a line sweep a
// fourth more). `positional` always takes the positions, the coloured sweeps of `compliant` never do.
bool velocity_from_positions(const Solver& solver, bool compliant, double dt);
// 1/s; what stages that move particles multiply corrections by to get their velocity: 0 = nothing.
float velocity_gain(const Solver& solver, bool compliant, double dt);

// How a force pushes particles that have just been moved (by springs or predict): as constraints do,
// for the same share of the substep, and on velocities where these do not get it from positions.
struct Push {
  double dt;        // s, for which it acts
  bool velocities;  // they gain it at once
};
Push push_of(const ClothParts& parts, double dt);
std::unique_ptr<RowStage> make_predict_second_order(const ClothParts& parts, History& history,
                                                    Multipliers* multipliers);
std::unique_ptr<RowStage> make_velocity_second_order(const ClothParts& parts, History& history);

std::unique_ptr<RowStage> make_attachments(const ClothParts& parts, bool compliant);
// The curvature energy, as a force on the velocities or as constraints.
std::unique_ptr<Stage> make_bending(const ClothParts& parts, Method method);

// Compliance 1/(k dt²) [1/kg] of a stencil's constraints in row j, dt the share of the substep that
// the solver's order gives constraint forces.
float compliance_of(const ClothParts& parts, const Stencil& stencil, int j, double dt);

struct LineOptions {
  bool compliant = false;
  int iterations = 1;
  float share = 1;  // of the correction
};
// The line sweep: one stage for all stencils and iterations; null when the cloth has no constraint.
std::unique_ptr<Stage> make_line(const ClothParts& parts, const LineOptions& options);
std::unique_ptr<RowStage> make_jacobi(const ClothParts& parts, const SweepOptions& options);

}  // namespace weft::physics
