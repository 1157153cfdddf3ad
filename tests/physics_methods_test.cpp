// Every method and feature against the equations in double precision (oracle.h), over ten substeps.
#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "oracle.h"
#include "weft/random.h"

namespace weft {
namespace {

constexpr int kFrames = 2;
constexpr int kSubsteps = 5;

struct Case {
  std::string name;
  std::function<void(Scene&)> change;
};

// 19 columns: one whole group of 16 lanes and a rest. Particles 0.1 m and 100 g, springs whose
// highest frequency is some 0.2 of what the substep would allow.
Scene sheet() {
  Cloth cloth;
  cloth.grid = {19, 11, {0.1, 0.2, -0.3}, {1.8, 0, 0.2}, {0, 0.3, 1.0}, 0.02};
  cloth.particle_mass = 0.1;
  cloth.stiffness = {100, 80, 30};
  Scene scene;
  scene.cloths = {cloth};
  scene.time = {0.01, kSubsteps, 5};
  return scene;
}

void pin(Scene& s) {
  s.cloths[0].pins = {{0, 0, {}}, {18, 0, {}}, {7, 5, {}}, {8, 5, {}}};
}

void move_pin(Scene& s) {
  pin(s);
  s.cloths[0].pins[1].keys = {{0, {1.9, 0.2, -0.1}}, {kFrames * 0.01, {2.0, 0.4, -0.3}}};
}

// Masses from 50 to 200 g, of no order.
void weigh(Scene& s) {
  Random random(3, 0);
  for (int p = 0; p < s.cloths[0].grid.nx * s.cloths[0].grid.ny; ++p)
    s.cloths[0].masses.push_back(0.05 + 0.15 * random.unit());
}

// An inner particle of 100 g.
void by_area(Scene& s) {
  s.cloths[0].particle_mass = 0;
  s.cloths[0].density = 10;
  s.cloths[0].lumping = Lumping::area;
}

std::vector<Case> features() {
  std::vector<Case> all{{"plain", [](Scene&) {}},
                        {"pins", pin},
                        {"moving pin", move_pin},
                        {"masses", weigh},
                        {"drag", [](Scene& s) { s.cloths[0].drag = 8; }},
                        {"gradient", [](Scene& s) { s.cloths[0].stiffness_gradient = 0.7; }},
                        {"strain limit",
                         [](Scene& s) {
                           pin(s);
                           s.cloths[0].strain_limit = 0.02;
                           s.cloths[0].strain_limit_order = StrainLimitOrder::colours;
                         }},
                        {"structural only",
                         [](Scene& s) {
                           s.cloths[0].stiffness = {100, 0, 0};
                         }},
                        {"shear only",
                         [](Scene& s) {
                           s.cloths[0].stiffness = {0, 100, 0};
                         }},
                        {"no bend", [](Scene& s) { s.cloths[0].stiffness.bend = 0; }},
                        {"two columns",
                         [](Scene& s) {
                           s.cloths[0].grid.nx = 2, s.cloths[0].grid.u = {0.1, 0, 0};
                         }},
                        {"two rows",
                         [](Scene& s) {
                           s.cloths[0].grid.ny = 2, s.cloths[0].grid.v = {0, 0, 0.1};
                         }},
                        {"32 columns",
                         [](Scene& s) {
                           s.cloths[0].grid.nx = 32, s.cloths[0].grid.u = {3.1, 0, 0.2};
                         }},
                        {"by area", by_area},
                        {"by area, two columns",
                         [](Scene& s) {
                           by_area(s);
                           s.cloths[0].grid.nx = 2, s.cloths[0].grid.u = {0.1, 0, 0};
                         }},
                        {"by area, 32 columns, gradient, pins",
                         [](Scene& s) {
                           by_area(s);
                           move_pin(s);
                           s.cloths[0].stiffness_gradient = 0.4;
                           s.cloths[0].grid.nx = 32, s.cloths[0].grid.u = {3.1, 0, 0.2};
                         }},
                        {"by area, no shear",
                         [](Scene& s) {
                           by_area(s);
                           s.cloths[0].stiffness.shear = 0;
                         }},
                        {"by area, masses",
                         [](Scene& s) {
                           by_area(s);
                           weigh(s);
                         }},
                        {"all at once", [](Scene& s) {
                           move_pin(s);
                           weigh(s);
                           s.cloths[0].drag = 3;
                           s.cloths[0].stiffness_gradient = 0.4;
                           s.cloths[0].strain_limit = 0.05;
                           s.cloths[0].strain_limit_order = StrainLimitOrder::colours;
                         }}};
  for (int level = 1; level <= 4; ++level)
    all.push_back({"level " + std::to_string(level), [level](Scene& s) {
                     s.cloths[0].level = level;
                     s.cloths[0].stiffness = {25, 0, 0};
                     move_pin(s);
                     if (level % 2 == 0)
                       by_area(s);
                     else
                       weigh(s);
                   }});
  return all;
}

std::vector<Case> methods() {
  const auto projecting = [](Method method, Sweep sweep, int iterations, double share) {
    return [=](Scene& s) {
      s.solver.method = method;
      s.solver.sweep = sweep;
      s.solver.iterations = iterations;
      s.cloths[0].positional_k = share;
    };
  };
  using enum Method;
  using enum Sweep;
  return {{"spring", [](Scene&) {}},
          {"spring_friction, undamped", [](Scene& s) { s.solver.method = spring_friction; }},
          {"spring_friction",
           [](Scene& s) {
             s.solver.method = spring_friction;
             s.cloths[0].spring_damping = {0.3, 0.2, 0.1};
           }},
          {"positional", projecting(positional, gauss_seidel, 1, 0.5)},
          {"positional, k 0.2, 3 sweeps", projecting(positional, gauss_seidel, 3, 0.2)},
          {"positional, jacobi", projecting(positional, jacobi, 2, 0.5)},
          {"compliant", projecting(compliant, gauss_seidel, 1, 0.5)},
          {"compliant, 4 sweeps", projecting(compliant, gauss_seidel, 4, 0.5)},
          {"compliant, jacobi", projecting(compliant, jacobi, 1, 0.5)},
          {"compliant, jacobi, 4 sweeps", projecting(compliant, jacobi, 4, 0.5)}};
}

std::vector<double> start_velocities(const Scene& scene) {
  Random random(11, 2);
  std::vector<double> v;
  for (int n = 0; n < 3 * scene.cloths[0].grid.nx * scene.cloths[0].grid.ny; ++n)
    v.push_back(double(float(0.5 * random.symmetric())));
  return v;
}

// Both errors [m], [m/s] after kFrames frames.
struct Errors {
  double x = 0, v = 0, moved = 0;
};

Errors errors_of(const Scene& scene) {
  Simulation simulation(scene);
  const std::vector<double> start = simulation.positions(), v = start_velocities(scene);
  oracle::Cloth truth(scene, start);
  simulation.set_state(start, v);
  truth.set_velocities(v);
  for (int frame = 0; frame < kFrames; ++frame) simulation.advance_frame();
  for (int step = 0; step < kFrames * kSubsteps; ++step) truth.substep();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  const std::vector<double> x = simulation.positions(), u = simulation.velocities();
  const std::vector<Vec3> velocities = truth.velocities();
  Errors worst;
  for (std::size_t p = 0; p < truth.particles.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t n = 3 * p + c;
      worst.x = std::max(worst.x, std::abs(x[n] - truth.particles[p].x[c]));
      worst.v = std::max(worst.v, std::abs(u[n] - velocities[p][c]));
      worst.moved = std::max(worst.moved, std::abs(x[n] - start[n]));
    }
  return worst;
}

// What rounding may add up to. Positions of up to 3.3 m round to 2e-7 m at every change. Springs
// keep the velocity apart from the position, so that the roundings of n = 10 substeps add up as √n;
// forces see them as 8 k/m · 2e-7 m · 2 ms = 3e-6 m/s a substep. The strain limit turns them into
// velocity over one substep, 2e-7 m / 2 ms = 1e-4 m/s. Projecting methods correct a particle up to
// some 50 times a substep, which rounds it by √50 · 2e-7 = 1.4e-6 m and its velocity by that over
// 2 ms, 7e-4 m/s: velocities wander by √n of that, positions by n^1.5 · 1.4e-6 m = 4.5e-5 m. A
// wrong constant, order or sign moves particles by 1e-3 m and more in these runs.
struct Tolerance {
  double x, v;
};
Tolerance tolerance_of(const Scene& scene) {
  const Method method = scene.solver.method;
  if (method != Method::spring && method != Method::spring_friction) return {4e-5, 2e-3};
  return {2e-6, scene.cloths[0].strain_limit > 0 ? 3e-4 : 5e-5};
}

class Methods : public testing::TestWithParam<Case> {};

TEST_P(Methods, FollowTheEquations) {
  double worst_x = 0, worst_v = 0;
  for (const Case& feature : features()) {
    Scene scene = sheet();
    feature.change(scene);
    GetParam().change(scene);
    const Errors e = errors_of(scene);
    EXPECT_LT(e.x, tolerance_of(scene).x) << feature.name;
    EXPECT_LT(e.v, tolerance_of(scene).v) << feature.name;
    EXPECT_GT(e.moved, 0.005) << feature.name;
    worst_x = std::max(worst_x, e.x);
    worst_v = std::max(worst_v, e.v);
  }
  std::printf("%-30s largest error %.2g m, %.2g m/s\n", GetParam().name.c_str(), worst_x, worst_v);
}

std::string identifier(const std::string& name) {
  std::string word;
  for (const char c : name) word += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return word;
}

INSTANTIATE_TEST_SUITE_P(, Methods, testing::ValuesIn(methods()),
                         [](const auto& test) { return identifier(test.param.name); });

}  // namespace
}  // namespace weft
