// The step plan: from a scene, the stages that it needs, each an instance of exactly the features in
// use. What a scene does not need is not in the plan, holds no memory and costs nothing.
//
// A frame is `substeps` substeps. In each, the stages of one cloth run from top to bottom, here with all that
// any scene can need. First its model moves it (*: meshes alone):
//
//   spring, spring_friction                     positional, compliant
//
//   pressure*    kicks v                        predict     kicks v by gravity, moves x
//   bending      kicks v                        pressure*   moves x and v
//   springs      kick v by forces, move x       wind        moves x and v
//   wind                                        keyed_pins
//   keyed_pins                                  tethers     gather corrections
//   sewing*                                     sweeps      gather corrections; Jacobi's move x and v
//                                               bending     gathers corrections
//                                               velocity    x and v gain the corrections
//                                               sewing*
//
// `membrane` stands in the place of springs, and `triangles` of meshes in that of springs and bending. What a
// person does comes right after springs or predict. Then, with every method:
//
//   friction_layer   of every collider whose friction damps
//   collider         of every collider that pushes, its triangles (collider_faces or stretched_faces, and of meshes
//                    lifted_faces) right after it; all of this as often as the solver's collision_iterations say
//   cut              of every collider that cuts
//   tear
//   strain_limit
//   sewing*          closes seams that the stages since have parted
//
// Where nothing follows velocity, it waits for the last substep, and predict adds to v itself.
// Contact between sheets comes after all of these, or, as in the course (seeds 001, 004), before the colliders.
// After every stage from springs or velocity on, x - dt v is the position before the substep:
// contact and the strain limit change x and v together.
#pragma once

#include <memory>
#include <vector>

#include "physics/contact/moving_collider.h"
#include "physics/model/cloth_model.h"
#include "physics/step/schedule.h"
#include "weft/report.h"

namespace weft::physics {

// One cloth's share of the plan: its model's stages, those of contact with bodies, and their schedule.
class ClothStep {
 public:
  ClothStep(const Scene& scene, int cloth_index, Method method, std::uint64_t seed,
            const KernelTable& kernels, MakeModel make = make_model);

  ClothModel& model() { return *model_; }
  const ClothModel& model() const { return *model_; }
  const ClothParts& parts() const { return model_->parts(); }
  const Cloth& cloth() const { return parts().cloth; }
  Particles& particles() { return model_->particles(); }
  const Particles& particles() const { return model_->particles(); }
  // Of every collider of the scene.
  const std::vector<StartInside>& starts() const { return starts_; }
  // The cloth meets a collider anew.
  void meet(std::size_t collider, const StartInside& inside);
  const Stages& stages() const { return list_.stages; }
  // Whether contact between sheets comes before bodies and the limit, and so between the schedule's two parts.
  bool sheets_meet_first() const;
  // How many stages come before bodies.
  std::size_t motion_stages() const;
  // What the cloth does without, and why.
  const std::vector<SkippedStage>& skipped() const { return list_.skipped; }
  Schedule& schedule() { return *schedule_; }
  // The most rows that a stage reaches beyond its own.
  int reach() const;
  // Puts a stage right after the one that moves the particles; takes it away again.
  void add_stage(std::unique_ptr<Stage> stage);
  void remove_stage(const Stage* stage);
  // Forgets what stages keep from one substep to the next.
  void restart();
  // Chooses the stages anew for this method and the scene's solver as it is now. Added stages stay;
  // what the others carry from substep to substep starts anew.
  void choose_anew(Method method);
  // Substeps have this length from now on [s]; whether the stages were chosen anew for that.
  bool take_substep(double dt);
  // Lets a cloth tear from now on.
  void allow_tearing();
  std::size_t bytes() const;

 private:
  void choose_stages();
  void choose_contact();
  void make_schedule();

  Method method_;
  std::unique_ptr<ClothModel> model_;
  std::vector<StartInside> starts_;
  StageList list_;
  const Stage* after_motion_ = nullptr;  // the first stage; null: none
  std::vector<const Stage*> added_;
  std::unique_ptr<Schedule> schedule_;
};

using Cloths = std::vector<std::unique_ptr<ClothStep>>;

// What the cloths are made of, for contact between sheets.
std::vector<ClothModel*> models_of(const Cloths& cloths);

// The stages of all cloths, and what all of them do without.
Plan describe(const Cloths& cloths);

}  // namespace weft::physics
