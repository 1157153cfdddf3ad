// Axes and cases of the maps (stress_maps.h).
#include "stress_maps.h"

#include <cmath>
#include <cstdio>

namespace bench {
namespace {

using weft::Method;
using weft::Sweep;

struct Solving {
  const char* name;
  Method method;
  Sweep sweep = Sweep::gauss_seidel;
  int order = 1;
  int iterations = 1;
  bool course = false;
};

const std::vector<Solving>& solvings() {
  static const std::vector<Solving> all{
      {"spring", Method::spring},
      {"spring_friction", Method::spring_friction},
      {"compliant, Gauss–Seidel", Method::compliant},
      {"compliant, Jacobi", Method::compliant, Sweep::jacobi},
      {"compliant, line", Method::compliant, Sweep::line},
      {"compliant, line, order 2", Method::compliant, Sweep::line, 2},
      {"positional, Gauss–Seidel", Method::positional},
      {"positional, Jacobi, 5 sweeps", Method::positional, Sweep::jacobi, 1, 5},
      {"positional, line", Method::positional, Sweep::line},
      {"course-style, springs", Method::spring, Sweep::gauss_seidel, 1, 1, true},
      {"course-style, friction", Method::spring_friction, Sweep::gauss_seidel, 1, 1, true},
      {"course-style, positional", Method::positional, Sweep::gauss_seidel, 1, 5, true},
  };
  return all;
}

std::string brief(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", v);
  return text;
}

// Seed 000's sheet: 0.1 kg a particle, 0.15 m apart, constraints to distance 2, 2 % drag a step.
weft::Scene curtain(int n) {
  weft::Scene scene = stress_sheet(n, 0.15, 0.1, true);
  weft::Cloth& cloth = scene.cloths[0];
  cloth.level = 2;
  cloth.stiffness = {50, 0, 0};
  cloth.spring_damping = {0.5, 0, 0};
  cloth.drag = 1.2;
  scene.time = {1.0 / 60, 1, 1};
  return scene;
}

// Seed 003's sheet: 2 m, 1 kg a particle at 100 × 100, soft damped springs.
weft::Scene soft_sheet(int n) {
  weft::Scene scene = stress_sheet(n, 2.0 / (n - 1), 1e4 / n / n, false);
  weft::Cloth& cloth = scene.cloths[0];
  cloth.stiffness = {80, 56, 40};
  cloth.spring_damping = {2, 1, 0.5};
  cloth.stiffness_gradient = 0.4;
  scene.gravity = {0, -0.392, 0};
  scene.time = {1.0 / 60, 1, 1};
  return scene;
}

void set_substep(weft::Scene& scene, double dt) {
  scene.time.frame = std::max(dt, 1.0 / 60);
  scene.time.substeps = int(std::lround(scene.time.frame / dt));
}

MapPlan empty(const std::string& name, HeatMap map) {
  MapPlan plan{name, std::move(map), {}};
  for (const Solving& s : solvings()) plan.map.panels.push_back({s.name, {}});
  return plan;
}

// Fills a plan: scene(column, row) for every cell, from each of the starts.
void fill(MapPlan& plan, const std::vector<Start>& starts,
          const std::function<weft::Scene(std::size_t, std::size_t)>& scene) {
  const std::size_t columns = plan.map.across.ticks.size(), rows = plan.map.up.ticks.size();
  for (std::size_t p = 0; p < solvings().size(); ++p) {
    const Solving& s = solvings()[p];
    plan.map.panels[p].cells.resize(columns * rows);
    for (std::size_t r = 0; r < rows; ++r)
      for (std::size_t c = 0; c < columns; ++c) {
        MapPlan::Cell cell{p, r * columns + c, s.course, {}};
        for (const Start start : starts) {
          // It does not tear, and divides nought by nought where particles coincide.
          if (s.course && (start == Start::shreds || start == Start::coincident)) continue;
          StressCase one;
          one.scene = scene(c, r);
          one.scene.solver.method = s.method;
          one.scene.solver.sweep = s.sweep;
          one.scene.solver.order = s.order;
          one.scene.solver.iterations = s.iterations;
          if (s.method != Method::spring_friction) one.scene.cloths[0].spring_damping = {};
          one.start = start;
          cell.cases.push_back(one);
        }
        plan.cells.push_back(std::move(cell));
      }
  }
}

MapPlan stiffness_map(bool quick) {
  const std::vector<double> rates =
      quick ? std::vector<double>{30, 60, 1000}
            : std::vector<double>{30, 60, 120, 240, 500, 1000, 2000, 5000, 10000};
  std::vector<double> stiffness;
  for (double k = 0.1; k < 2e9; k *= quick ? 1000 : 10) stiffness.push_back(k);
  HeatMap map{"Stiffness and substep",
              "Seed 000's sheet; a cell is the worst of five starts: flat, "
              "folded, inside a ball, all particles in one point, torn to shreds",
              {"substep [s]", {}},
              {"stiffness [N/m]", {}},
              {},
              {}};
  for (const double rate : rates) map.across.ticks.push_back("1/" + brief(rate));
  for (const double k : stiffness) map.up.ticks.push_back(brief(k));
  if (!quick)
    map.marks = {{1, std::log10(14.0 * 6) + 1, "“K over 13, more than 5 iterations: explodes”"}};
  MapPlan plan = empty("stress_stiffness", map);
  fill(plan, {std::begin(kStarts), std::end(kStarts)}, [&](std::size_t c, std::size_t r) {
    weft::Scene scene = curtain(12);
    scene.cloths[0].stiffness.structural = stiffness[r];
    set_substep(scene, 1 / rates[c]);
    return scene;
  });
  return plan;
}

MapPlan mass_map(bool quick) {
  std::vector<double> masses;
  for (double m = 1e-3; m < 2e3; m *= quick ? 1000 : 10) masses.push_back(m);
  const std::vector<double> gravities =
      quick ? std::vector<double>{0.392, 981}
            : std::vector<double>{0.0981, 0.392, 0.981, 9.81, 98.1, 981};
  HeatMap map{"Particle mass and gravity",
              "Seed 003's sheet, a step of 1/60 s; the worse of two starts: flat, inside a ball",
              {"gravity [m/s²]", {}},
              {"mass of a particle [kg]", {}},
              {},
              {}};
  for (const double g : gravities) map.across.ticks.push_back(brief(g));
  for (const double m : masses) map.up.ticks.push_back(brief(m));
  if (!quick)
    map.marks = {{1, 3, "what the seed runs: 1 kg under 0.392 m/s²"},
                 {3, 3, "the Earth's gravity, which it could not use"},
                 {1, 1, "“reduce mass per particle: explodes”"}};
  MapPlan plan = empty("stress_mass", map);
  fill(plan, {Start::flat, Start::inside}, [&](std::size_t c, std::size_t r) {
    weft::Scene scene = soft_sheet(20);
    scene.cloths[0].particle_mass = masses[r];
    scene.gravity = {0, -gravities[c], 0};
    return scene;
  });
  return plan;
}

MapPlan resolution_map(bool quick) {
  const std::vector<int> sizes =
      quick ? std::vector<int>{10, 40} : std::vector<int>{10, 20, 40, 80, 160};
  std::vector<double> factors;
  for (double f = 0.1; f < 2e6; f *= quick ? 1000 : 10) factors.push_back(f);
  HeatMap map{"Resolution and stiffness",
              "Seed 003's sheet of 2 m and 10 t, a step of 1/60 s; the worse of two starts: flat, "
              "inside a ball",
              {"particles along a side", {}},
              {"stiffness, times the seed's", {}},
              {},
              {}};
  for (const int n : sizes) map.across.ticks.push_back(std::to_string(n));
  for (const double f : factors) map.up.ticks.push_back(brief(f));
  if (!quick)
    map.marks = {{3.3, 1, "what the seed runs: 100 × 100"},
                 {4, 2, "“very hard to increase the resolution but keep the stiffness high”"}};
  MapPlan plan = empty("stress_resolution", map);
  fill(plan, {Start::flat, Start::inside}, [&](std::size_t c, std::size_t r) {
    weft::Scene scene = soft_sheet(sizes[c]);
    for (double* k : {&scene.cloths[0].stiffness.structural, &scene.cloths[0].stiffness.shear,
                      &scene.cloths[0].stiffness.bend})
      *k *= factors[r];
    return scene;
  });
  return plan;
}

StressCase told(weft::Scene scene, Start start) {
  StressCase c;
  c.scene = std::move(scene);
  c.start = start;
  c.seconds = 2;
  return c;
}

}  // namespace

std::vector<MapPlan> plan_maps(bool quick) {
  return {stiffness_map(quick), mass_map(quick), resolution_map(quick)};
}

std::vector<Told> told_explosions() {
  std::vector<Told> all;
  weft::Scene s = curtain(30);
  s.solver.method = Method::spring_friction;
  s.cloths[0].stiffness.structural = 14 * 6;
  s.cloths[0].spring_damping.structural = 14 * 6;
  all.push_back({"seed 000: K and U over 13, more than 5 iterations", told(s, Start::flat)});
  s = curtain(30);
  s.solver.method = Method::spring;
  s.cloths[0].stiffness.structural = 150;
  s.cloths[0].spring_damping = {};
  all.push_back({"seed 000: springs, spawned on an object", told(s, Start::inside)});
  s = soft_sheet(100);
  s.solver.method = Method::spring_friction;
  weft::Scene changed = s;
  changed.gravity = {0, -9.81, 0};
  all.push_back({"seed 003: the Earth's gravity", told(changed, Start::inside)});
  changed = s;
  changed.time = {0.1, 1, 1};
  all.push_back({"seed 003: time step of 0.1 s", told(changed, Start::inside)});
  changed = s;
  for (double* k : {&changed.cloths[0].stiffness.structural, &changed.cloths[0].stiffness.shear,
                    &changed.cloths[0].stiffness.bend})
    *k *= 100;
  all.push_back({"seed 003: a hundred times as stiff", told(changed, Start::inside)});
  changed = s;
  changed.cloths[0].particle_mass = 0.01;
  all.push_back({"seed 003: a hundredth of the mass", told(changed, Start::inside)});
  changed = soft_sheet(200);
  changed.solver.method = Method::spring_friction;
  for (double* k : {&changed.cloths[0].stiffness.structural, &changed.cloths[0].stiffness.shear,
                    &changed.cloths[0].stiffness.bend})
    *k *= 10;
  all.push_back({"seed 003: 200 × 200 at ten times the stiffness", told(changed, Start::inside)});
  return all;
}

}  // namespace bench
