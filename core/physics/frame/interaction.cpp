// What a hand does to a running simulation: grabbing, pinning, letting go.
#include <algorithm>
#include <cmath>
#include <utility>

#include "physics/contact/colliders/shapes.h"
#include "physics/contact/start_inside.h"
#include "physics/frame/state.h"
#include "physics/model/placement.h"
#include "weft/shape.h"

namespace weft {

using namespace physics;

ClothStep& Simulation::State::step_with(int cloth, int particle) {
  if (cloth < 0 || std::size_t(cloth) >= cloths.size())
    throw std::out_of_range("there is no cloth " + std::to_string(cloth));
  ClothStep& step = *cloths[std::size_t(cloth)];
  const int count = step.particles().count();
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

void Simulation::State::grab(int cloth, int particle, const Vec3& target, double stiffness) {
  ClothStep& step = step_with(cloth, particle);
  if (!(stiffness >= 0) ||
      !std::all_of(target.begin(), target.end(), [](double t) { return std::isfinite(t); }))
    throw std::invalid_argument("a grab needs a finite target and a stiffness of at least 0");
  const int grabbed = hands_.grabbed();
  if (grabbed >= 0 && grabbed != cloth) release();
  touch(cloth);
  const double stored = hands_.grab(cloth, step.particles().place(particle),
                                    minus(target, placed.origin()), stiffness);
  guard_.energy().put_in(stored);
  if (grabbed != cloth) plan_changed();
  if (is_explicit(time_step.method)) follow_stretch(stretched_limit());
}

void Simulation::State::release() {
  if (hands_.grabbed() < 0) return;
  touch(hands_.grabbed());
  hands_.release();
  plan_changed();
}

void Simulation::State::carry(int cloth, const Vec3& velocity) {
  ClothStep& step = step_with(cloth, 0);
  if (!std::all_of(velocity.begin(), velocity.end(),
                   [](double u) { return std::abs(u) <= kFarAway; }))
    throw std::invalid_argument("held particles are carried at up to 1e7 m/s each way");
  const bool carried = hands_.carries(std::size_t(cloth));
  const bool rests = velocity == Vec3{};
  if (rests && !carried) return;
  touch(cloth);
  if (!rests) guard_.energy().drive(hands_.carry(cloth, velocity, time()));
  if (rests && carried) {
    hands_.put_down(cloth);
    Particles& p = step.particles();
    p.for_each([&](int j, int i) {
      for (int k = 0; k < 3; ++k)
        if (p.w(j, i) == 0) p.v.at(k, j, i) = 0;
    });
  }
  if (hands_.carries(std::size_t(cloth)) != carried) plan_changed();
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
  if (!held && is_explicit(time_step.method))
    time_step.spectra[c] = step.model().spectrum(masses(c).span());
  open_guard();
  ++changes;
}

void Simulation::State::move_collider(int collider, const Vec3& target) {
  if (collider < 0 || std::size_t(collider) >= scene.colliders.size())
    throw std::out_of_range("there is no collider " + std::to_string(collider));
  if (!std::all_of(target.begin(), target.end(), [](double t) { return std::isfinite(t); }))
    throw std::invalid_argument("a collider's target is finite");
  const Collider& c = placed.given().colliders[std::size_t(collider)];
  const double now = time();
  const Vec3 from = c.keys.empty() ? place_of(c.shape) : position_at(c.keys, now);
  touch();
  // By as much as its turn has taken it off its path until then.
  const double later = now + scene.time.frame;
  const Vec3 off = minus(displacement(c, later), along_keys(c, later));
  const Vec3 to = minus(target, off), way = minus(to, from);
  set_path(std::size_t(collider), {{now, from}, {later, to}});
  guard_.energy().drive(length(way) / scene.time.frame);
}

// A collider goes another way, by keys where it stands.
void Simulation::State::set_path(std::size_t collider, std::vector<Key> keys) {
  placed.set_path(collider, std::move(keys));
  for (auto& step : cloths)
    for (const auto& stage : step->stages()) stage->follow(scene.colliders[collider]);
}

// Whatever lies inside a collider now is moved out as gently as at a start.
void Simulation::State::meet(std::size_t collider) {
  for (auto& step : cloths)
    step->meet(collider, start_inside(step->parts(), scene.colliders[collider], time()));
}

int Simulation::State::cut(const Vec3& begin, const Vec3& end, double width) {
  const Vec3 a = minus(begin, placed.origin()), d = minus(end, begin);
  std::int64_t cut = 0;
  for (auto& step : cloths) {
    const std::vector<Joined> found = step->model().constraints_near(a, d, width);
    if (found.empty()) continue;
    const bool could_tear = step->model().tearing();
    step->allow_tearing();
    if (!step->model().tearing()) {
      add_once(plan.notes, "what is cut holds a gas and does not tear: nothing of it was cut");
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
