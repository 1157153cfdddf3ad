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

#include "physics/contact/moving_collider.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/lattice/tear_boundary.h"
#include "physics/model/lattice/tearing.h"
#include "physics/step/schedule.h"
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
  const std::vector<Stencil>& stencils() const { return stencils_; }
  const Stages& stages() const { return stages_; }
  // What the cloth does without, and why.
  const std::vector<SkippedStage>& skipped() const { return skipped_; }
  Schedule& schedule() { return *schedule_; }
  // Puts a stage right after the one that moves the particles; takes it away again.
  void add_stage(std::unique_ptr<Stage> stage);
  void remove_stage(const Stage* stage);
  // Chooses the stages anew for this method and the scene's solver as it is now. Added stages stay;
  // what the others carry from substep to substep starts anew.
  void choose_anew(Method method);
  const ClothParts& parts() const { return parts_; }
  // Null while the cloth cannot tear. allow_tearing() lets a cloth tear from now on.
  Tearing* tearing() { return tearing_.get(); }
  const Tearing* tearing() const { return tearing_.get(); }
  void allow_tearing();
  // The seams of the tears as they lie now; null unless the cloth has torn and shows its tears split.
  const TearBoundary* tear_boundary();
  // Bending terms that are left; null: all.
  const BendLinks* bend_links() const { return tearing_ ? tearing_->bend_links() : nullptr; }
  std::size_t bytes() const;

 private:
  void make_tearing();
  void choose_stages();
  void choose_forces();
  void choose_projections();
  void choose_contact();
  // Appends a stage or, where there is none, tells why.
  void choose(const char* name, std::unique_ptr<Stage> stage, const char* why_not);
  void make_schedule();

  const Cloth& cloth_;
  Method method_;
  const std::uint64_t seed_;
  std::vector<Stencil> stencils_;
  Lattice lattice_;
  std::vector<StartInside> starts_;
  ClothParts parts_;
  std::unique_ptr<Multipliers> multipliers_;
  std::unique_ptr<Rows> corrections_;
  std::unique_ptr<History> history_;
  std::vector<std::uint8_t> overlong_;
  Stages stages_;
  std::vector<SkippedStage> skipped_;
  std::vector<const Stage*> added_;
  std::unique_ptr<Tearing> tearing_;
  std::unique_ptr<TearBoundary> tear_boundary_;
  std::unique_ptr<Schedule> schedule_;
};

std::vector<const ClothParts*> parts_of(const std::vector<std::unique_ptr<ClothStep>>& cloths);

// The stages of all cloths, and what all of them do without.
Plan describe(const std::vector<std::unique_ptr<ClothStep>>& cloths);

}  // namespace weft::physics
