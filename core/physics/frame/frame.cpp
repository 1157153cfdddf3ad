// The frame: substeps of all cloths through their plans, contact between them, and a stop with the place
// of the fault when the state turns non-finite.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "physics/frame/measure.h"
#include "physics/frame/state.h"
#include "physics/model/path.h"
#include "physics/model/vector.h"

namespace weft {

using namespace physics;

namespace {

// Share of the time that threads with a cloth each must be busy for: about what several make of one.
constexpr double kBusy = 0.9;
constexpr std::int64_t kManyParticles = 8192;  // for whose contact threads stand by all frame

}  // namespace

void Simulation::State::advance_frame() {
  if (!status.ok) return;
  const auto start = std::chrono::steady_clock::now();
  grab_ || carried() ? guard_.interacted() : guard_.pass(scene.time.frame);
  if (guard_.interaction_has_passed(scene, cloths, driven(), began_.energy)) begin_again();
  for (std::size_t c = 0; c < cloths.size(); ++c)
    if (carried_[c]) wake(int(c));
  if (sleeping) sleeping->begin_frame(double(frame) * scene.time.frame);
  // What has been put in stays in when what did it is gone.
  if (was_driven_ && !driven()) open_guard();
  was_driven_ = driven();
  save();
  Verdict verdict;
  do {
    run_frame();
    verdict = guard_.judge(frame_run());
  } while (carry_out(verdict));
  if (verdict == Verdict::stop) {
    find_fault();
    restore();
    return;
  }
  if (!(sleeping && sleeping->all_asleep())) {
    guard_.energy().accept(substeps);
    lag = lag_between_substeps();
  }
  for (auto& step : cloths)
    if (Tearing* tearing = step->model().tearing()) tearing->update();
  ++frame;
  total_substeps += substeps;
  check_strain_limits();
  note_clamps();
  note_stretch();
  note_left_strain();
  if (options.follow_strain)
    greatest_strain = std::max(greatest_strain.value_or(-1), strain_of(cloths).max);

  if (sleeping) sleeping->end_frame([&](std::size_t c) -> const Rows& { return records_[c].x(); });
  if (is_explicit(method) && !(sleeping && sleeping->all_asleep())) follow_stretch(limit_);
  const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - start;
  total_ms += spent.count();
  // A run longer than the scene says keeps the times of its last frames.
  if (frame_ms.size() < frame_ms.capacity())
    frame_ms.push_back(float(spent.count()));
  else
    frame_ms[std::size_t(frame) % frame_ms.size()] = float(spent.count());
}

void Simulation::State::run_frame() {
  if (sleeping && sleeping->all_asleep()) return;
  if (!self_collision) return run_substeps(0, substeps);
  begin_contact();
  if (self_collision->particles() < kManyParticles) return run_with_contact();
  threads.together([&] { run_with_contact(); });
}

// What the frame has come to.
FrameRun Simulation::State::frame_run() {
  FrameRun run{.scene = scene,
               .method = method,
               .cloths = cloths,
               .starts = records_,
               .asleep = asleep_,
               .frame = frame,
               .dt = dt,
               .finite = true,
               .energy = {},
               .limit = limit_,
               .driven = was_driven_,
               .alone = nothing_else_acts()};
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    asleep_[c] = asleep(c);
    if (asleep_[c]) continue;
    if (self_collision) records_[c].measure();  // else its passes have looked
    run.energy += records_[c].energy_sum();
  }
  run.finite = run.energy.greatest < kFarAway;
  if (run.finite && is_explicit(method) && !(sleeping && sleeping->all_asleep()))
    run.limit = limit_ = stretched_limit();
  return run;
}

// Keeps the first frame at whose end a cloth is longer somewhere than its strain limit allows.
void Simulation::State::check_strain_limits() {
  constexpr double kTolerance = 1e-2;  // of the limit
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const ClothStep& step = *cloths[c];
    const double limit = step.cloth().strain_limit;
    if (limit == 0 || overlong_[c].frame > 0 || asleep(c)) continue;
    const double strain = step.model().limited_strain();
    if (strain > limit * (1 + kTolerance)) overlong_[c] = {frame, strain, false};
  }
}

void Simulation::State::tell_of_limits() {
  for (std::size_t c = 0; c < overlong_.size(); ++c) {
    Overlong& o = overlong_[c];
    if (o.frame == 0 || o.told) continue;
    o.told = true;
    plan.notes.push_back("cloth " + std::to_string(c) + ": the strain limit of " +
                         number(scene.cloths[c].strain_limit) + " did not hold in frame " +
                         std::to_string(o.frame) + " (" + number(o.strain) +
                         "); more substeps hold it better");
  }
  tell_of_seams();
}

// In place of what was told of them before.
void Simulation::State::tell_of_seams() {
  for (const std::string& old : told_of_seams_) std::erase(plan.notes, old);
  told_of_seams_.clear();
  for (std::size_t c = 0; frame > 0 && c < cloths.size(); ++c) {
    const OpenSeams seams = cloths[c]->model().open_seams();
    if (seams.open == 0) continue;
    told_of_seams_.push_back("cloth " + std::to_string(c) + ": " + std::to_string(seams.open) +
                             " of " + std::to_string(seams.all) + " seams are open after frame " +
                             std::to_string(frame) + ", their ends up to " + number(seams.widest) +
                             " m from the middle");
  }
  plan.notes.insert(plan.notes.end(), told_of_seams_.begin(), told_of_seams_.end());
}

// A frame ends with a run of contact, so that what was put back to a frame's start, or set, begins anew.
// Intervals are powers of two and begin at multiples of their length: so where frames end matters little.
void Simulation::State::run_with_contact() {
  for (int s = 0; s < substeps;) {
    const int count = std::min({until_collision_, s == 0 ? substeps : s & -s, substeps - s});
    run_substeps(s, count);
    s += count;
    const auto start = std::chrono::steady_clock::now();
    until_collision_ = self_collision->run(contact_interval(s, count), threads);
    if (untangle->due()) untangle->calm(count * dt);
    const auto spent = std::chrono::steady_clock::now() - start;
    self_collision_ns += std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count();
    ++self_collision_runs;
  }
}

ContactInterval Simulation::State::contact_interval(int end, int count) const {
  const Vec3 g = gravity_at(scene, double(frame) * scene.time.frame + end * dt);
  const double gravity = std::sqrt(dot(g, g));
  return {dt, count, gravity};
}

// Motion that contact had to cut short is told of once.
void Simulation::State::note_clamps() {
  if (clamps_noted_ || !self_collision || self_collision->record().held == 0) return;
  clamps_noted_ = true;
  plan.notes.push_back("frame " + std::to_string(frame) +
                       ": sheets would have passed through each other; what met moves as one until "
                       "it comes apart (shorter substeps or a greater thickness avoid that)");
}

// Nothing passes through, so that what is drawn against something stretches instead. Told of once a cloth.
void Simulation::State::note_stretch() {
  constexpr double kDoubled = 1;
  if (!self_collision || !self_collision->touched()) return;
  stretch_noted_.resize(cloths.size());
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    if (stretch_noted_[c] || asleep(c)) continue;
    const double strain = cloths[c]->model().strain().max;
    if (strain < kDoubled) continue;
    stretch_noted_[c] = 1;
    plan.notes.push_back("frame " + std::to_string(frame) + ": cloth " + std::to_string(c) +
                         " is drawn against what it cannot pass, to " + number(1 + strain) +
                         " times its length (other ways of its pins, a strain limit or tear_strain "
                         "avoid that)");
  }
}

// Sweeps that leave strain keep energy that nothing put in. A look takes about as long as a sweep.
void Simulation::State::note_left_strain() {
  constexpr int kFramesBetweenLooks = 8;
  constexpr double kInstant = 1e-9;  // s; in substeps so short all stiffness is felt
  if (left_strain_noted_ || method != Method::compliant || frame % kFramesBetweenLooks != 0) return;
  double held = 0;
  for (std::size_t c = 0; c < cloths.size(); ++c)
    if (!asleep(c)) held += cloths[c]->model().held_energy(cloths[c]->particles().x, kInstant);
  if (!guard_.energy().is_made(held)) return;
  left_strain_noted_ = true;
  plan.notes.push_back("frame " + std::to_string(frame) + ": the sweeps leave strain of " +
                       number(held) +
                       " J that nothing put in; more substeps or iterations leave less");
}

// Surfaces begin with what does not cross; what does comes apart first.
void Simulation::State::begin_contact() {
  const bool drawn = self_collision->surfaces() && untangle->look_at_seams();
  if (self_collision->surfaces() && (untangle->due() || self_collision->forced() || drawn)) {
    untangle->pull_apart();
    self_collision->leave_out(untangle->passing());
    self_collision->restart();
  }
  if (!self_collision->begun()) self_collision->begin(threads);
}

Substeps Simulation::State::substeps_from(int first, int count) const {
  const double kick = first == 0 ? lag + dt / 2 : dt;
  return {double(frame) * scene.time.frame + first * dt, dt, count, kick};
}

// A thread each where that keeps all of them busy; else cloths that are worth all threads take them one
// after the other, and small ones run side by side.
void Simulation::State::run_substeps(int first, int count) {
  const Substeps now = substeps_from(first, count);
  const auto run = [&](std::size_t c, Threads& team) {
    cloths[c]->schedule().run(now, team, sleeping ? sleeping->rows(c) : std::span<const RowSpan>(),
                              self_collision ? nullptr : &records_[c]);
  };
  const bool standing_by = threads.standing_by();
  const auto worth_running_apart = [&] {
    std::int64_t all = 0;
    for (const std::size_t c : apart_) all += particles(c);
    return apart_.size() > 1 && Schedule::worth_running_apart(all, count, standing_by);
  };
  apart_.clear();
  for (std::size_t c = 0; c < cloths.size(); ++c)
    if (!asleep(c)) apart_.push_back(c);
  bool apart = worth_running_apart() && keep_busy(apart_);
  if (!apart) {
    std::size_t small = 0;
    for (const std::size_t c : apart_)
      if (cloths[c]->schedule().worth_sharing(particles(c), count, standing_by))
        run(c, threads);
      else
        apart_[small++] = c;
    apart_.resize(small);
    apart = worth_running_apart();
  }
  const auto run_apart = [&] {
    threads.share(apart_.size(), !apart, [&](std::size_t n) { run(apart_[n], one_thread); });
  };
  apart ? threads.together(run_apart) : run_apart();
}

int Simulation::State::particles(std::size_t cloth) const {
  return cloths[cloth]->particles().count();
}

// Whether cloths of such sizes, each going to the thread that is free first, keep threads busy for nearly
// all of the time.
bool Simulation::State::keep_busy(const std::vector<std::size_t>& each) {
  busy_.assign(std::size_t(threads.count()), 0);
  std::int64_t all = 0;
  for (const std::size_t c : each) {
    *std::min_element(busy_.begin(), busy_.end()) += particles(c);
    all += particles(c);
  }
  const std::int64_t longest = *std::max_element(busy_.begin(), busy_.end());
  return kBusy * double(longest) * threads.count() <= double(all);
}

namespace {

// The first particle that is not finite, or too far away; none where all are well.
std::optional<int> first_at_fault(const Particles& p) {
  for (int n = 0; n < p.count(); ++n) {
    const auto [j, i] = p.place(n);
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(p.x.at(k, j, i)) < kFarAway) || !std::isfinite(p.v.at(k, j, i))) return n;
  }
  return std::nullopt;
}

// A particle as messages name it: [column, row] in a grid.
std::string name_of(const Cloth& cloth, int particle) {
  if (cloth.mesh.given()) return "particle " + std::to_string(particle);
  return "particle [" + std::to_string(particle % cloth.grid.nx) + "," +
         std::to_string(particle / cloth.grid.nx) + "]";
}

}  // namespace

// Runs the frame again, stage by stage, to the first that leaves a particle non-finite.
void Simulation::State::find_fault() {
  restore();
  status.ok = false;
  status.frame = frame + 1;
  const std::string where = "not finite in frame " + std::to_string(status.frame);
  const Substeps all = substeps_from(0, substeps);
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Particles& p = cloths[c]->particles();
    for (int s = 0; s < substeps; ++s)
      for (const auto& stage : cloths[c]->stages()) {
        stage->run_alone(p.rows, all.at(s), threads);
        const std::optional<int> fault = first_at_fault(p);
        if (!fault) continue;
        status.stage = stage->name;
        status.cloth = int(c);
        status.particle = *fault;
        status.text = where + ", substep " + std::to_string(s + 1) + ", stage " + stage->name +
                      ", cloth " + std::to_string(c) + ", " + name_of(cloths[c]->cloth(), *fault);
        return;
      }
  }
  // Every stage stays finite by itself: what runs between them does not.
  status.stage = self_collision ? "self_collision" : "step";
  status.text = where + ", stage " + status.stage;
}

}  // namespace weft
