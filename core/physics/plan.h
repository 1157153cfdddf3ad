// The step plan: from a scene, the stages that it needs, each an instance of exactly the features in
// use. What a scene does not need is not in the plan, holds no memory and costs nothing.
//
// A frame is `substeps` substeps; a substep of one cloth is, in this order,
//
//   spring, spring_friction:  bending (v) - springs (x, v -> forces -> v, x) - wind - keyed_pins
//                             - colliders - strain_limit
//   positional, compliant:    predict (v, x by gravity; previous <- x) - wind (x) - keyed_pins
//                             - tethers (x) - sweeps (x) - bending (x) - velocity (v += (x - previous)
//                             /dt, unless the stages before have changed v themselves) - colliders
//                             - strain_limit
//
// A hand's stages come right after springs or predict.
// Where nothing follows velocity, it waits for the last substep, and predict adds to v itself.
// After every stage from springs or velocity on, x - dt v is the position before the substep:
// contact and the strain limit change x and v together.
#pragma once

#include <memory>
#include <vector>

#include "physics/passes.h"
#include "physics/seams.h"
#include "physics/stages/stages.h"
#include "physics/topology.h"
#include "weft/report.h"

namespace weft::physics {

// One cloth's share of the plan.
class ClothStep {
 public:
  ClothStep(const Scene& scene, int cloth_index, Method method, std::uint64_t seed,
            const KernelTable& kernels);

  const Cloth& cloth() const { return cloth_; }
  // Of every collider of the scene.
  const std::vector<StartInside>& starts() const { return starts_; }
  // The cloth meets a collider anew.
  void meet(std::size_t collider, const StartInside& inside);
  Lattice& lattice() { return lattice_; }
  const Lattice& lattice() const { return lattice_; }
  const std::vector<Family>& families() const { return families_; }
  const Stages& stages() const { return stages_; }
  Passes& passes() { return *passes_; }
  // Puts a stage right after the one that moves the particles; takes it away again.
  void add_stage(std::unique_ptr<Stage> stage);
  void remove_stage(const Stage* stage);
  // Chooses the stages anew for this method and the scene's solver as it is now. Added stages stay;
  // what the others carry from substep to substep starts anew.
  void choose_anew(Method method);
  ClothParts parts() const { return parts_; }
  // Null while the cloth cannot tear. allow_tearing() lets a cloth tear from now on.
  Topology* topology() { return topology_.get(); }
  const Topology* topology() const { return topology_.get(); }
  void allow_tearing();
  // The seams of the tears as they lie now; null unless the cloth has torn and shows its tears split.
  const Seams* seams();
  // Bending terms that are left; null: all.
  const BendLinks* bend_links() const { return topology_ ? topology_->bend_links() : nullptr; }
  std::size_t bytes() const;

 private:
  void make_topology();
  void choose_stages();
  void append_contact();
  void make_passes();

  const Cloth& cloth_;
  Method method_;
  const std::uint64_t seed_;
  std::vector<Family> families_;
  Lattice lattice_;
  std::vector<StartInside> starts_;
  ClothParts parts_;
  std::unique_ptr<Multipliers> multipliers_;
  std::unique_ptr<Rows> corrections_;
  std::unique_ptr<History> history_;
  std::vector<std::uint8_t> overlong_;
  Stages stages_;
  std::vector<const Stage*> added_;
  std::unique_ptr<Topology> topology_;
  std::unique_ptr<Seams> seams_;
  std::unique_ptr<Passes> passes_;
};

// The description that `weft explain` prints.
Plan describe(const Scene& scene, const std::vector<std::unique_ptr<ClothStep>>& cloths,
              int substeps);

}  // namespace weft::physics
