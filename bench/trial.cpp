// Runs the measurements (trial.h).
#include "trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

namespace bench {
namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

bool plan_says(const weft::Plan& plan, const std::string& word) {
  return std::any_of(plan.stages.begin(), plan.stages.end(), [&](const weft::PlannedStage& s) {
    return s.name.find(word) != std::string::npos || s.detail.find(word) != std::string::npos;
  });
}

// What the setting asks for that the simulation's plan does not contain.
std::string missing(const weft::Simulation& simulation, const Setting& setting) {
  const weft::Plan& plan = simulation.plan();
  const weft::Solver& s = setting.solver;
  if (s.method == weft::Method::spring)
    return plan_says(plan, "spring") || plan_says(plan, "membrane")
               ? ""
               : "substeps beyond the stability limit";
  if (s.sweep == weft::Sweep::line && !plan_says(plan, "line")) return "no line sweeps in the plan";
  if (s.tethers && !plan_says(plan, "tether")) return "no tethers in the plan";
  if (s.order == 2 && !plan_says(plan, "second") && !plan_says(plan, "order 2") &&
      !plan_says(plan, "BDF2"))
    return "no second-order substep in the plan";
  return "";
}

int frames_of(const Problem& p, const Setting& s) {
  const double frame = s.frame > 0 ? s.frame : p.question.scene.time.frame;
  return int(std::lround(p.question.seconds / frame));
}

// What the first repetition tells besides its time.
void judge(const Problem& problem, const weft::Simulation& simulation, double strain_ever,
           const std::vector<double>& truth, Trial& t) {
  t.simd = weft::simd_name(simulation.simd());
  t.substeps = simulation.substeps();
  if (!simulation.status().ok) {
    t.note = "stopped: " + simulation.status().text;
  } else if (problem.measure == Measure::strain) {
    t.rms = simulation.report().strain.max;
    t.greatest = strain_ever;
  } else {
    const Distance d = distance(simulation.positions(), truth);
    t.rms = d.rms;
    t.greatest = d.greatest;
    if (!(d.rms < 10)) t.note = "blew up";
  }
}

// One repetition: setup, then the whole run. Strain is looked at between frames, outside the clock.
void repeat(const Problem& problem, const weft::Scene& scene, const weft::Options& options,
            const std::vector<double>& truth, Trial& t, std::vector<double>& fastest) {
  const auto start = Clock::now();
  weft::Simulation simulation(scene, options);
  const double setup_ms = ms_since(start);
  if (t.note = missing(simulation, t.setting); !t.ok()) return;
  const bool first = t.repetitions++ == 0;
  const bool strain = first && problem.measure == Measure::strain;
  double run_ms = 0, ever = 0;
  for (double& best : fastest) {
    const auto frame_start = Clock::now();
    simulation.advance_frame();
    const double ms = ms_since(frame_start);
    run_ms += ms;
    best = std::min(best, ms);
    if (strain) ever = std::max(ever, simulation.report().strain.max);
  }
  t.setup_ms = first ? setup_ms : std::min(t.setup_ms, setup_ms);
  t.run_ms = first ? run_ms : std::min(t.run_ms, run_ms);
  if (first) judge(problem, simulation, ever, truth, t);
}

}  // namespace

Trial run_trial(const Problem& problem, const Setting& setting, weft::Simd simd, int threads,
                const std::vector<double>& truth, const Repeats& repeats) {
  Trial t;
  t.problem = problem.name;
  t.size = problem.size;
  t.setting = setting;
  t.threads = threads;
  t.frames = frames_of(problem, setting);
  weft::Scene scene = problem.question.scene;
  // The frame divides the run exactly, so that no rounding of 1/60 s shows as an error.
  scene.time.frame = problem.question.seconds / t.frames;
  scene.time.substeps = setting.substeps;
  scene.solver = setting.solver;
  weft::Options options;
  options.simd = simd;
  options.threads = threads;
  const auto start = Clock::now();
  std::vector<double> fastest(std::size_t(t.frames), std::numeric_limits<double>::infinity());
  do {
    repeat(problem, scene, options, truth, t, fastest);
  } while (t.ok() && t.repetitions < repeats.most &&
           (t.repetitions < repeats.least || ms_since(start) < 1e3 * repeats.seconds));
  if (t.repetitions > 0) t.quiet_ms = std::accumulate(fastest.begin(), fastest.end(), 0.0);
  return t;
}

void mark_front(std::vector<Trial>& trials, bool any_size) {
  for (Trial& t : trials)
    t.on_front = t.ok() && std::none_of(trials.begin(), trials.end(), [&](const Trial& o) {
                   return o.ok() && o.problem == t.problem && (any_size || o.size == t.size) &&
                          o.run_ms <= t.run_ms && o.rms <= t.rms &&
                          (o.run_ms < t.run_ms || o.rms < t.rms);
                 });
}

}  // namespace bench
