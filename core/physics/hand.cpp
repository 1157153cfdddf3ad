// What a hand does to a running simulation: grabbing, pinning, letting go.
#include <algorithm>
#include <cmath>

#include "physics/state.h"

namespace weft {

using namespace physics;

ClothStep& Simulation::State::step_with(int cloth, int i, int j) {
  if (cloth < 0 || std::size_t(cloth) >= cloths.size())
    throw std::out_of_range("there is no cloth " + std::to_string(cloth));
  ClothStep& step = *cloths[std::size_t(cloth)];
  if (i < 0 || j < 0 || i >= step.lattice().columns || j >= step.lattice().rows)
    throw std::out_of_range("cloth " + std::to_string(cloth) + " has no particle [" +
                            std::to_string(i) + ", " + std::to_string(j) + "]");
  return step;
}

// The stages of a cloth have changed: their times start anew, and the plan tells what runs now.
void Simulation::State::plan_changed() {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (stage_ns[c].size() == cloths[c]->stages().size()) continue;
    stage_ns[c] = std::vector<std::atomic<std::int64_t>>(cloths[c]->stages().size());
    if (options.profile) cloths[c]->passes().profile(stage_ns[c]);
  }
  Scene as_run = scene;
  as_run.solver.method = method;
  Plan now = describe(as_run, cloths, substeps);
  now.dt_limit = plan.dt_limit;
  now.notes = plan.notes;
  plan = std::move(now);
}

void Simulation::State::grab(int cloth, int i, int j, const Vec3& target, double stiffness) {
  ClothStep& step = step_with(cloth, i, j);
  if (!(stiffness >= 0) || !std::all_of(target.begin(), target.end(), [](double t) { return std::isfinite(t); }))
    throw std::invalid_argument("a grab needs a finite target and a stiffness of at least 0");
  if (grab_ && grabbed_ != cloth) release();
  if (!grab_) {
    auto stage = std::make_unique<Grab>(step.parts());
    grab_ = stage.get();
    grabbed_ = cloth;
    step.add_stage(std::move(stage));
    plan_changed();
  }
  grab_->column = i;
  grab_->row = j;
  grab_->target = target;
  grab_->stiffness = stiffness;
}

void Simulation::State::release() {
  if (!grab_) return;
  cloths[std::size_t(grabbed_)]->remove_stage(grab_);
  grab_ = nullptr;
  plan_changed();
}

void Simulation::State::hold(int cloth, int i, int j, bool held) {
  ClothStep& step = step_with(cloth, i, j);
  Lattice& l = step.lattice();
  l.w(j)[i] = held ? 0 : float(1 / particle_mass(step.cloth(), i, j));
  if (held)
    for (int k = 0; k < 3; ++k) l.v.at(k, j, i) = 0;
  // One particle more that can move raises the largest frequency, if at all.
  if (!held && is_explicit(method))
    spectra[std::size_t(cloth)] = estimate_spectrum(step.cloth(), step.families(), l,
                                                    method == Method::spring_friction);
  ++changes;
}

}  // namespace weft
