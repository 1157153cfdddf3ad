// The stages that a step plan chooses from; each is one file. A factory returns null when the cloth
// gives the stage nothing to do.
#pragma once

#include <memory>
#include <vector>

#include "physics/family.h"
#include "physics/lattice.h"
#include "physics/stage.h"

namespace weft::physics {

// What every stage of one cloth refers to; outlives the stages.
struct ClothParts {
  const Scene& scene;
  const Cloth& cloth;
  Lattice& lattice;
  const std::vector<Family>& families;
  const KernelTable& kernels;
  std::int64_t particles() const { return std::int64_t(lattice.columns) * lattice.rows; }
  std::int64_t constraints() const;
};

// Constants of the leapfrog move over one substep.
Advance advance_of(const ClothParts& parts, double dt);

std::unique_ptr<RowStage> make_springs(const ClothParts& parts, bool damped);
std::unique_ptr<RowStage> make_predict(const ClothParts& parts, struct Multipliers* multipliers);
std::unique_ptr<RowStage> make_velocity(const ClothParts& parts);
std::unique_ptr<RowStage> make_keyed_pins(const ClothParts& parts);
class Topology;
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
  void clear(int j);
  std::size_t bytes() const { return data.size() * sizeof(float); }
  int rows, stride;
  std::size_t families;
  AlignedArray<float> data;
};

// The Gauss–Seidel sweep: one stage per family and colour, appended in the fixed order.
struct SweepOptions {
  bool compliant = false;
  Multipliers* multipliers = nullptr;
  double limit = 0;  // > 0: the strain limit's one-sided sweep
};
void append_gauss_seidel(const ClothParts& parts, const SweepOptions& options,
                         Stages& stages);
std::unique_ptr<RowStage> make_jacobi(const ClothParts& parts, const SweepOptions& options);

}  // namespace weft::physics
