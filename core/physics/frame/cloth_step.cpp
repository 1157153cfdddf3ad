// Builds the step plan (cloth_step.h).
#include "physics/frame/cloth_step.h"

#include <algorithm>
#include <optional>

#include "physics/contact/collider_stage.h"
#include "physics/contact/start_inside.h"

namespace weft::physics {

ClothStep::ClothStep(const Scene& scene, int cloth_index, Method method, std::uint64_t seed,
                     const KernelTable& kernels, MakeModel make)
    : method_(method), model_(make(scene, cloth_index, method, seed, kernels)) {
  for (const Collider& c : scene.colliders) starts_.push_back(start_inside(parts(), c, 0));
  choose_stages();
  make_schedule();
}

void ClothStep::meet(std::size_t collider, const StartInside& inside) {
  starts_[collider] = inside;
  const Collider& c = parts().scene.colliders[collider];
  for (const auto& stage : stages()) stage->follow(c);
}

// The same stages with masks.
void ClothStep::allow_tearing() {
  if (model_->tearing()) return;
  model_->allow_tearing();
  if (model_->tearing()) choose_anew(method_);
}

void ClothStep::choose_anew(Method method) {
  method_ = method;
  Stages added;
  for (auto& s : list_.stages)
    if (std::find(added_.begin(), added_.end(), s.get()) != added_.end())
      added.push_back(std::move(s));
  list_ = {};
  added_.clear();
  choose_stages();
  make_schedule();
  for (; !added.empty(); added.pop_back()) add_stage(std::move(added.back()));
}

bool ClothStep::take_substep(double dt) {
  const bool others = model_->take_substep(dt);
  if (others) choose_anew(method_);
  return others;
}

void ClothStep::make_schedule() {
  const Particles& p = particles();
  schedule_ = std::make_unique<Schedule>(
      list_.stages, p.rows, p.bytes() / std::size_t(p.rows),
      sheets_meet_first() ? std::optional(motion_stages()) : std::nullopt);
}

std::size_t ClothStep::motion_stages() const {
  return std::size_t(std::find_if(stages().begin(), stages().end(),
                                  [&](const auto& s) { return s.get() == after_motion_; }) -
                     stages().begin());
}

// As in the course where all sheets that meet do so by its rule: then a strain limit has the last word.
bool ClothStep::sheets_meet_first() const {
  bool course = false;
  for (const Cloth& c : parts().scene.cloths) {
    if (c.self_collision.mode == SelfCollisionMode::off) continue;
    if (c.self_collision.response != SelfCollisionResponse::course) return false;
    course = true;
  }
  return course;
}

int ClothStep::reach() const {
  int reach = 0;
  for (const auto& stage : stages())
    if (const RowStage* rows = stage->as_row_stage()) reach = std::max(reach, rows->reach);
  return reach;
}

void ClothStep::add_stage(std::unique_ptr<Stage> stage) {
  Stages& stages = list_.stages;
  std::size_t at = 0;
  while (at < stages.size() && !stages[at]->moves_particles()) ++at;
  added_.push_back(stage.get());
  stages.insert(stages.begin() + std::ptrdiff_t(std::min(at + 1, stages.size())), std::move(stage));
  make_schedule();
}

void ClothStep::remove_stage(const Stage* stage) {
  std::erase(added_, stage);
  std::erase_if(list_.stages, [&](const auto& s) { return s.get() == stage; });
  make_schedule();
}

void ClothStep::restart() {
  for (const auto& stage : stages()) stage->restart();
}

void ClothStep::choose_stages() {
  model_->append_motion(method_, list_);
  const std::size_t motion = list_.stages.size();
  choose_contact();
  model_->append_limits(list_);
  after_motion_ = motion < list_.stages.size() ? list_.stages[motion].get() : nullptr;
}

// Colliders, and what cuts.
void ClothStep::choose_contact() {
  const auto& colliders = parts().scene.colliders;
  LatticeParts* const lattice = model_->lattice();
  bool pushed = false, small = false, stretched = false, cut = false, damped = false;
  for (std::size_t k = 0; k < colliders.size(); ++k)
    if (auto layer = make_friction_layer(parts(), colliders[k], starts_[k])) {
      list_.stages.push_back(std::move(layer));
      damped = true;
    }
  if (!damped) list_.skip("friction_layer", "no collider's friction damps");
  for (int n = 0; n < parts().scene.solver.collision_iterations; ++n)
    for (std::size_t k = 0; k < colliders.size(); ++k) {
      if (colliders[k].cuts) continue;
      auto particles = make_collider(parts(), colliders[k], starts_[k]);
      const SpeculativeCulling& far = particles->far();
      Stages faces = lattice ? make_collider_triangles(*lattice, colliders[k], starts_[k], far)
                             : make_collider_triangles(parts(), colliders[k], starts_[k], far);
      list_.stages.push_back(std::move(particles));
      if (!faces.empty()) (resolves(cloth(), colliders[k]) ? stretched : small) = true;
      std::move(faces.begin(), faces.end(), std::back_inserter(list_.stages));
      pushed = true;
    }
  if (!pushed) list_.skip("collider", "the scene has none");
  if (pushed && !small)
    list_.skip("collider_faces", "no collider is small against the mesh at rest");
  if (pushed && !stretched)
    list_.skip("stretched_faces", "no collider is curved and large against the mesh");
  MeshTearing* const mesh = model_->mesh_tearing();
  for (std::size_t k = 0; (lattice || mesh) && k < colliders.size(); ++k) {
    if (!colliders[k].cuts) continue;
    list_.stages.push_back(lattice ? make_cut(*lattice, colliders[k], starts_[k])
                                   : make_cut(parts(), *mesh, colliders[k], starts_[k]));
    cut = true;
  }
  if (!cut) list_.skip("cut", "no collider cuts");
}

std::size_t ClothStep::bytes() const {
  std::size_t bytes = model_->bytes();
  for (const auto& s : stages()) bytes += s->bytes();
  return bytes;
}

std::vector<ClothModel*> models_of(const Cloths& cloths) {
  std::vector<ClothModel*> models;
  for (const auto& step : cloths) models.push_back(&step->model());
  return models;
}

Plan describe(const Cloths& cloths) {
  Plan plan;
  for (std::size_t c = 0; c < cloths.size(); ++c)
    for (const auto& s : cloths[c]->stages()) {
      const std::string which = cloths.size() > 1 ? "cloth " + std::to_string(c) + ": " : "";
      plan.stages.push_back({s->name, which + s->detail, 0, s->items, s->item});
    }
  // What one cloth does without another may need.
  for (const SkippedStage& stage : cloths.front()->skipped()) {
    const auto skips = [&](const auto& step) {
      return std::any_of(step->skipped().begin(), step->skipped().end(),
                         [&](const SkippedStage& other) { return other.name == stage.name; });
    };
    if (std::all_of(cloths.begin(), cloths.end(), skips)) plan.skipped.push_back(stage);
  }
  return plan;
}

}  // namespace weft::physics
