// How many substeps a frame takes: from the stability limit, following the sheet's stretch, and more
// where a frame left the limit or gained energy from nowhere.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "physics/frame/projection_substep.h"
#include "physics/frame/start_notes.h"
#include "physics/frame/state.h"
#include "physics/frame/velocities.h"
#include "physics/model/clamp_to_int.h"
#include "physics/model/number.h"
#include "physics/model/path.h"
#include "physics/model/placement.h"
#include "physics/model/remainders.h"

namespace weft {

using namespace physics;

namespace {

bool holds_gas(const Scene& scene) {
  return std::any_of(scene.cloths.begin(), scene.cloths.end(),
                     [](const Cloth& c) { return c.pressure.given(); });
}

void note_projection(const Scene& scene, int count, std::vector<std::string>& notes) {
  const double needed = projection_substep(scene), dt = scene.time.frame / count;
  if (scene.time.substeps == kAutoSubsteps && needed < kLongestProjection)
    notes.push_back("substeps of " + number(dt) +
                    " s, so that sweeps hold up a sheet that hangs by " +
                    (scene.solver.sweep == Sweep::line ? "few points" : "an edge") +
                    (holds_gas(scene) ? ", or hold a gas" : ""));
  if (scene.time.substeps != kAutoSubsteps && holds_gas(scene) && dt > needed)
    notes.push_back("sweeps hold a gas in substeps of " + number(needed) + " s; in those of " +
                    number(dt) + " s it stretches the cloth more than it should");
}

// Where substeps of sweeps stretch a cloth more than it does.
void note_overstretch(const Scene& scene, Method method, int count,
                      std::vector<std::string>& notes) {
  constexpr double kTimes = 1.2;
  constexpr double kFar = 2;  // the estimate is of what is near
  const double dt = scene.time.frame / count;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    const bool gas = cloth.pressure.given();
    const double times = overstretch(scene, cloth, method, dt);
    if (times <= kTimes || !(gas || greatest_gravity(scene) > 0)) continue;
    notes.push_back("cloth " + std::to_string(c) + ": where it " +
                    (gas ? "holds its gas" : "hangs") + ", sweeps in substeps of " + number(dt) +
                    " s leave strain, " + (times > kFar ? "at least " : "about ") +
                    number(std::round(10 * times) / 10) + " times as much as its stiffness says" +
                    (gas ? ", and its energy" : "") + "; substeps of " +
                    number(substep_of_overstretch(scene, cloth, kTimes)) + " s, line sweeps" +
                    (gas ? "" : ", tethers") + " or method spring do not");
  }
}

// Twice what the lengths may be off by (projection_substep()).
void note_gas(const Scene& scene, int count, std::vector<std::string>& notes) {
  constexpr double kShortfall = 0.04;
  const double dt = scene.time.frame / count;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    if (const double less = gas_shortfall(scene.cloths[c], dt); less > kShortfall)
      notes.push_back("cloth " + std::to_string(c) + ": in substeps of " + number(dt) +
                      " s its gas pushes what holds it " + number(100 * less) +
                      " % less than its volume says; in those of " +
                      number(substep_of_shortfall(scene.cloths[c], kShortfall)) + " s, " +
                      number(100 * kShortfall) + " %");
}

void note_tearing(const Scene& scene, Method method, int count, std::vector<std::string>& notes) {
  const double dt = scene.time.frame / count;
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    const double longest = tearing_substep(scene, scene.cloths[c], method);
    if (dt <= longest) continue;
    notes.push_back("cloth " + std::to_string(c) + ": in substeps of " + number(dt) +
                    " s sweeps leave strain spread unevenly, so that it may tear at a fifth of its "
                    "tear_strain, or later than there; " +
                    (longest > 0 ? "in substeps of " + number(longest) + " s they spread it evenly"
                                 : "compliant sweeps of gauss_seidel tear it as they should"));
  }
}

constexpr double kSlow = 0.01;  // m/s; motion that nobody looks into

// Of the coordinates of what moves: the one farthest from zero [m], and a unit in its last place.
struct Farthest {
  float place = 0;
  void look(const Particles& p) {
    p.for_each([&](int j, int i) {
      for (int k = 0; k < 3 && p.w(j, i) > 0; ++k)
        place = std::max(place, std::abs(p.x.at(k, j, i)));
    });
  }
  double unit() const {
    return double(std::nextafter(place, std::numeric_limits<float>::infinity()) - place);
  }
};

// Positions are rounded once a substep: what goes less far in it than half of a unit in the last place stays
// where it is, unless that is kept for the next.
void note_rounding(const Cloths& cloths, const Solver& solver, Method method, double dt,
                   std::vector<std::string>& notes) {
  Farthest farthest;
  for (const auto& step : cloths) {
    const bool sweeps_keep = solver.order == 2 || !step->cloth().mesh.given();
    const auto keeps = [&] {
      return is_explicit(method) ? dt < forces_keep_below(step->parts())
                                 : sweeps_keep && Remainders::fine(dt);
    };
    if (!keeps()) farthest.look(step->particles());
  }
  if (const double slowest = farthest.unit() / 2 / dt; slowest >= kSlow)
    notes.push_back("substeps of " + number(dt) +
                    " s are so short that single precision does not move what is slower than " +
                    number(slowest) + " m/s; longer ones are more exact");
}

// How fast springs and bending shake an undamped cloth, from the start to the end of the run, since its positions
// are rounded [m/s]. To leave a place by r puts in m ω² r²/2, and the square of what is rounded off is a twelfth of a
// unit's in the mean, in each direction. Of all ω², the mean is about a tenth of the greatest.
double shaking(const Scene& scene, const Cloth& cloth, const Particles& p, const Spectrum& spectrum,
               double dt) {
  constexpr double kMean = 0.1;
  Farthest farthest;
  farthest.look(p);
  const double unit = farthest.unit(), rounded = 3 * unit * unit / 12;
  const double kept = cloth.drag > 0 ? 1 / (2 * cloth.drag) : scene.time.seconds;  // s
  const double times = std::min(kept, scene.time.seconds) / dt;
  return std::sqrt(kMean * spectrum.omega_squared * rounded * times);
}

// Where that is a twentieth or more of the energy of what moves: of a fall by the cloth's size, and of its start.
// Damping takes it away at once.
void note_shaking(const Scene& scene, const Cloths& cloths, std::span<const Spectrum> spectra,
                  double dt, std::vector<std::string>& notes) {
  constexpr double kShare = 0.05;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Cloth& cloth = scene.cloths[c];
    const Particles& p = cloths[c]->particles();
    const double speed = shaking(scene, cloth, p, spectra[c], dt);
    if (spectra[c].damping > 0 || speed < kSlow) continue;
    Vec3 low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    p.for_each([&](int j, int i) {
      const Vec3 at = p.position(j, i);
      for (std::size_t k = 0; k < 3; ++k)
        low[k] = std::min(low[k], at[k]), high[k] = std::max(high[k], at[k]);
    });
    const double size = length(minus(high, low)), start = length(cloth.velocity);
    const double turns = length(cloth.spin) * size / 2;
    if (speed * speed <
        kShare * (2 * greatest_gravity(scene) * size + start * start + turns * turns))
      continue;
    notes.push_back(
        "cloth " + std::to_string(c) + " is so stiff for its mass that its substeps of " +
        number(dt) + " s shake it by about " + number(speed) + " m/s within " +
        number(scene.time.seconds) +
        " s, since single precision rounds its places: do not trust its motion. Less "
        "bending or stiffness, more density, damping, or method compliant is what helps");
  }
}

// Paths of the cloth are straight as a body sees it: off an arc of radius r and angle a by r a²/8.
void note_turning(const Scene& scene, double dt, std::vector<std::string>& notes) {
  constexpr double kEver = 1e9;    // s
  constexpr double kCoarse = 0.2;  // rad; off by 0.5 % of the distance from the axis
  for (std::size_t k = 0; k < scene.colliders.size(); ++k)
    if (const double turn = fastest_turn(scene.colliders[k].rotate, 0, kEver) * dt; turn > kCoarse)
      notes.push_back("collider " + std::to_string(k) + " turns by up to " +
                      number(turn * 180 / std::numbers::pi) +
                      "° in a substep, in which paths are followed as if straight; more substeps "
                      "are more exact");
}

}  // namespace

void Simulation::State::choose_method_and_substeps() {
  std::vector<std::string> notes;
  note_starts(scene, cloths, contact.get(), notes);
  if (sleeping)
    notes.push_back("what stays slower than " + number(scene.solver.sleep) +
                    " m/s for half a second sleeps");
  else if (scene.solver.sleep > 0)
    notes.push_back("nothing sleeps: gusts or loads over time move the cloth");
  int count = scene.time.substeps;
  if (is_explicit(time_step.method)) count = explicit_substeps(notes);
  if (!is_explicit(time_step.method)) {
    count = projection_substeps(scene);
    note_projection(scene, count, notes);
    note_overstretch(scene, time_step.method, count, notes);
    note_gas(scene, count, notes);
    note_tearing(scene, time_step.method, count, notes);
  }
  time_step.take(count, scene.time.frame);
  suit_stages();
  note_rounding(cloths, scene.solver, time_step.method, time_step.dt, notes);
  if (is_explicit(time_step.method))
    note_shaking(scene, cloths, time_step.spectra, scene.time.frame / count, notes);
  note_turning(scene, scene.time.frame / count, notes);
  note_models(notes);
  plan = describe_stages();
  plan.dt_limit = std::isfinite(time_step.limit) ? time_step.limit : 0;
  plan.fallback = time_step.method != scene.solver.method;
  plan.notes = std::move(notes);
  take_substeps(count);
  time_step.followed.take(count, time());
  if (is_explicit(time_step.method)) {
    time_step.lag = time_step.dt / 2;
    if (!scene.solver.full_first_kick)
      for (auto& step : cloths) stagger(*step, time(), time_step.dt, time_step.lag);
  }
  open_guard();
}

// From the stability limit, or the user's if they are inside; beyond it, puts the compliant method in their
// place, which is stable at any substep.
int Simulation::State::explicit_substeps(std::vector<std::string>& notes) {
  const double frame_s = scene.time.frame;
  if (scene.solver.iterations > 1 && !scene.solver.iterate_springs)
    notes.push_back("iterations is " + std::to_string(scene.solver.iterations) +
                    ", which does nothing here: springs have no iterations (iterate_springs adds "
                    "their forces so many times)");
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    time_step.spectra.push_back(cloths[c]->model().spectrum(masses(c).span()));
    time_step.spectra.back().drag = scene.cloths[c].drag;
  }
  const StableSubsteps stable = stable_substeps(cloths, time_step.spectra);
  const double limit = time_step.limit = stable.largest;
  const double needed = std::ceil(frame_s / (kLimitShare * stable.safe));
  const bool resolved = needed <= kMostSubsteps && kLimitShare * stable.safe >= kLeastSubstep;
  const int asked = scene.time.substeps;
  if (asked == kAutoSubsteps && resolved) {
    notes.push_back(std::isfinite(limit)
                        ? "substeps from the stability limit of " + number(limit) + " s"
                        : "one substep a frame, since nothing is free to vibrate");
    return clamp_to_int(needed, 1, kMostSubsteps);
  }
  if (resolved && frame_s / asked <= limit) return asked;
  notes.push_back("springs need substeps below " + number(limit) + " s, " + number(needed) +
                  " a frame at " + number(kLimitShare) +
                  " of the limit; the compliant method runs in their place");
  time_step.method = Method::compliant;
  build_cloths();
  return asked;
}

// Whether stages were chosen anew for the substeps' length.
bool Simulation::State::suit_stages() {
  bool others = false;
  for (auto& step : cloths) others |= step->take_substep(time_step.dt);
  return others;
}

void Simulation::State::take_substeps(int count) {
  time_step.take(count, scene.time.frame);
  if (suit_stages()) {
    plan_changed();
    note_models(plan.notes);
  }
  plan.substeps = time_step.substeps;
  plan.dt = time_step.dt;
  for (PlannedStage& s : plan.stages) s.calls_per_frame = time_step.substeps;
}

void Simulation::State::set_substeps(int count) {
  take_substeps(count);
  if (scene.time.substeps != kAutoSubsteps && count != scene.time.substeps)
    fall_back("springs need " + std::to_string(count) + " substeps a frame from frame " +
                  std::to_string(frame + 1),
              " on, as far as the sheet is stretched");
}

// Runs the frame again, if the verdict says so, or ends it; returns whether it runs again.
bool Simulation::State::carry_out(Verdict verdict) {
  const std::string which = "frame " + std::to_string(frame + 1);
  const int count = time_step.substeps;
  switch (verdict) {
    case Verdict::accept:
    case Verdict::stop:
      return false;
    case Verdict::clamp:
      for (auto& step : cloths) {
        step->particles().v.scale(float(guard_.energy().reduction()));
        step->restart();  // what stages keep of the motion
      }
      fall_back(which,
                " gained energy from nowhere; velocities were reduced to what is left without it");
      return false;
    case Verdict::unstable:
      fall_back(which, " is stretched beyond what any substep carries; its motion is not accurate");
      return false;
    case Verdict::change_method:
      put_back();
      change_method(which, count);
      break;
    case Verdict::refine_to_limit:
      put_back();
      time_step.followed.take(physics::substeps_within(time_step.limit, scene.time, 1), time());
      set_substeps(substeps_within(time_step.limit));
      break;
    case Verdict::refine:
      put_back();
      take_substeps(2 * count);
      fall_back(which, " gained energy from nowhere; it and all after it run with more substeps");
      break;
    case Verdict::refine_for_limits:
      put_back();
      take_substeps(2 * count);
      add_once(plan.notes,
               "frames in which strain limits would not hold run again with more substeps");
      break;
  }
  restart_stages();
  // Shorter substeps, or other sweeps, feel more of what the start holds.
  if (guard_.energy().begins()) open_guard();
  return true;
}

// By a method that loses energy whatever the substep.
void Simulation::State::change_method(const std::string& which, int count) {
  const bool springs = is_explicit(time_step.method);
  Solver steady = scene.solver;
  steady.sweep = Sweep::gauss_seidel;
  steady.order = 1;
  plan.notes.push_back(
      which + " gained energy from nowhere with so many substeps too; from it on " +
      (springs ? "the compliant method runs" : "gauss_seidel sweeps run") + " in their place");
  plan.fallback = true;
  go_on_as(springs ? Method::compliant : time_step.method, steady);
  note_models(plan.notes);
  take_substeps(springs ? projection_substeps(scene) : count);
  note_overstretch(scene, time_step.method, time_step.substeps, plan.notes);
  save();
}

void Simulation::State::note_models(std::vector<std::string>& notes) const {
  for (std::size_t c = 0; c < cloths.size(); ++c)
    for (const std::string& note : cloths[c]->model().notes())
      add_once(notes, "cloth " + std::to_string(c) + ": " + note);
}

// As the run began, from the state as it is.
void Simulation::State::begin_again() {
  plan.notes = began_.notes;
  plan.notes.push_back("up to frame " + std::to_string(frame) +
                       " what a hand did took more substeps, or another method");
  plan.fallback = began_.fallback;
  restore(told());
}

// Goes on from the state as it is by another method or solver.
void Simulation::State::go_on_as(Method as, const Solver& solver) {
  if (time_step.method == as && scene.solver == solver) return;
  const bool were_forces = is_explicit(time_step.method);
  if (were_forces && !is_explicit(as))
    for (std::size_t c = 0; c < cloths.size(); ++c) {
      Particles& p = cloths[c]->particles();
      const std::vector<Vec3> v = velocities(c);
      p.for_each([&](int j, int i) {
        for (int k = 0; k < 3; ++k) p.v.at(k, j, i) = float(v[std::size_t(p.number(j, i))][k]);
      });
    }
  time_step.method = as;
  if (is_explicit(as))
    time_step.lag = time_step.dt / 2;
  else if (were_forces)
    time_step.lag = 0;
  placed.set_solver(solver);
  for (auto& step : cloths) step->choose_anew(as);
  plan_changed();
}

// One note tells of each kind, where it happened first.
void Simulation::State::fall_back(const std::string& where, const std::string& what) {
  const auto told = [&](const std::string& note) { return note.ends_with(what); };
  if (std::none_of(plan.notes.begin(), plan.notes.end(), told)) plan.notes.push_back(where + what);
  plan.fallback = true;
}

double Simulation::State::stretched_limit() const {
  return physics::stretched_limit(cloths, time_step.spectra, hands_.grabbed() >= 0);
}

int Simulation::State::substeps_within(double limit) const {
  return physics::substeps_within(limit, scene.time, guard_.finer());
}

void Simulation::State::follow_stretch(double limit) {
  const int needed = physics::substeps_within(limit, scene.time, 1);
  const int count = time_step.followed.next(needed, time(), hands_.act()) * guard_.finer();
  if (count != time_step.substeps) set_substeps(count);
}

}  // namespace weft
