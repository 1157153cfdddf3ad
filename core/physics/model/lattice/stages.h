// The stages that a step plan chooses from; each is one file. A factory returns null when the cloth
// gives the stage nothing to do.
#pragma once

#include <memory>
#include <vector>

#include "physics/kernels/tear.h"
#include "physics/model/cloth_model.h"
#include "physics/model/lattice/lattice.h"
#include "physics/model/lattice/stencil.h"
#include "physics/model/projected_motion.h"
#include "physics/step/stage.h"

namespace weft::physics {

class LatticeTearing;

// What the stages of a grid refer to besides.
struct LatticeParts : ClothParts {
  Lattice& lattice;
  const std::vector<Stencil>& stencils;
  LatticeTearing* tearing = nullptr;  // null: the cloth cannot tear
  // By row, written by the springs: whether a constraint was too long; null: they do not tell.
  std::uint8_t* overlong = nullptr;
  // By row, written by the sweeps: how many constraints they have ended; null: they end none.
  std::int32_t* ended = nullptr;
  std::int64_t constraints() const;
};

// The most rows that a constraint spans.
int greatest_reach(const LatticeParts& parts);

// `left`: what rounding leaves, which springs and the bending before them share.
std::unique_ptr<RowStage> make_springs(const LatticeParts& parts, bool damped,
                                       std::shared_ptr<Remainders> left);
std::unique_ptr<RowStage> make_membrane(const LatticeParts& parts);
// m, past which a constraint tears.
inline float tear_length(const Cloth& cloth, const Stencil& stencil) {
  return float(stencil.rest * (1 + cloth.tear_strain));
}
// Of a stencil's constraints in row j, in an array that is laid out as the lattice.
inline TearEnds ends_of(const Stencil& stencil, Rows& rows, int j) {
  return {rows.row(j).from(stencil.near()), rows.row(j + stencil.dj).from(stencil.far())};
}
std::unique_ptr<RowStage> make_tear(const LatticeParts& parts, LatticeTearing& tearing);
std::unique_ptr<RowStage> make_wind(const LatticeParts& parts, std::uint64_t seed);

// The Gauss–Seidel sweep: one stage per row offset and colour, appended in the fixed order.
struct SweepOptions {
  bool compliant = false;
  Multipliers* multipliers = nullptr;
  Rows* corrections = nullptr;  // the Gauss–Seidel sweeps of a substep gather what they find there
  double limit = 0;             // > 0: a sweep of the strain limit,
  double held = 0;              // what forces hold of it: as much or less,
  double strongest = 0;         // and the greatest that lasts to the next substep [N]
  LimitSweep limit_sweep = LimitSweep::once;  // of this kind; not `once`: with multipliers
  bool backwards = false;                     // the last constraint first
  bool tears = false;                         // ends constraints past their tear strain
  std::shared_ptr<Remainders> left;           // Jacobi, which moves particles itself; or null
};
void append_gauss_seidel(const LatticeParts& parts, const SweepOptions& options, Stages& stages);
// The same of a membrane, over its cells, with multipliers for kCellStresses; and the sweep of its damping, which comes
// before, with as many that follow those.
inline constexpr std::size_t kCellStencils = 4, kCellStresses = 8;
void append_membrane_sweep(const LatticeParts& parts, const SweepOptions& options, Stages& stages);
void append_membrane_damping(const LatticeParts& parts, Rows& corrections, Multipliers* multipliers,
                             Stages& stages);
// A strain limit that holds: sweeps by forces that last, which stay in `forces`.
void append_held_limit(const LatticeParts& parts, Multipliers& forces, Stages& stages);
// The strain limit, one constraint after the other.
std::unique_ptr<RowStage> make_course_limit(const LatticeParts& parts);
std::unique_ptr<RowStage> make_attachments(const LatticeParts& parts, Rows& corrections);
// The curvature energy, as a force on the velocities, or as constraints, which gather corrections; null when the
// cloth does not bend.
std::unique_ptr<RowStage> make_bending_force(const LatticeParts& parts,
                                             std::shared_ptr<Remainders> left);
std::unique_ptr<Stage> make_bending(const LatticeParts& parts, Rows& corrections);

// Where particles were before a substep of dt, as it is known after the stages of `predict`.
SubstepStart start_of(const LatticeParts& parts, double dt);

// Compliance 1/(k dt²) [1/kg] of a stencil's constraints in row j, dt the share of the substep that
// the solver's order gives constraint forces.
float compliance_of(const LatticeParts& parts, const Stencil& stencil, int j, double dt);

struct LineOptions {
  bool compliant = false;
  int iterations = 1;
  float share = 1;               // of the correction
  bool membrane = false;         // not springs but the membrane, compliant
  bool corrections_zero = true;  // when the sweeps begin
  bool tears = false;            // the last sweep ends constraints past their tear strain
};
// The line sweep: one stage for all stencils and iterations; null when the cloth has no constraint.
std::unique_ptr<Stage> make_line(const LatticeParts& parts, Rows& corrections,
                                 const LineOptions& options);
std::unique_ptr<RowStage> make_jacobi(const LatticeParts& parts, const SweepOptions& options);

}  // namespace weft::physics
