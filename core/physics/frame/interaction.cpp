// What a hand does to a running simulation: grabbing, pinning, letting go.
#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/contact/colliders/shapes.h"
#include "physics/contact/start_inside.h"
#include "physics/frame/state.h"
#include "physics/model/path.h"

namespace weft {

using namespace physics;

ClothStep& Simulation::State::step_with(int cloth, int particle) {
  if (cloth < 0 || std::size_t(cloth) >= cloths.size())
    throw std::out_of_range("there is no cloth " + std::to_string(cloth));
  ClothStep& step = *cloths[std::size_t(cloth)];
  const int count = particles(std::size_t(cloth));
  if (particle < 0 || particle >= count)
    throw std::out_of_range("cloth " + std::to_string(cloth) + " has no particle " +
                            std::to_string(particle) + " (allowed: 0 to " +
                            std::to_string(count - 1) + ")");
  return step;
}

// A hand does something to a cloth, or to all.
void Simulation::State::touch(int cloth) {
  wake(cloth);
  guard_.interacted();
}

// The stages of a cloth have changed: their times start anew, and the plan tells what runs now.
void Simulation::State::plan_changed() {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (stage_ns[c].size() == cloths[c]->stages().size() &&
        options.profile == cloths[c]->schedule().profiled())
      continue;
    stage_ns[c] = std::vector<std::atomic<std::int64_t>>(cloths[c]->stages().size());
    if (options.profile) cloths[c]->schedule().profile(stage_ns[c]);
  }
  Plan now = describe_stages();
  now.dt_limit = plan.dt_limit;
  now.notes = plan.notes;
  now.fallback = plan.fallback;
  plan = std::move(now);
  take_substeps(substeps);
}

void Simulation::State::grab(int cloth, int particle, const Vec3& target, double stiffness) {
  ClothStep& step = step_with(cloth, particle);
  if (!(stiffness >= 0) ||
      !std::all_of(target.begin(), target.end(), [](double t) { return std::isfinite(t); }))
    throw std::invalid_argument("a grab needs a finite target and a stiffness of at least 0");
  if (grab_ && grabbed_ != cloth) release();
  if (!grab_) {
    auto stage = std::make_unique<Grab>(step.parts());
    grab_ = stage.get();
    grabbed_ = cloth;
    step.add_stage(std::move(stage));
    plan_changed();
  }
  touch(cloth);
  const Particles::Place place = step.particles().place(particle);
  const double stored = grab_->holds(place) ? grab_->energy() : 0;
  grab_->place = place;
  grab_->target = minus(target, origin);
  grab_->stiffness = stiffness;
  guard_.energy().put_in(std::max(0.0, grab_->energy() - stored));
  if (is_explicit(method)) follow_stretch(stretched_limit());
}

void Simulation::State::release() {
  if (!grab_) return;
  touch(grabbed_);
  cloths[std::size_t(grabbed_)]->remove_stage(grab_);
  grab_ = nullptr;
  plan_changed();
}

// Before a snapshot, of which no hand is a part, is put back.
void Simulation::State::let_go() {
  if (grab_) cloths[std::size_t(grabbed_)]->remove_stage(grab_);
  grab_ = nullptr;
  for (std::size_t c = 0; c < cloths.size(); ++c)
    if (carried_[c]) cloths[c]->remove_stage(std::exchange(carried_[c], nullptr));
}

void Simulation::State::carry(int cloth, const Vec3& velocity) {
  ClothStep& step = step_with(cloth, 0);
  if (!std::all_of(velocity.begin(), velocity.end(),
                   [](double u) { return std::abs(u) <= kFarAway; }))
    throw std::invalid_argument("held particles are carried at up to 1e7 m/s each way");
  touch(cloth);
  Carry*& stage = carried_[std::size_t(cloth)];
  const bool rests = velocity == Vec3{};
  if (!stage && !rests) {
    auto made = std::make_unique<Carry>(step.parts());
    stage = made.get();
    step.add_stage(std::move(made));
    plan_changed();
  }
  if (stage && !rests) {
    stage->begin(double(frame) * scene.time.frame, velocity);
    guard_.energy().drive(stage->speed());
  }
  if (!stage || !rests) return;
  step.remove_stage(stage);
  stage = nullptr;
  Particles& p = step.particles();
  p.for_each([&](int j, int i) {
    for (int k = 0; k < 3; ++k)
      if (p.w(j, i) == 0) p.v.at(k, j, i) = 0;
  });
  plan_changed();
}

void Simulation::State::hold(int cloth, int particle, bool held) {
  ClothStep& step = step_with(cloth, particle);
  Particles& p = step.particles();
  const auto [j, i] = p.place(particle);
  touch(cloth);
  p.set_inverse_mass(j, i, held ? 0 : float(1 / step.model().mass(particle)));
  if (held)
    for (int k = 0; k < 3; ++k) p.v.at(k, j, i) = 0;
  if (sleeping) sleeping->keep_masses(cloth);
  step.restart();
  // One particle more that can move raises the largest frequency, if at all.
  const auto c = std::size_t(cloth);
  if (!held && is_explicit(method)) spectra[c] = step.model().spectrum(masses(c).span());
  open_guard();
  ++changes;
}

void Simulation::State::move_collider(int collider, const Vec3& target) {
  if (collider < 0 || std::size_t(collider) >= scene.colliders.size())
    throw std::out_of_range("there is no collider " + std::to_string(collider));
  if (!std::all_of(target.begin(), target.end(), [](double t) { return std::isfinite(t); }))
    throw std::invalid_argument("a collider's target is finite");
  const Collider& c = where_it_stands().colliders[std::size_t(collider)];
  const double now = double(frame) * scene.time.frame;
  const Vec3 from = c.keys.empty() ? place_of(c.shape) : position_at(c.keys, now);
  touch();
  set_path(std::size_t(collider), {{now, from}, {now + scene.time.frame, target}});
  const Vec3 way = minus(target, from);
  guard_.energy().drive(std::sqrt(dot(way, way)) / scene.time.frame);
}

// A collider goes another way, by keys where it stands.
void Simulation::State::set_path(std::size_t collider, std::vector<Key> keys) {
  if (placed) placed->colliders[collider].keys = keys;
  for (Key& key : keys) key.position = minus(key.position, origin);
  Collider& c = scene.colliders[collider];
  c.keys = std::move(keys);
  for (auto& step : cloths)
    for (const auto& stage : step->stages()) stage->follow(c);
}

// Whatever lies inside a collider now is moved out as gently as at a start.
void Simulation::State::meet(std::size_t collider) {
  for (auto& step : cloths)
    step->meet(collider, start_inside(step->parts(), scene.colliders[collider],
                                      double(frame) * scene.time.frame));
}

void Simulation::State::note_once(const std::string& note) {
  std::vector<std::string>& notes = plan.notes;
  if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
}

int Simulation::State::cut(const Vec3& begin, const Vec3& end, double width) {
  const Vec3 a = minus(begin, origin), d = minus(end, begin);
  std::int64_t cut = 0;
  for (auto& step : cloths) {
    const std::vector<Joined> found = step->model().constraints_near(a, d, width);
    if (found.empty()) continue;
    const bool could_tear = step->model().tearing();
    step->allow_tearing();
    if (!step->model().tearing()) {
      note_once("what is cut holds a gas and does not tear: nothing of it was cut");
      continue;
    }
    touch();
    if (!could_tear) {
      plan_changed();
      note_models(plan.notes);
    }
    cut += step->model().tearing()->end_all(found);
  }
  if (cut > 0) ++changes;
  return int(cut);
}

}  // namespace weft
