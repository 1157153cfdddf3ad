// How many substeps a frame takes: from the stability limit, following the sheet's stretch, and more
// where a frame left the limit or gained energy from nowhere.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "physics/frame/measure.h"
#include "physics/frame/state.h"
#include "physics/model/clamp_to_int.h"
#include "physics/model/lattice/stability.h"

namespace weft {

using namespace physics;

namespace {

constexpr int kMostSubsteps = 100000;  // per frame, flat; stretch may ask for 1.4 times as many
constexpr double kGrabbed = 1.6;       // on ω², at least: room for what a hand may do in a frame

// What folds onto a line that stretches nothing has up to twice the flat sheet's ω², and no stretch adds
// to that (a sheet without shear springs, or with nothing else).
constexpr double kFolded = 2;

struct StableSubsteps {
  double largest = std::numeric_limits<double>::infinity();  // s, of all cloths as they lie
  double safe = largest;  // s; also where cloth that resists no pressing folds
};
StableSubsteps stable_substeps(const Cloths& cloths, std::span<const Spectrum> spectra) {
  StableSubsteps stable;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    stable.largest = std::min(stable.largest, spectra[c].largest_substep());
    Spectrum folded = spectra[c];
    if (cloths[c]->model().folds_freely()) folded.omega_squared *= kFolded;
    stable.safe = std::min(stable.safe, folded.largest_substep());
  }
  return stable;
}

bool holds_gas(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(),
                     [](const Cloth& c) { return c.pressure.given(); });
}

}  // namespace

void Simulation::State::estimate_spectra() {
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    spectra.push_back(cloths[c]->model().spectrum(masses(c).span()));
    spectra.back().drag = scene.cloths[c].drag;
  }
}

// Explicit springs: the substep from the stability limit, or the user's if it is inside; beyond it,
// the compliant method in their place, which is stable at any substep.
void Simulation::State::choose_method_and_substeps() {
  std::vector<std::string> notes;
  note_starts(notes);
  if (sleeping)
    notes.push_back("what stays slower than " + number(scene.solver.sleep) +
                    " m/s for half a second sleeps");
  else if (scene.solver.sleep > 0)
    notes.push_back("nothing sleeps: gusts or loads over time move the cloth");
  int count = scene.time.substeps;
  double limit = 0;
  if (is_explicit(method) && scene.solver.iterations > 1 && !scene.solver.iterate_springs)
    notes.push_back("iterations is " + std::to_string(scene.solver.iterations) +
                    ", which does nothing here: springs have no iterations (iterate_springs adds "
                    "their forces so many times)");
  if (is_explicit(method)) {
    estimate_spectra();
    const StableSubsteps stable = stable_substeps(cloths, spectra);
    limit = stable.largest;
    const double needed = std::ceil(scene.time.frame / (kLimitShare * stable.safe));
    const bool resolved = needed <= kMostSubsteps && kLimitShare * stable.safe >= kLeastSubstep;
    if (count == kAutoSubsteps && resolved) {
      count = clamp_to_int(needed, 1, kMostSubsteps);
      notes.push_back(std::isfinite(limit)
                          ? "substeps from the stability limit of " + number(limit) + " s"
                          : "one substep a frame, since nothing is free to vibrate");
    } else if (!resolved || scene.time.frame / count > limit) {
      notes.push_back("springs need substeps below " + number(limit) + " s, " + number(needed) +
                      " a frame at " + number(kLimitShare) +
                      " of the limit; the compliant method runs in their place");
      method = Method::compliant;
      build_cloths();
    }
  }
  if (count == kAutoSubsteps) {
    count = projection_substeps();
    if (projection_substep(scene) < kLongestProjection)
      notes.push_back("substeps of " + number(scene.time.frame / count) +
                      " s, so that sweeps hold up a sheet that hangs by an edge" +
                      (holds_gas(scene) ? ", or hold a gas" : ""));
  } else if (const double needed = projection_substep(scene);
             !is_explicit(method) && holds_gas(scene) && scene.time.frame / count > needed) {
    notes.push_back("sweeps hold a gas in substeps of " + number(needed) + " s; in those of " +
                    number(scene.time.frame / count) +
                    " s it stretches the cloth more than it should");
  }
  note_models(notes);
  plan = describe_stages();
  plan.dt_limit = std::isfinite(limit) ? limit : 0;
  limit_ = limit;
  plan.fallback = method != scene.solver.method;
  plan.notes = std::move(notes);
  take_substeps(count);
  if (is_explicit(method)) {
    lag = dt / 2;
    if (!scene.solver.full_first_kick) stagger(lag);
  }
  open_guard();
}

void Simulation::State::take_substeps(int count) {
  substeps = count;
  dt = scene.time.frame / substeps;
  plan.substeps = substeps;
  plan.dt = dt;
  for (PlannedStage& s : plan.stages) s.calls_per_frame = substeps;
}

void Simulation::State::set_substeps(int count) {
  take_substeps(count);
  if (scene.time.substeps != kAutoSubsteps && count != scene.time.substeps)
    fall_back("springs need " + std::to_string(count) + " substeps a frame from frame " +
              std::to_string(frame + 1) + " on, as far as the sheet is stretched");
}

// Runs the frame again, if the verdict says so, or ends it; returns whether it runs again.
bool Simulation::State::carry_out(Verdict verdict) {
  const std::string which = "frame " + std::to_string(frame + 1);
  const int count = substeps;
  switch (verdict) {
    case Verdict::accept:
    case Verdict::stop:
      return false;
    case Verdict::clamp:
      for (auto& step : cloths) {
        step->particles().v.scale(float(guard_.energy().reduction()));
        step->restart();  // what stages keep of the motion
      }
      fall_back(which +
                " gained energy from nowhere; velocities were reduced to what is left without it");
      return false;
    case Verdict::unstable:
      fall_back(which +
                " is stretched beyond what any substep carries; its motion is not accurate");
      return false;
    case Verdict::change_method:
      restore();
      change_method(which, count);
      break;
    case Verdict::refine_to_limit:
      restore();
      set_substeps(substeps_within(limit_));
      break;
    case Verdict::refine:
      restore();
      take_substeps(2 * count);
      fall_back(which + " gained energy from nowhere; it and all after it run with more substeps");
      break;
  }
  restart_stages();
  return true;
}

// By a method that loses energy whatever the substep.
void Simulation::State::change_method(const std::string& which, int count) {
  const bool springs = is_explicit(method);
  Solver steady = scene.solver;
  steady.sweep = Sweep::gauss_seidel;
  steady.order = 1;
  plan.notes.push_back(
      which + " gained energy from nowhere with so many substeps too; from it on " +
      (springs ? "the compliant method runs" : "gauss_seidel sweeps run") + " in their place");
  plan.fallback = true;
  go_on_as(springs ? Method::compliant : method, steady);
  note_models(plan.notes);
  take_substeps(springs ? projection_substeps() : count);
  save();
}

void Simulation::State::note_models(std::vector<std::string>& notes) const {
  for (std::size_t c = 0; c < cloths.size(); ++c)
    for (const std::string& note : cloths[c]->model().notes()) {
      const std::string told = "cloth " + std::to_string(c) + ": " + note;
      if (std::find(notes.begin(), notes.end(), told) == notes.end()) notes.push_back(told);
    }
}

// As the run began, from the state as it is.
void Simulation::State::begin_again() {
  plan.notes = began_.notes;
  plan.notes.push_back("up to frame " + std::to_string(frame) +
                       " what a hand did took more substeps, or another method");
  plan.fallback = began_.fallback;
  restore(snapshot());
}

int Simulation::State::projection_substeps() const {
  if (scene.time.substeps != kAutoSubsteps) return scene.time.substeps;
  return clamp_to_int(std::round(scene.time.frame / projection_substep(scene)), 1, kMostSubsteps);
}

// Goes on from the state as it is by another method or solver.
void Simulation::State::go_on_as(Method as, const Solver& solver) {
  if (method == as && scene.solver == solver) return;
  const bool were_forces = is_explicit(method);
  if (were_forces && !is_explicit(as))
    for (std::size_t c = 0; c < cloths.size(); ++c) {
      Particles& p = cloths[c]->particles();
      const std::vector<Vec3> v = velocities_now(*this, c);
      p.for_each([&](int j, int i) {
        for (int k = 0; k < 3; ++k) p.v.at(k, j, i) = float(v[std::size_t(p.number(j, i))][k]);
      });
    }
  method = as;
  if (is_explicit(as))
    lag = dt / 2;
  else if (were_forces)
    lag = 0;
  scene.solver = solver;
  if (placed) placed->solver = solver;
  for (auto& step : cloths) step->choose_anew(method);
  plan_changed();
}

// Whether nothing but gravity and paths of pins can do work.
bool Simulation::State::nothing_else_acts() const {
  return !(grab_ || carried() || self_collision || blown() || sews() || loaded(false) ||
           !scene.colliders.empty() || !scene.gravity_keys.empty());
}

void Simulation::State::open_guard() {
  guard_.energy().open(scene, method, cloths, double(frame) * scene.time.frame, dt);
  for (const Carry* carry : carried_)
    if (carry) guard_.energy().drive(carry->speed());
  if (grab_) guard_.energy().put_in(grab_->energy());
}

bool Simulation::State::carried() const {
  return std::any_of(carried_.begin(), carried_.end(), [](const Carry* c) { return c; });
}

// Whether seams draw their ends together.
bool Simulation::State::sews() const {
  return std::any_of(cloths.begin(), cloths.end(),
                     [](const auto& step) { return step->model().open_seams().open > 0; });
}

// Whether a cloth has a load; `changing`: one that changes over time.
bool Simulation::State::loaded(bool changing) const {
  return std::any_of(cloths.begin(), cloths.end(), [&](const auto& step) {
    const Load* load = step->model().load();
    return load && (!changing || load->changes());
  });
}

bool Simulation::State::driven() const {
  const auto moves = [](const Collider& c) { return !c.keys.empty() || !c.animation.empty(); };
  const auto pulls = [](const Pin& pin) { return pin.moves(); };
  return grab_ || carried() || self_collision || !scene.gravity_keys.empty() || sleeping ||
         blown() || sews() || loaded(true) ||
         std::any_of(scene.colliders.begin(), scene.colliders.end(), moves) ||
         std::any_of(scene.cloths.begin(), scene.cloths.end(), [&](const Cloth& c) {
           return std::any_of(c.pins.begin(), c.pins.end(), pulls);
         });
}

void Simulation::State::fall_back(const std::string& note) {
  if (!plan.fallback) plan.notes.push_back(note);
  plan.fallback = true;
}

// Stretched springs resist sideways too, which raises the largest frequency:
// ω² <= ω²_flat + t (ω²_all - ω²_flat), t = max (1 - l/|e|).
double Simulation::State::stretched_limit() const {
  double limit = std::numeric_limits<double>::infinity();
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const ClothStep& step = *cloths[c];
    const float most = step.model().greatest_stretch(step.particles().x);
    double more = step.model().stiffening(std::sqrt(double(most)));
    if (grab_) more = std::max(more, kGrabbed);
    Spectrum stretched = spectra[c];
    stretched.omega_squared *= step.model().folds_freely() ? kFolded : more;
    if (const Load* load = step.model().load()) stretched.load = load->omega_squared();
    limit = std::min(limit, stretched.largest_substep());
  }
  return limit;
}

// Substeps a frame that stay inside a limit: a share of it where they are automatic, else as many as asked
// for or, where those are too few, a multiple.
int Simulation::State::substeps_within(double limit) const {
  const int asked = scene.time.substeps;
  const int needed =
      clamp_to_int(std::ceil(scene.time.frame / (kLimitShare * limit)), 1, kFinest * kMostSubsteps);
  if (asked == kAutoSubsteps) return guard_.finer() * needed;
  if (scene.time.frame / asked <= limit) return guard_.finer() * asked;
  return guard_.finer() * asked * ((needed + asked - 1) / asked);
}

void Simulation::State::follow_stretch(double limit) {
  const int count = substeps_within(limit);
  // A few percent of slack either way keeps the substep from changing every frame.
  if (count <= substeps && count >= substeps - substeps / 12) return;
  set_substeps(count);
}

}  // namespace weft
