// How many substeps a frame takes: from the stability limit, following the sheet's stretch, and more
// where a frame left the limit or gained energy from nowhere.
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/frame/measure.h"
#include "physics/frame/state.h"
#include "physics/model/clamp_to_int.h"
#include "physics/model/lattice/stability.h"

namespace weft {

using namespace physics;

namespace {

constexpr double kLimitShare = 0.9;     // of the stability limit that an automatic substep takes
constexpr int kMostSubsteps = 100000;   // per frame, flat; stretch may ask for 1.4 times as many
constexpr double kLeastSubstep = 1e-6;  // s; below, single precision loses speeds of cm/s
constexpr int kFinest = 16;             // times the substeps that are due, to save a frame
constexpr double kGrabbed = 0.6;  // of stretched_limit's t, room for what a hand may do in a frame

// What folds onto a line that stretches nothing has up to twice the flat sheet's ω², and no stretch adds
// to that (a sheet without shear springs, or with nothing else).
constexpr double kFolded = 2;

}  // namespace

// Explicit springs: the substep from the stability limit, or the user's if it is inside; beyond it,
// the compliant method in their place, which is stable at any substep.
void Simulation::State::choose_method_and_substeps() {
  std::vector<std::string> notes;
  note_starts(notes);
  if (sleeping)
    notes.push_back("what stays slower than " + number(scene.solver.sleep) +
                    " m/s for half a second sleeps");
  else if (scene.solver.sleep > 0)
    notes.push_back("nothing sleeps: gusts move the cloth");
  int count = scene.time.substeps;
  double limit = 0;
  if (is_explicit(method)) {
    limit = std::numeric_limits<double>::infinity();
    double safe = limit;  // for automatic substeps
    for (std::size_t c = 0; c < cloths.size(); ++c) {
      spectra.push_back(cloths[c]->model().spectrum(masses(c).span()));
      limit = std::min(limit, spectra.back().largest_substep());
      Spectrum folded = spectra.back();
      if (cloths[c]->model().folds_freely()) folded.omega_squared *= kFolded;
      safe = std::min(safe, folded.largest_substep());
    }
    const double needed = std::ceil(scene.time.frame / (kLimitShare * safe));
    const bool resolved = needed <= kMostSubsteps && kLimitShare * safe >= kLeastSubstep;
    if (count == kAutoSubsteps && resolved) {
      count = clamp_to_int(needed, 1, kMostSubsteps);
      notes.push_back("substeps from the stability limit of " + number(limit) + " s");
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
                      " s, so that sweeps hold up a sheet that hangs by an edge");
  }
  plan = describe_stages();
  plan.dt_limit = std::isfinite(limit) ? limit : 0;
  limit_ = limit;
  plan.fallback = method != scene.solver.method;
  plan.notes = std::move(notes);
  take_substeps(count);
  if (is_explicit(method)) {
    lag = dt / 2;
    stagger();
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

bool Simulation::State::finest() const {
  return finer_ == kFinest || dt < 2 * kLeastSubstep;
}

// Whether the frame came out as it cannot be and has a better chance with more substeps: springs
// stretched beyond what their substep allows, or springs or line sweeps with more energy than there
// is. Then everything is back at the frame's start, to be run again.
bool Simulation::State::too_coarse() {
  const bool springs = is_explicit(method), lines = !springs && scene.solver.sweep == Sweep::line;
  if (!(springs || lines) || (sleeping && sleeping->all_asleep())) return false;
  bool beyond_limit = false;
  if (finite_) {
    if (springs) limit_ = stretched_limit();
    beyond_limit = springs && dt > limit_;
    const bool jitters = lines && ((!finest() && overshot()) || keeps_on());
    if (!beyond_limit && guard_.holds() && !jitters) return false;
  }
  const std::string which = "frame " + std::to_string(frame + 1);
  const bool unresolved = springs && beyond_limit && kLimitShare * limit_ < kLeastSubstep;
  const bool hopeless = unresolved || (!beyond_limit && finest());
  const int finer = hopeless ? substeps : 2 * substeps;
  if (hopeless && flies_away()) return false;
  restore();
  (since_hand_ < kCalm ? failed_by_hand_ : failed_by_itself_) = true;
  if (hopeless) {
    Solver steady = scene.solver;
    steady.sweep = Sweep::gauss_seidel;
    steady.order = 1;
    plan.notes.push_back(
        which + " gained energy from nowhere with so many substeps too; from it on " +
        (springs ? "the compliant method runs" : "gauss_seidel sweeps run") + " in their place");
    plan.fallback = true;
    go_on_as(springs ? Method::compliant : method, steady);
    take_substeps(springs ? projection_substeps() : finer);
    save();
  } else if (beyond_limit) {
    set_substeps(substeps_within(limit_));
  } else {
    take_substeps(finer);
    finer_ *= 2;
    fall_back(which + " gained energy from nowhere; it and all after it run with more substeps");
  }
  restart_stages();
  return true;
}

// Whether all that failed was a hand's doing, and the sheets move no more than they might without it.
bool Simulation::State::hand_has_passed() const {
  if (!failed_by_hand_ || failed_by_itself_ || since_hand_ < kCalm) return false;
  EnergyGuard guard = began_guard_;
  guard.look(scene, cloths, driven());
  return guard.holds();
}

// As the run began, from the state as it is.
void Simulation::State::begin_again() {
  plan.notes = began_notes_;
  plan.notes.push_back("up to frame " + std::to_string(frame) +
                       " what a hand did took more substeps, or another method");
  plan.fallback = began_fallen_back_;
  restore(snapshot());
}

// Whether something was so fast at the frame's start that it leaves all bounds by any method.
bool Simulation::State::flies_away() const {
  return std::any_of(records_.begin(), records_.end(), [&](const RollbackBuffer& r) {
    return !(r.v().greatest(kernel_table(simd)) * scene.time.frame < kFarAway);
  });
}

int Simulation::State::projection_substeps() const {
  if (scene.time.substeps != kAutoSubsteps) return scene.time.substeps;
  return clamp_to_int(std::round(scene.time.frame / projection_substep(scene)), 1, kMostSubsteps);
}

// Goes on from the state as it is by another method or solver.
void Simulation::State::go_on_as(Method as, const Solver& solver) {
  if (method == as && scene.solver == solver) return;
  if (is_explicit(method) && !is_explicit(as))
    for (std::size_t c = 0; c < cloths.size(); ++c) {
      Particles& p = cloths[c]->particles();
      const std::vector<Vec3> v = velocities_now(*this, c);
      p.for_each([&](int j, int i) {
        for (int k = 0; k < 3; ++k) p.v.at(k, j, i) = float(v[std::size_t(p.number(j, i))][k]);
      });
    }
  method = as;
  lag = is_explicit(as) ? dt / 2 : 0;
  scene.solver = solver;
  if (placed) placed->solver = solver;
  for (auto& step : cloths) step->choose_anew(method);
  plan_changed();
}

// Whether nothing but gravity and paths of pins can do work.
bool Simulation::State::nothing_else_acts() const {
  return !(grab_ || carried() || self_collision || blown() || !scene.colliders.empty());
}

// Squared lengths in those at rest: much, so much that has doubled within the frame, or so much that is
// kept up.
constexpr float kStretched = 1.25f * 1.25f, kNoticed = 1.01f * 1.01f, kLasting = 1.02f * 1.02f;

// Whether line sweeps stretched a sheet by what gravity and pins on paths, where they alone do work,
// cannot have put into this frame. A line is solved by one Newton step a substep, which overshoots
// where much happens in one, as when a straight line is pressed together from its ends.
bool Simulation::State::overshot() const {
  if (!nothing_else_acts()) return false;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (asleep(c)) continue;
    const ClothStep& step = *cloths[c];
    const float most = step.model().greatest_stretch(step.particles().x);
    if (!(most > kNoticed)) continue;
    const float at_start = step.model().greatest_stretch(records_[c].x());
    const bool doubled = most - 1 > 2 * (at_start - 1);
    if (most <= at_start || !(most > kStretched || doubled)) continue;
    const double start = double(frame) * scene.time.frame;
    if (gained(scene, step, records_[c].x(), records_[c].v(), dt, start, start + scene.time.frame))
      return true;
  }
  return false;
}

// Whether line sweeps keep stretched sheets moving that drag should have slowed down.
bool Simulation::State::keeps_on() {
  const double start = double(frame) * scene.time.frame;
  bool stretched = false;
  Balance all;
  if (nothing_else_acts() && !works(scene, start, start + scene.time.frame))
    for (std::size_t c = 0; c < cloths.size(); ++c)
      stretched |= cloths[c]->cloth().drag > 0 && !asleep(c) &&
                   cloths[c]->model().greatest_stretch(cloths[c]->particles().x) > kLasting;
  for (std::size_t c = 0; c < cloths.size() && stretched; ++c) {
    const Balance one = balance(scene, *cloths[c], dt);
    all.inner += one.inner;
    all.potential += one.potential;
    all.lost += one.lost;
  }
  if (stretched && !upkeep_.kept_up(all)) return false;
  upkeep_.restart();
  return stretched;
}

// Takes the energy off a frame that it cannot have.
void Simulation::State::calm() {
  if (sleeping && sleeping->all_asleep()) return;
  if (!guard_.holds()) {
    for (auto& step : cloths) {
      step->particles().v.scale(float(guard_.reduction()));
      step->restart();  // what stages keep of the motion
    }
    fall_back("frame " + std::to_string(frame + 1) +
              " gained energy from nowhere; velocities were reduced to what is left without it");
  }
  guard_.accept(substeps);
}

void Simulation::State::open_guard() {
  guard_.open(scene, method, cloths, double(frame) * scene.time.frame, dt);
  for (const Carry* carry : carried_)
    if (carry) guard_.drive(carry->speed());
  if (grab_) guard_.put_in(grab_->energy());
}

bool Simulation::State::carried() const {
  return std::any_of(carried_.begin(), carried_.end(), [](const Carry* c) { return c; });
}

bool Simulation::State::driven() const {
  const auto moves = [](const auto& thing) { return !thing.keys.empty(); };
  return grab_ || carried() || self_collision || sleeping || blown() ||
         std::any_of(scene.colliders.begin(), scene.colliders.end(), moves) ||
         std::any_of(scene.cloths.begin(), scene.cloths.end(), [&](const Cloth& c) {
           return std::any_of(c.pins.begin(), c.pins.end(), moves);
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
    double t = most > 1 ? 1 - 1 / std::sqrt(double(most)) : 0;
    if (grab_) t = std::max(t, kGrabbed);
    // Springs in all directions: never more than twice the flat sheet's ω² for the stencils here.
    Spectrum stretched = spectra[c];
    stretched.omega_squared *= step.model().folds_freely() ? kFolded : 1 + t;
    limit = std::min(limit, stretched.largest_substep());
  }
  return limit;
}

// Substeps a frame that stay inside a limit: 0.9 of it where they are automatic, else as many as asked
// for or, where those are too few, a multiple.
int Simulation::State::substeps_within(double limit) const {
  const int asked = scene.time.substeps;
  const int needed =
      clamp_to_int(std::ceil(scene.time.frame / (kLimitShare * limit)), 1, kFinest * kMostSubsteps);
  if (asked == kAutoSubsteps) return finer_ * needed;
  if (scene.time.frame / asked <= limit) return finer_ * asked;
  return finer_ * asked * ((needed + asked - 1) / asked);
}

void Simulation::State::follow_stretch(double limit) {
  const int count = substeps_within(limit);
  // A few percent of slack either way keeps the substep from changing every frame.
  if (count <= substeps && count >= substeps - substeps / 12) return;
  set_substeps(count);
}

}  // namespace weft
