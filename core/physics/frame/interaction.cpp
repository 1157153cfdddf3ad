// What a hand does to a running simulation: grabbing, pinning, letting go.
#include <algorithm>
#include <cmath>

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
  since_hand_ = 0;
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

void Simulation::State::grab(int cloth, int particle, const Vec3& target,
                             double stiffness) {
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
  const int row = particle / step.lattice().columns, column = particle % step.lattice().columns;
  const double stored = grab_->column == column && grab_->row == row ? grab_->energy() : 0;
  grab_->column = column;
  grab_->row = row;
  grab_->target = minus(target, origin);
  grab_->stiffness = stiffness;
  guard_.put_in(std::max(0.0, grab_->energy() - stored));
  if (is_explicit(method)) follow_stretch(stretched_limit());
}

void Simulation::State::release() {
  if (!grab_) return;
  touch(grabbed_);
  cloths[std::size_t(grabbed_)]->remove_stage(grab_);
  grab_ = nullptr;
  plan_changed();
}

void Simulation::State::carry(int cloth, const Vec3& velocity) {
  ClothStep& step = step_with(cloth, 0);
  if (!std::all_of(velocity.begin(), velocity.end(), [](double u) { return std::isfinite(u); }))
    throw std::invalid_argument("held particles are carried at a finite velocity");
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
    guard_.drive(stage->speed());
  }
  if (!stage || !rests) return;
  step.remove_stage(stage);
  stage = nullptr;
  Lattice& l = step.lattice();
  for (int j = 0; j < l.rows; ++j)
    for (int i = 0; i < l.columns; ++i)
      for (int k = 0; k < 3; ++k)
        if (l.w(j, i) == 0) l.v.at(k, j, i) = 0;
  plan_changed();
}

void Simulation::State::hold(int cloth, int particle, bool held) {
  ClothStep& step = step_with(cloth, particle);
  Lattice& l = step.lattice();
  const int i = particle % l.columns, j = particle / l.columns;
  touch(cloth);
  l.set_inverse_mass(j, i, held ? 0 : float(1 / particle_mass(step.cloth(), i, j)));
  if (held)
    for (int k = 0; k < 3; ++k) l.v.at(k, j, i) = 0;
  if (sleeping) sleeping->keep_masses(cloth);
  for (const auto& stage : step.stages()) stage->restart();
  // One particle more that can move raises the largest frequency, if at all.
  if (!held && is_explicit(method)) spectra[std::size_t(cloth)] = spectrum_of(std::size_t(cloth));
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
  guard_.drive(std::sqrt(dot(way, way)) / scene.time.frame);
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
    step->meet(collider, start_inside(step->cloth(), step->lattice(), scene.colliders[collider],
                                      double(frame) * scene.time.frame));
}

namespace {

// Least squared distance between segments p + s d and q + t e, 0 <= s, t <= 1 (Ericson 5.1.9).
double segment_distance(const Vec3& p, const Vec3& d, const Vec3& q, const Vec3& e) {
  const Vec3 r = minus(p, q);
  const double a = dot(d, d), b = dot(d, e), c = dot(d, r), f = dot(e, r);
  const double h = std::max(dot(e, e), 1e-300), denominator = a * h - b * b;
  double s = denominator > 1e-12 * a * h ? std::clamp((b * f - c * h) / denominator, 0.0, 1.0) : 0;
  double t = (b * s + f) / h;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / std::max(a, 1e-300), 0.0, 1.0);
  }
  const Vec3 apart = minus(plus(p, times(d, s)), plus(q, times(e, t)));
  return std::sqrt(dot(apart, apart));
}

}  // namespace

int Simulation::State::cut(const Vec3& begin, const Vec3& end, double width) {
  const Vec3 a = minus(begin, origin), d = minus(end, begin);
  std::int64_t cut = 0;
  for (auto& step : cloths) {
    const Lattice& l = step->lattice();
    const auto at = [&](int j, int i) {
      return Vec3{l.x.at(0, j, i), l.x.at(1, j, i), l.x.at(2, j, i)};
    };
    std::vector<std::array<int, 3>> found;  // stencil, row, constraint
    for (std::size_t n = 0; n < step->stencils().size(); ++n) {
      const Stencil& f = step->stencils()[n];
      for (int j = 0; j + f.dj < l.rows; ++j)
        for (int k = 0; k < f.per_row(l.columns); ++k) {
          const Vec3 from = at(j, k + f.near());
          if (f.alive(j, k) &&
              segment_distance(a, d, from, minus(at(j + f.dj, k + f.far()), from)) <= width)
            found.push_back({int(n), j, k});
        }
    }
    if (found.empty()) continue;
    touch();
    if (!step->tearing()) {
      step->allow_tearing();
      plan_changed();
    }
    const std::int64_t before = step->tearing()->torn();
    for (const auto& [n, j, k] : found)
      step->tearing()->end(step->stencils()[std::size_t(n)], j, k);
    step->tearing()->update();
    cut += step->tearing()->torn() - before;
  }
  if (cut > 0) ++changes;
  return int(cut);
}

}  // namespace weft
