// Builds the step plan (cloth_step.h).
#include "physics/frame/cloth_step.h"

#include <algorithm>

#include "physics/contact/collider_stage.h"
#include "physics/contact/start_inside.h"
#include "physics/model/lattice/plain_rows.h"

namespace weft::physics {
namespace {

// Whether a stage asks where particles were before the substep: velocities from positions, and the
// second order.
bool keeps_previous(const Solver& solver, Method method) {
  if (is_explicit(method)) return false;
  return method == Method::positional || solver.sweep == Sweep::line || solver.order == 2;
}

}  // namespace

ClothStep::ClothStep(const Scene& scene, int cloth_index, Method method, std::uint64_t seed,
                     const KernelTable& kernels)
    : cloth_(scene.cloths[cloth_index]),
      method_(method),
      seed_(seed),
      stencils_(stencils_of(cloth_)),
      lattice_(make_lattice(cloth_, cloth_index, seed, keeps_previous(scene.solver, method))),
      parts_{scene, cloth_, method_, lattice_, stencils_, kernels} {
  for (const Collider& c : scene.colliders) starts_.push_back(start_inside(cloth_, lattice_, c, 0));
  const bool cut = std::any_of(scene.colliders.begin(), scene.colliders.end(),
                               [](const Collider& c) { return c.cuts; });
  if (cut || cloth_.tear_strain > 0) make_tearing();
  choose_stages();
  make_schedule();
}

void ClothStep::meet(std::size_t collider, const StartInside& inside) {
  starts_[collider] = inside;
  const Collider& c = parts_.scene.colliders[collider];
  for (const auto& stage : stages_) stage->follow(c);
}

// The same stages with masks.
void ClothStep::allow_tearing() {
  if (tearing_) return;
  make_tearing();
  choose_anew(method_);
}

void ClothStep::choose_anew(Method method) {
  method_ = method;
  Stages added;
  for (auto& s : stages_)
    if (std::find(added_.begin(), added_.end(), s.get()) != added_.end())
      added.push_back(std::move(s));
  stages_.clear();
  skipped_.clear();
  added_.clear();
  multipliers_.reset();
  corrections_.reset();
  history_.reset();
  overlong_.clear();
  choose_stages();
  make_schedule();
  for (; !added.empty(); added.pop_back()) add_stage(std::move(added.back()));
}

void ClothStep::make_tearing() {
  tearing_ = std::make_unique<Tearing>(lattice_, stencils_, cloth_.bending > 0);
  if (cloth_.tears == Tears::split) tear_boundary_ = std::make_unique<TearBoundary>();
  parts_.tearing = tearing_.get();
}

const TearBoundary* ClothStep::tear_boundary() {
  if (!tear_boundary_ || tearing_->version() == 0) return nullptr;
  tear_boundary_->update(*tearing_, lattice_);
  return tear_boundary_.get();
}

void ClothStep::make_schedule() {
  schedule_ = std::make_unique<Schedule>(stages_, lattice_.rows, lattice_.bytes() / lattice_.rows);
}

void ClothStep::add_stage(std::unique_ptr<Stage> stage) {
  std::size_t at = 0;
  while (at < stages_.size() && !stages_[at]->moves_particles()) ++at;
  added_.push_back(stage.get());
  stages_.insert(stages_.begin() + std::ptrdiff_t(std::min(at + 1, stages_.size())),
                 std::move(stage));
  make_schedule();
}

void ClothStep::remove_stage(const Stage* stage) {
  std::erase(added_, stage);
  std::erase_if(stages_, [&](const auto& s) { return s.get() == stage; });
  make_schedule();
}

void ClothStep::choose(const char* name, std::unique_ptr<Stage> stage, const char* why_not) {
  if (stage)
    stages_.push_back(std::move(stage));
  else
    skipped_.push_back({name, why_not});
}

void ClothStep::choose_stages() {
  is_explicit(method_) ? choose_forces() : choose_projections();
  choose_contact();
  if (cloth_.strain_limit > 0) {
    SweepOptions limit;
    limit.limit = cloth_.strain_limit;
    append_gauss_seidel(parts_, limit, stages_);
  } else {
    skipped_.push_back({"strain_limit", "strain_limit is 0"});
  }
}

void ClothStep::choose_forces() {
  if (cloth_.tear_strain > 0 && is_plain(parts_)) overlong_.resize(std::size_t(lattice_.rows));
  parts_.overlong = overlong_.empty() ? nullptr : overlong_.data();
  skipped_.push_back({"predict, sweeps, velocity", "springs are forces with this method"});
  choose("bending", make_bending(parts_, method_), "bending is 0");
  stages_.push_back(make_springs(parts_, method_ == Method::spring_friction));
  choose("wind", make_wind(parts_, seed_), "drag and lift are 0");
  choose("keyed_pins", make_keyed_pins(parts_), "no pin moves");
}

void ClothStep::choose_projections() {
  const Solver& solver = parts_.scene.solver;
  parts_.overlong = nullptr;
  skipped_.push_back({"springs", "constraints are projected with this method"});
  SweepOptions sweep;
  sweep.compliant = method_ == Method::compliant;
  const bool lines = solver.sweep == Sweep::line;
  if (sweep.compliant && !lines && solver.iterations > 1)
    multipliers_ = std::make_unique<Multipliers>(lattice_, stencils_.size());
  sweep.multipliers = multipliers_.get();
  if (sweep.compliant && solver.sweep != Sweep::jacobi && !lines)
    corrections_ = std::make_unique<Rows>(lattice_.rows, lattice_.stride);
  sweep.corrections = corrections_.get();
  if (solver.order == 2)
    history_ = std::make_unique<History>(lattice_);
  else
    skipped_.push_back({"second order", "order is 1"});
  stages_.push_back(history_ ? make_predict_second_order(parts_, *history_, multipliers_.get())
                             : make_predict(parts_, multipliers_.get(), corrections_.get()));
  choose("wind", make_wind(parts_, seed_), "drag and lift are 0");
  choose("keyed_pins", make_keyed_pins(parts_), "no pin moves");
  choose("tethers", solver.tethers ? make_attachments(parts_, sweep.compliant) : nullptr,
         solver.tethers ? "nothing is pinned" : "off in the scene");
  if (lines) {
    const float share = sweep.compliant ? 1.0f : float(2 * cloth_.positional_k);
    choose("line", make_line(parts_, {sweep.compliant, solver.iterations, share}),
           "the cloth has no constraints");
  } else {
    skipped_.push_back({"line", "sweep is not line"});
    for (int n = 0; n < solver.iterations && !stencils_.empty(); ++n) {
      if (solver.sweep == Sweep::jacobi)
        stages_.push_back(make_jacobi(parts_, sweep));
      else
        append_gauss_seidel(parts_, sweep, stages_);
    }
  }
  if (corrections_) stages_.push_back(make_corrections(parts_, *corrections_));
  // What comes last stays as solved, and stretching undoes more of bending than that of stretching.
  choose("bending", make_bending(parts_, method_), "bending is 0");
  if (history_)
    stages_.push_back(make_velocity_second_order(parts_, *history_));
  else if (!sweep.compliant || lines)
    stages_.push_back(make_velocity(parts_, sweep.compliant));
}

// Colliders, and what tears and cuts.
void ClothStep::choose_contact() {
  const auto& colliders = parts_.scene.colliders;
  bool pushed = false, triangles = false, cut = false;
  for (int n = 0; n < parts_.scene.solver.collision_iterations; ++n)
    for (std::size_t k = 0; k < colliders.size(); ++k) {
      if (colliders[k].cuts) continue;
      stages_.push_back(make_collider(parts_, colliders[k], starts_[k]));
      pushed = true;
      if (auto stage = make_collider_triangles(parts_, colliders[k], starts_[k])) {
        stages_.push_back(std::move(stage));
        triangles = true;
      }
    }
  if (!pushed)
    skipped_.push_back({"collider", "the scene has none"});
  else if (!triangles)
    skipped_.push_back({"collider_faces", "no collider is small against the mesh"});
  for (std::size_t k = 0; k < colliders.size(); ++k) {
    if (!colliders[k].cuts) continue;
    stages_.push_back(make_cut(parts_, colliders[k], starts_[k], *tearing_));
    cut = true;
  }
  if (!cut) skipped_.push_back({"cut", "no collider cuts"});
  choose("tear", cloth_.tear_strain > 0 ? make_tear(parts_, *tearing_) : nullptr,
         "tear_strain is 0");
}

std::size_t ClothStep::bytes() const {
  std::size_t bytes = lattice_.bytes() + (multipliers_ ? multipliers_->bytes() : 0) +
                      (corrections_ ? corrections_->bytes() : 0) +
                      (history_ ? history_->bytes() : 0);
  if (tearing_) bytes += tearing_->bytes() + overlong_.size();
  if (tear_boundary_) bytes += tear_boundary_->bytes();
  for (const auto& s : stages_) bytes += s->bytes();
  return bytes;
}

std::vector<const ClothParts*> parts_of(const std::vector<std::unique_ptr<ClothStep>>& cloths) {
  std::vector<const ClothParts*> parts;
  for (const auto& step : cloths) parts.push_back(&step->parts());
  return parts;
}

Plan describe(const std::vector<std::unique_ptr<ClothStep>>& cloths) {
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
