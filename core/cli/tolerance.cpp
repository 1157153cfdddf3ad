// Trial runs against halved substeps (tolerance.h).
#include "tolerance.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "needs.h"

namespace weft::cli {

namespace {

constexpr double kTrial = 0.25;      // s
constexpr int kMostSubsteps = 4096;  // a frame
constexpr double kFar = 1e3;         // m; a trial farther off than this tells nothing

// A way to solve the scene, its order in time, and its work for one spring and substep against an
// explicit spring.
struct Way {
  const char* name;
  Solver solver;
  int order;
  double work;
};

std::vector<Way> ways(const Scene& scene) {
  Solver asked = scene.solver;
  asked.sweep = Sweep::gauss_seidel;
  asked.tethers = false;
  asked.order = asked.iterations = 1;
  std::vector<Way> all;
  const auto add = [&](const char* name, Method method, Sweep sweep, int order, double work) {
    Solver s = asked;
    s.method = method;
    s.sweep = sweep;
    s.order = order;
    all.push_back({name, s, method == Method::spring || order == 2 ? 2 : 1, work});
  };
  // Damping along the springs is known to one method only.
  if (scene.solver.method == Method::spring_friction) {
    add("spring_friction", Method::spring_friction, Sweep::gauss_seidel, 1, 1.5);
    return all;
  }
  add("spring", Method::spring, Sweep::gauss_seidel, 1, 1);
  add("compliant, line", Method::compliant, Sweep::line, 1, 4);
  add("compliant, line, order 2", Method::compliant, Sweep::line, 2, 4.5);
  return all;
}

// The positions after the trial; none when this way does not run it as asked.
std::vector<double> positions_after(const Scene& scene, const Way& way, int substeps, int frames,
                                    const Options& options) {
  Scene tried = scene;
  tried.solver = way.solver;
  tried.time.substeps = substeps;
  if (!validate(tried).empty()) return {};
  Simulation simulation(tried, options);
  if (simulation.plan().fallback) return {};
  for (int n = 0; n < frames; ++n) simulation.advance_frame();
  if (!simulation.status().ok || simulation.plan().fallback) return {};
  return simulation.positions();
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.empty() || b.empty()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(3 * sum / double(a.size()));
}

std::int64_t constraints_of(const Scene& scene) {
  const Report report = Simulation(scene, {.threads = 1}).report();
  return report.constraints.structural + report.constraints.shear + report.constraints.bend;
}

// Where a way's substeps begin: at the stability limit, or at one.
int first_substeps(const Scene& scene, const Way& way, const Options& options) {
  if (way.solver.method == Method::compliant) return 1;
  Scene tried = scene;
  tried.solver = way.solver;
  tried.time.substeps = kAutoSubsteps;
  return Simulation(tried, options).substeps();
}

// Doubles the substeps until the error is kept, or the work is more than the best so far.
Trial try_way(const Scene& scene, const Way& way, double tolerance, int frames, double work_each,
              double least_work, const Options& options) {
  Trial t{way.name, way.solver, first_substeps(scene, way, options), 0, 0};
  std::vector<double> coarse = positions_after(scene, way, t.substeps, frames, options);
  for (;; t.substeps *= 2) {
    std::vector<double> fine = positions_after(scene, way, 2 * t.substeps, frames, options);
    const double power = std::pow(2, way.order);
    t.error = distance(coarse, fine) * power / (power - 1);
    t.work = work_each * way.work * t.substeps;
    if (t.error <= tolerance || t.work >= least_work || 2 * t.substeps > kMostSubsteps) return t;
    coarse = std::move(fine);
  }
}

}  // namespace

Choice choose_solver(const Scene& scene, double tolerance, double seconds, const Options& options) {
  require_memory(scene, "--tolerance");
  Choice choice;
  const double frame = scene.time.frame;
  const int frames = std::max(1, int(std::lround(std::min(kTrial, seconds) / frame)));
  choice.seconds = frames * frame;
  Options quiet = options;
  quiet.profile = quiet.follow_strain = false;
  const double work_each = double(constraints_of(scene));
  double least = std::numeric_limits<double>::infinity();
  for (const Way& way : ways(scene)) {
    choice.trials.push_back(try_way(scene, way, tolerance, frames, work_each, least, quiet));
    const Trial& t = choice.trials.back();
    if (t.error > tolerance || t.work >= least) continue;
    least = t.work;
    choice.best = int(choice.trials.size()) - 1;
  }
  return choice;
}

std::string to_text(const Choice& choice, double tolerance) {
  char line[160];
  std::snprintf(line, sizeof line, "tolerance %.3g m, tried on %.3g s\n", tolerance,
                choice.seconds);
  std::string text = line;
  for (std::size_t n = 0; n < choice.trials.size(); ++n) {
    const Trial& t = choice.trials[n];
    if (t.error < kFar)
      std::snprintf(line, sizeof line, "%c %-26s %5d substeps a frame: error %.1e m, work %.2g\n",
                    int(n) == choice.best ? '*' : ' ', t.method.c_str(), t.substeps, t.error,
                    t.work);
    else
      std::snprintf(line, sizeof line, "  %-26s not stable as asked\n", t.method.c_str());
    text += line;
  }
  return text;
}

}  // namespace weft::cli
