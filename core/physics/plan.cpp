// Builds the step plan (plan.h).
#include "physics/plan.h"

#include <algorithm>

#include "physics/stages/plain_rows.h"

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
      families_(families_of(cloth_)),
      lattice_(make_lattice(cloth_, cloth_index, seed, keeps_previous(scene.solver, method))),
      parts_{scene, cloth_, method_, lattice_, families_, kernels, starts_} {
  for (const Collider& c : scene.colliders) starts_.push_back(start_inside(cloth_, lattice_, c, 0));
  const bool cut = std::any_of(scene.colliders.begin(), scene.colliders.end(),
                               [](const Collider& c) { return c.cuts; });
  if (cut || cloth_.tear_strain > 0) make_topology();
  choose_stages();
  make_passes();
}

void ClothStep::meet(std::size_t collider, const StartInside& inside) {
  starts_[collider] = inside;
  const Collider& c = parts_.scene.colliders[collider];
  for (const auto& stage : stages_) stage->follow(c);
}

// The same stages with masks.
void ClothStep::allow_tearing() {
  if (topology_) return;
  make_topology();
  choose_anew(method_);
}

void ClothStep::choose_anew(Method method) {
  method_ = method;
  Stages added;
  for (auto& s : stages_)
    if (std::find(added_.begin(), added_.end(), s.get()) != added_.end())
      added.push_back(std::move(s));
  stages_.clear();
  added_.clear();
  multipliers_.reset();
  corrections_.reset();
  history_.reset();
  overlong_.clear();
  choose_stages();
  make_passes();
  for (; !added.empty(); added.pop_back()) add_stage(std::move(added.back()));
}

void ClothStep::make_topology() {
  topology_ = std::make_unique<Topology>(lattice_, families_, cloth_.bending > 0);
  if (cloth_.tears == Tears::split) seams_ = std::make_unique<Seams>();
  parts_.topology = topology_.get();
}

const Seams* ClothStep::seams() {
  if (!seams_ || topology_->version() == 0) return nullptr;
  seams_->update(*topology_, lattice_);
  return seams_.get();
}

void ClothStep::make_passes() {
  passes_ = std::make_unique<Passes>(stages_, lattice_.rows, lattice_.bytes() / lattice_.rows);
}

void ClothStep::add_stage(std::unique_ptr<Stage> stage) {
  std::size_t at = 0;
  while (at < stages_.size() && stages_[at]->name != "springs" && stages_[at]->name != "predict")
    ++at;
  added_.push_back(stage.get());
  stages_.insert(stages_.begin() + std::ptrdiff_t(std::min(at + 1, stages_.size())),
                 std::move(stage));
  make_passes();
}

void ClothStep::remove_stage(const Stage* stage) {
  std::erase(added_, stage);
  std::erase_if(stages_, [&](const auto& s) { return s.get() == stage; });
  make_passes();
}

void ClothStep::choose_stages() {
  const ClothParts& parts = parts_;
  const Method method = method_;
  const Solver& solver = parts.scene.solver;
  if (cloth_.tear_strain > 0 && is_explicit(method) && is_plain(parts))
    overlong_.resize(std::size_t(lattice_.rows));
  parts_.overlong = overlong_.empty() ? nullptr : overlong_.data();
  auto bending = make_bending(parts, method);
  if (is_explicit(method)) {
    if (bending) stages_.push_back(std::move(bending));
    stages_.push_back(make_springs(parts, method == Method::spring_friction));
    if (auto wind = make_wind(parts, seed_)) stages_.push_back(std::move(wind));
    if (auto pins = make_keyed_pins(parts)) stages_.push_back(std::move(pins));
  } else {
    SweepOptions sweep;
    sweep.compliant = method == Method::compliant;
    const bool lines = solver.sweep == Sweep::line;
    if (sweep.compliant && !lines && solver.iterations > 1)
      multipliers_ = std::make_unique<Multipliers>(lattice_, families_.size());
    sweep.multipliers = multipliers_.get();
    if (sweep.compliant && solver.sweep != Sweep::jacobi && !lines)
      corrections_ = std::make_unique<Rows>(lattice_.rows, lattice_.stride);
    sweep.corrections = corrections_.get();
    if (solver.order == 2) history_ = std::make_unique<History>(lattice_);
    stages_.push_back(history_ ? make_predict_second_order(parts, *history_, multipliers_.get())
                               : make_predict(parts, multipliers_.get(), corrections_.get()));
    if (auto wind = make_wind(parts, seed_)) stages_.push_back(std::move(wind));
    if (auto pins = make_keyed_pins(parts)) stages_.push_back(std::move(pins));
    if (auto tethers = solver.tethers ? make_tethers(parts, sweep.compliant) : nullptr)
      stages_.push_back(std::move(tethers));
    if (lines) {
      const float share = sweep.compliant ? 1.0f : float(2 * cloth_.positional_k);
      if (auto line = make_line(parts, {sweep.compliant, solver.iterations, share}))
        stages_.push_back(std::move(line));
    }
    for (int n = 0; n < solver.iterations && !families_.empty() && !lines; ++n) {
      if (solver.sweep == Sweep::jacobi)
        stages_.push_back(make_jacobi(parts, sweep));
      else
        append_gauss_seidel(parts, sweep, stages_);
    }
    if (corrections_) stages_.push_back(make_corrections(parts, *corrections_));
    // What comes last stays as solved, and stretching undoes more of bending than that of stretching.
    if (bending) stages_.push_back(std::move(bending));
    if (history_)
      stages_.push_back(make_velocity_second_order(parts, *history_));
    else if (!sweep.compliant || lines)
      stages_.push_back(make_velocity(parts, sweep.compliant));
  }
  append_contact();
  if (cloth_.strain_limit > 0) {
    SweepOptions limit;
    limit.limit = cloth_.strain_limit;
    append_gauss_seidel(parts, limit, stages_);
  }
}

// Colliders, and what tears and cuts.
void ClothStep::append_contact() {
  for (int n = 0; n < parts_.scene.solver.collision_iterations; ++n)
    for (const Collider& c : parts_.scene.colliders) {
      if (c.cuts) continue;
      stages_.push_back(make_collider(parts_, c));
      if (auto faces = make_collider_faces(parts_, c)) stages_.push_back(std::move(faces));
    }
  if (!topology_) return;
  for (const Collider& c : parts_.scene.colliders)
    if (c.cuts) stages_.push_back(make_cut(parts_, c, *topology_));
  if (cloth_.tear_strain > 0) stages_.push_back(make_tear(parts_, *topology_));
}

std::size_t ClothStep::bytes() const {
  std::size_t bytes = lattice_.bytes() + (multipliers_ ? multipliers_->bytes() : 0) +
                      (corrections_ ? corrections_->bytes() : 0) +
                      (history_ ? history_->bytes() : 0);
  if (topology_) bytes += topology_->bytes() + overlong_.size();
  if (seams_) bytes += seams_->bytes();
  for (const auto& s : stages_) bytes += s->bytes();
  return bytes;
}

namespace {

void describe_skipped(const Scene& scene, Method method, Plan& plan) {
  const auto skip = [&](const char* name, const std::string& why) {
    plan.skipped.push_back({name, why});
  };
  const auto any = [&](auto&& has) {
    return std::any_of(scene.cloths.begin(), scene.cloths.end(), has);
  };
  if (is_explicit(method))
    skip("predict, sweeps, velocity", "springs are forces with this method");
  else
    skip("springs", "constraints are projected with this method");
  if (!any([](const Cloth& c) {
        return std::any_of(c.pins.begin(), c.pins.end(),
                           [](const Pin& p) { return !p.keys.empty(); });
      }))
    skip("keyed_pins", "no pin moves");
  if (!is_explicit(method)) {
    const Solver& s = scene.solver;
    if (!s.tethers)
      skip("tethers", "off in the scene");
    else if (std::all_of(scene.cloths.begin(), scene.cloths.end(),
                         [](const Cloth& c) { return c.pins.empty(); }))
      skip("tethers", "nothing is pinned");
    if (s.sweep != Sweep::line) skip("line", "sweep is not line");
    if (s.order != 2) skip("second order", "order is 1");
  }
  if (!any([](const Cloth& c) { return c.bending > 0; })) skip("bending", "bending is 0");
  if (scene.colliders.empty()) skip("collider", "the scene has none");
  const bool faces = std::any_of(plan.stages.begin(), plan.stages.end(),
                                 [](const PlannedStage& s) { return s.name == "collider_faces"; });
  if (!scene.colliders.empty() && !faces)
    skip("collider_faces", "no collider is small against the mesh");
  if (!any([](const Cloth& c) { return c.strain_limit > 0; }))
    skip("strain_limit", "strain_limit is 0");
  if (!any([](const Cloth& c) { return c.self_collision.mode != SelfCollisionMode::off; }))
    skip("self_collision", "off in the scene");
  if (!any([](const Cloth& c) { return c.tear_strain > 0; })) skip("tear", "tear_strain is 0");
  if (std::none_of(scene.colliders.begin(), scene.colliders.end(),
                   [](const Collider& c) { return c.cuts; }))
    skip("cut", "no collider cuts");
  if (scene.wind.drag == 0 && scene.wind.lift == 0) skip("wind", "drag and lift are 0");
  if (scene.solver.sleep == 0) skip("sleep", "sleep is 0");
}

}  // namespace

Plan describe(const Scene& scene, const std::vector<std::unique_ptr<ClothStep>>& cloths,
              int substeps) {
  Plan plan;
  plan.substeps = substeps;
  plan.dt = scene.time.frame / substeps;
  for (std::size_t c = 0; c < cloths.size(); ++c)
    for (const auto& s : cloths[c]->stages()) {
      const std::string which = cloths.size() > 1 ? "cloth " + std::to_string(c) + ": " : "";
      plan.stages.push_back({s->name, which + s->detail, double(substeps), s->items, s->item});
    }
  std::int64_t particles = 0;
  for (const Cloth& c : scene.cloths)
    if (c.self_collision.mode != SelfCollisionMode::off)
      particles += std::int64_t(c.grid.nx) * c.grid.ny;
  if (particles > 0)
    plan.stages.push_back({"self_collision", "all cloths together, as often as they move",
                           double(substeps), particles, "particles"});
  const bool surface = std::any_of(scene.cloths.begin(), scene.cloths.end(), [](const Cloth& c) {
    return c.self_collision.mode == SelfCollisionMode::surface;
  });
  if (surface)
    plan.stages.push_back(
        {"self_surface", "vertices against triangles, edges against edges; nothing passes through",
         double(substeps), particles, "squares"});
  else if (particles > 0)
    plan.skipped.push_back({"self_surface", "self_collision is particles in all cloths"});
  describe_skipped(scene, scene.solver.method, plan);
  return plan;
}

}  // namespace weft::physics
