// The stages that a step plan chooses from; each is one file. A factory returns null when the cloth
// gives the stage nothing to do.
#pragma once

#include <memory>
#include <vector>

#include "physics/family.h"
#include "physics/lattice.h"
#include "physics/stage.h"

namespace weft::physics {

class Topology;

// What of a cloth lies inside a collider and can move when the two first meet, at the start or when the
// collider is put where the cloth is: particles, and triangles where those catch the collider, and how
// deep at most [m].
struct StartInside {
  double time = 0;  // s
  std::int64_t particles = 0, triangles = 0;
  double deepest_particle = 0, deepest_triangle = 0;
};
StartInside start_inside(const Cloth& cloth, const Lattice& lattice, const Collider& collider,
                         double time);
// Adds the triangles.
void find_triangles_inside(const Cloth& cloth, const Lattice& lattice, const Collider& collider,
                           StartInside& found);
// Sheets that lie on a surface start no deeper [m].
inline constexpr double kTouchingStart = 1e-4;

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
  const std::vector<Family>& families;
  const KernelTable& kernels;
  const std::vector<StartInside>& starts;  // of every collider
  const Topology* topology = nullptr;      // null: the cloth cannot tear
  // By row, written by the springs: whether a constraint was too long; null: they do not tell.
  std::uint8_t* overlong = nullptr;
  const StartInside& start_in(const Collider& collider) const {
    return starts[std::size_t(&collider - scene.colliders.data())];
  }
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
inline float tear_length(const Cloth& cloth, const Family& family) {
  return float(family.rest * (1 + cloth.tear_strain));
}
std::unique_ptr<RowStage> make_tear(const ClothParts& parts, Topology& topology);
std::unique_ptr<RowStage> make_cut(const ClothParts& parts, const Collider& collider,
                                   Topology& topology);
std::unique_ptr<RowStage> make_wind(const ClothParts& parts, std::uint64_t seed);
std::unique_ptr<RowStage> make_collider(const ClothParts& parts, const Collider& collider);
std::unique_ptr<RowStage> make_collider_faces(const ClothParts& parts, const Collider& collider);

// Lagrange multipliers of the compliant method, kept over the sweeps of one substep: one lattice of
// floats per family, null when a single sweep needs none.
struct Multipliers {
  Multipliers(const Lattice& lattice, std::size_t families);
  float* row(std::size_t family, int j);
  void clear(int begin, int end);  // rows
  std::size_t bytes() const { return data.size() * sizeof(float); }
  int rows, stride;
  std::size_t families;
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

std::unique_ptr<RowStage> make_tethers(const ClothParts& parts, bool compliant);
// The curvature energy, as a force on the velocities or as constraints.
std::unique_ptr<Stage> make_bending(const ClothParts& parts, Method method);

// Compliance 1/(k dt²) [1/kg] of a family's constraints in row j, dt the share of the substep that
// the solver's order gives constraint forces.
float compliance_of(const ClothParts& parts, const Family& family, int j, double dt);

struct LineOptions {
  bool compliant = false;
  int iterations = 1;
  float share = 1;  // of the correction
};
// The line sweep: one stage for all families and iterations; null when the cloth has no constraint.
std::unique_ptr<Stage> make_line(const ClothParts& parts, const LineOptions& options);
std::unique_ptr<RowStage> make_jacobi(const ClothParts& parts, const SweepOptions& options);

}  // namespace weft::physics
