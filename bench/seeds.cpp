// What the seeds report, measured: seed 000's robustness and efficiency with its own solver beside ours,
// and the parameter studies of seeds 001, 003 and 004. docs/seeds.md names the command for each table.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "seed_solver.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace bench {
namespace {

constexpr double kSeconds = 5;  // of a run

const char* name_of(SeedConstraint type) {
  return type == SeedConstraint::positional ? "positional"
         : type == SeedConstraint::spring   ? "spring"
                                            : "spring and friction";
}

// ---- Robustness

std::string seed_outcome(const SeedSettings& settings) {
  SeedSolver solver(settings);
  double most = 0;
  for (int n = 1; n <= int(60 * kSeconds); ++n) {
    solver.step();
    const double stretch = solver.stretch();
    if (!std::isfinite(stretch) || stretch > 1e6) {
      char text[64];
      std::snprintf(text, sizeof text, "explodes after %.2f s", n / 60.0);
      return text;
    }
    most = std::max(most, stretch);
  }
  char text[96];
  std::snprintf(text, sizeof text, "%s, stretched to %.0f %% at most, %.0f %% at the end",
                solver.stretch() > 10 ? "tangled" : "holds", 100 * most, 100 * solver.stretch());
  return text;
}

std::string our_outcome(const SeedSettings& settings) {
  weft::Simulation simulation(scene_of(settings), {.threads = 1});
  double most = 0;
  for (int n = 0; n < int(60 * kSeconds) && simulation.status().ok; ++n) {
    simulation.advance_frame();
    most = std::max(most, 1 + simulation.report(false).strain.max);
  }
  if (!simulation.status().ok) return "stops itself: " + simulation.status().text;
  char text[128];
  std::snprintf(text, sizeof text,
                "holds, %d substeps, stretched to %.0f %% at most, %.0f %% at the end",
                simulation.substeps(), 100 * most, 100 * (1 + simulation.report(false).strain.max));
  return text;
}

void robustness() {
  std::printf(
      "| constraint | K | iterations | U | start | seed's solver | Weft |\n"
      "|---|---|---|---|---|---|---|\n");
  struct Row {
    SeedConstraint type;
    float k;
    int iterations;
    float u;
  };
  const Row rows[] = {{SeedConstraint::positional, 0.5f, 10, 0},
                      {SeedConstraint::spring, 15, 10, 0},
                      {SeedConstraint::spring, 10, 5, 0},
                      {SeedConstraint::spring, 30, 10, 0},
                      {SeedConstraint::spring_friction, 10, 5, 0.1f},
                      {SeedConstraint::spring_friction, 13, 5, 0.1f},
                      {SeedConstraint::spring_friction, 14, 6, 0.1f},
                      {SeedConstraint::spring_friction, 13, 10, 0.1f},
                      {SeedConstraint::spring_friction, 14, 6, 14},
                      {SeedConstraint::spring_friction, 20, 10, 0.1f}};
  for (const Row& row : rows)
    for (const bool on_sphere : {false, true}) {
      SeedSettings s;
      s.type = row.type;
      s.k = row.k;
      s.u = row.u;
      s.constraint_iterations = row.iterations;
      s.on_sphere = on_sphere;
      s.pinned = !on_sphere;
      std::printf("| %s | %g | %d | %g | %s | %s | %s |\n", name_of(row.type), double(row.k),
                  row.iterations, double(row.u), on_sphere ? "on a sphere" : "hangs",
                  seed_outcome(s).c_str(), our_outcome(s).c_str());
      std::fflush(stdout);
    }
}

// ---- Efficiency

// Milliseconds of the fastest of several rounds of so many calls, a call.
template <class Work>
double fastest_ms(int rounds, int calls, const Work& work) {
  double best = std::numeric_limits<double>::infinity();
  for (int r = 0; r < rounds; ++r) {
    const auto start = std::chrono::steady_clock::now();
    for (int n = 0; n < calls; ++n) work();
    const std::chrono::duration<double, std::milli> spent =
        std::chrono::steady_clock::now() - start;
    best = std::min(best, spent.count() / calls);
  }
  return best;
}

// Both at the seed's settings for this constraint.
void speed_row(int dim, SeedConstraint type) {
  SeedSettings s;
  s.cloth_dim = dim;
  s.type = type;
  s.k = type == SeedConstraint::positional ? 0.5f : type == SeedConstraint::spring ? 15.f : 10.f;
  s.constraint_iterations = type == SeedConstraint::spring_friction ? 5 : 10;
  SeedSolver seed(s);
  const double theirs = fastest_ms(20, 10, [&] { seed.step(); });
  weft::Simulation ours(scene_of(s), {.threads = 1});
  for (int n = 0; n < 60; ++n) ours.advance_frame();
  const double own = fastest_ms(60, 20, [&] { ours.advance_frame(); });
  const double constraints = double(seed.constraints());
  const int sweeps = type == SeedConstraint::positional ? s.constraint_iterations : 1;
  const double evaluated = constraints * ours.substeps() * sweeps;
  std::printf("| %d | %s | %g × %d | %.0f | %.2f | %.0f | %d × %d | %.0f | %.2f |\n", dim,
              name_of(type), double(s.k), s.constraint_iterations, 1000 / theirs,
              1e6 * theirs / constraints / s.constraint_iterations, 1000 / own, ours.substeps(),
              sweeps, evaluated, 1e6 * own / evaluated);
  std::fflush(stdout);
}

void speed() {
  std::printf(
      "| cloth dim | constraint | K × iterations | seed's solver: frames/s | ns a constraint and "
      "iteration | Weft: frames/s | substeps × sweeps | constraints evaluated a frame | ns a "
      "constraint and sweep |\n|---|---|---|---|---|---|---|---|---|\n");
  for (const int dim : {30, 100})
    for (const SeedConstraint type :
         {SeedConstraint::positional, SeedConstraint::spring, SeedConstraint::spring_friction})
      speed_row(dim, type);
}

// ---- Parameter studies

struct Shape {
  double low = 0, mean = 0;  // heights of the particles [m]
  double roughness = 0;      // mean angle between neighbouring normals along rows [degrees]
};

weft::Vec3 unit(const weft::Vec3& a) {
  return weft::times(a, 1 / std::max(weft::length(a), 1e-30));
}

Shape shape_of(const weft::Simulation& simulation) {
  const weft::Grid& g = simulation.scene().cloths[0].grid;
  const std::vector<double> x = simulation.positions();
  const auto at = [&](int i, int j) {
    const std::size_t p = 3 * (std::size_t(j) * std::size_t(g.nx) + std::size_t(i));
    return weft::Vec3{x[p], x[p + 1], x[p + 2]};
  };
  Shape shape;
  shape.low = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < x.size(); k += 3) {
    shape.low = std::min(shape.low, x[k]);
    shape.mean += x[k] / (double(x.size()) / 3);
  }
  const auto normal = [&](int i, int j) {
    return unit(weft::normal_of(at(i, j), at(i + 1, j), at(i, j + 1)));
  };
  double sum = 0;
  for (int j = 0; j + 1 < g.ny; ++j)
    for (int i = 0; i + 2 < g.nx; ++i) {
      const weft::Vec3 a = normal(i, j), b = normal(i + 1, j);
      sum += std::acos(std::clamp(weft::dot(a, b), -1.0, 1.0));
    }
  shape.roughness = sum / ((g.ny - 1) * (g.nx - 2)) * 180 / 3.14159265358979;
  return shape;
}

// One run of a shipped scene with one value of its file changed, with the limit as the seeds had it.
void study_row(const std::string& scene, const std::string& key, const std::string& value,
               double seconds) {
  const weft::SceneFile file = weft::read_scene(
      scene, {{"/cloth/" + key, value}, {"/cloths/0/strain_limit_order", "course"}});
  if (!file.faults.empty()) {
    std::printf("| %s | %s %s | %s |\n", scene.c_str(), key.c_str(), value.c_str(),
                file.faults[0].what.c_str());
    return;
  }
  weft::Simulation simulation(file.scene);
  double lowest = std::numeric_limits<double>::infinity();
  while (simulation.time() < seconds && simulation.status().ok) {
    simulation.advance_frame();
    lowest = std::min(lowest, shape_of(simulation).low);
  }
  const Shape end = shape_of(simulation);
  const weft::Report report = simulation.report(false);
  std::printf("| %s | %s = %s | %.1f | %.3f | %.3f | %.3f | %.1f | %.1f |\n", scene.c_str(),
              key.c_str(), value.c_str(), seconds, end.low, end.mean, lowest, end.roughness,
              100 * report.strain.max);
  std::fflush(stdout);
}

void studies() {
  std::printf(
      "| scene | value | s | lowest point [m] | mean height [m] | lowest on the way [m] | "
      "angle between neighbouring normals [°] | greatest strain [%%] |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const char* scene : {"pinned2", "pinned4"}) {
    for (const char* ks : {"500", "1000", "5000", "20000", "50000"}) study_row(scene, "ks", ks, 3);
    for (const char* density : {"15", "150", "1000", "1500"})
      study_row(scene, "density", density, 3);
    for (const char* damping : {"0.1", "0.2", "0.5", "0.9"})
      study_row(scene, "damping", damping, 3);
  }
  for (const char* ks : {"500", "5000", "50000"}) study_row("sphere", "ks", ks, 2);
  study_row("plane", "ks", "5000", 2);
  for (const char* ks : {"500", "5000", "50000"}) study_row("selfCollision", "ks", ks, 2.5);
  for (const char* density : {"15", "150", "1000", "1500"})
    study_row("selfCollision", "density", density, 2.5);
}

}  // namespace
}  // namespace bench

int main(int count, char** words) {
  const std::string what = count == 2 ? words[1] : "";
  if (what == "robustness")
    bench::robustness();
  else if (what == "speed")
    bench::speed();
  else if (what == "studies")
    bench::studies();
  else
    return std::fprintf(stderr, "usage: seeds robustness|speed|studies\n"), 2;
}
