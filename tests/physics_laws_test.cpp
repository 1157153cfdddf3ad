// Laws that hold whatever the scene: forces are the slope of the energy, momentum is conserved, all
// things fall alike, the leapfrog is of second order.
#include <gtest/gtest.h>

#include "physics/model/lattice/energy.h"
#include "sheets.h"
#include "weft/random.h"

namespace weft {
namespace {

std::vector<Vec3> random_positions(const Cloth& cloth, double spread) {
  Random random(2, 4);
  std::vector<Vec3> x;
  const Grid& g = cloth.grid;
  for (int j = 0; j < g.ny; ++j)
    for (int i = 0; i < g.nx; ++i) {
      Vec3 p;
      for (std::size_t c = 0; c < 3; ++c)
        p[c] = g.u[c] * i / (g.nx - 1) + g.v[c] * j / (g.ny - 1) + spread * random.symmetric();
      x.push_back(p);
    }
  return x;
}

TEST(Forces, AreTheSlopeOfTheEnergy) {
  for (int level = 0; level <= 4; ++level) {
    Cloth cloth;
    cloth.grid.nx = 7;
    cloth.grid.ny = 6;
    cloth.stiffness = {1000, 700, 200};
    cloth.level = level;
    cloth.stiffness_gradient = 0.3;
    const auto stencils = physics::stencils_of(cloth);
    std::vector<Vec3> x = random_positions(cloth, 0.05);
    const auto force = physics::spring_forces(cloth, stencils, x, nullptr);
    // Central differences: error h² E''' ~ 1e-10 · 1e3/0.1², rounding 1e-16 E/h.
    constexpr double h = 1e-5;
    for (std::size_t p = 0; p < x.size(); ++p)
      for (std::size_t c = 0; c < 3; ++c) {
        const double kept = x[p][c];
        x[p][c] = kept + h;
        const double above = physics::elastic_energy(cloth, stencils, x);
        x[p][c] = kept - h;
        const double below = physics::elastic_energy(cloth, stencils, x);
        x[p][c] = kept;
        EXPECT_NEAR(force[p][c], -(above - below) / (2 * h), 2e-5) << level << ' ' << p;
      }
  }
}

// A free sheet without gravity, thrown and spinning, of unequal masses.
Scene thrown_sheet(Method method, Sweep sweep) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {21, 17, {-0.5, 0.1, -0.4}, {1, 0, 0}, {0, 0, 0.8}, 0.005};
  cloth.stiffness = {100, 80, 20};
  cloth.spring_damping = {0.02, 0.01, 0};
  Random random(9, 9);
  for (int p = 0; p < 21 * 17; ++p) cloth.masses.push_back(0.01 + 0.02 * random.unit());
  scene.solver.method = method;
  scene.solver.sweep = sweep;
  scene.solver.iterations = 2;
  scene.time = {0.01, 10, 5};
  return scene;
}

void spin(Simulation& simulation) {
  const std::vector<double> x = simulation.positions();
  Random random(1, 1);
  std::vector<double> v;
  for (std::size_t p = 0; p < x.size(); p += 3)
    for (const double u : {0.4 - 2 * x[p + 2], 0.3, -0.2 + 2 * x[p]})
      v.push_back(u + 0.3 * random.symmetric());
  simulation.set_state(x, v);
}

TEST(Momentum, OfAFreeSheetIsConserved) {
  using enum Method;
  using enum Sweep;
  const std::pair<Method, Sweep> all[] = {
      {spring, gauss_seidel}, {spring_friction, gauss_seidel}, {positional, gauss_seidel},
      {positional, jacobi},   {compliant, gauss_seidel},       {compliant, jacobi}};
  for (const auto& [method, sweep] : all) {
    Simulation simulation(thrown_sheet(method, sweep));
    spin(simulation);
    const Report before = simulation.report();
    for (int frame = 0; frame < 50; ++frame) simulation.advance_frame();
    const Report after = simulation.report();
    double speed = 0, linear = 0, angular = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      speed += std::abs(before.momentum[c]);
      linear += std::abs(after.momentum[c] - before.momentum[c]);
      angular += std::abs(after.angular_momentum[c] - before.angular_momentum[c]);
    }
    const double spinning = std::abs(before.angular_momentum[1]);
    const bool forces = method == spring || method == spring_friction;
    // Velocities of springs round to 2^-24 of themselves. Projecting methods take theirs from
    // positions that round by 6e-8 m a few times a millisecond: 1e-4 m/s for each of 357 particles
    // and 500 substeps, of random sign, against 0.9 m/s for all: √(357·500)/357 · 1e-4/0.9
    // = 1.3e-4.
    EXPECT_LT(linear / speed, forces ? 1e-6 : 6e-4) << int(method) << int(sweep);
    // Projection turns with an error of first order in the substep; springs with none.
    if (forces) {
      EXPECT_LT(angular / spinning, 1e-5) << int(method);
    }
  }
}

class FreeFall : public testing::TestWithParam<int> {};

// x0 + v0 t + g t²/2 for half a second in one frame.
TEST_P(FreeFall, IsExactToRounding) {
  const int substeps = GetParam();
  for (const bool springs : {false, true}) {
    Scene scene;
    scene.cloths.emplace_back();
    scene.cloths[0].grid = {20, 5, {0, 2, 0}, {1, 0, 0}, {0, 0, 0.25}, 0};
    if (!springs) scene.cloths[0].stiffness = {0, 0, 0};
    // Soft enough to be stable in a single substep of half a second.
    if (springs) scene.cloths[0].stiffness = {0.001, 0.001, 0};
    scene.cloths[0].particle_mass = 0.1;
    scene.time = {0.5, substeps, 5};
    Simulation simulation(scene);
    ASSERT_TRUE(simulation.plan().notes.empty());
    const std::vector<double> start = simulation.positions();
    const Vec3 v{0.7, 1.3, -0.4};
    set_velocity(simulation, v);
    simulation.advance_frame();
    const std::vector<double> x = simulation.positions();
    for (std::size_t n = 0; n < x.size(); ++n) {
      const double truth = start[n] + 0.5 * v[n % 3] + 0.125 * scene.gravity[n % 3];
      // Positions up to 2.1 m round by 1.2e-7 m a substep, velocities of 4 m/s by 2.4e-7.
      EXPECT_NEAR(x[n], truth, 2e-7 * (3 + substeps)) << n;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, FreeFall, testing::Values(1, 3, 17, 100),
                         [](const auto& test) { return std::to_string(test.param); });

// Far down, where positions round by more than gravity adds in a substep, velocities still gain it.
TEST(LongFall, GoesOnGainingSpeed) {
  struct Variant {
    Method method;
    Sweep sweep;
    int order;
  };
  for (const auto& [method, sweep, order] :
       {Variant{Method::spring, Sweep::gauss_seidel, 1},
        Variant{Method::positional, Sweep::gauss_seidel, 1},
        Variant{Method::positional, Sweep::jacobi, 1},
        Variant{Method::compliant, Sweep::gauss_seidel, 1},
        Variant{Method::compliant, Sweep::line, 1}, Variant{Method::compliant, Sweep::line, 2}}) {
    Scene scene;
    scene.cloths.emplace_back();
    scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = 8;
    scene.solver = {.method = method, .sweep = sweep, .order = order};
    Simulation simulation(scene);
    while (simulation.time() < 30) simulation.advance_frame();
    const std::vector<double> v = simulation.velocities();
    const double truth = -9.81 * simulation.time();
    for (std::size_t n = 1; n < v.size(); n += 3)
      ASSERT_NEAR(v[n], truth, 1e-3 * -truth) << int(method) << int(sweep) << order;
  }
}

TEST(Period, OfOneSpringIsOfSecondOrder) {
  const double truth = 2 * std::acos(-1.0) * std::sqrt(0.1 / 10);
  double before = 0;
  for (int n = 10; n <= 160; n *= 2) {
    const double error = std::abs(ten_periods(truth / n) / (10 * truth) - 1);
    if (before > 0) {
      EXPECT_GE(std::log2(before / error), 1.9) << n;
      EXPECT_LE(std::log2(before / error), 2.1) << n;
    }
    before = error;
  }
  EXPECT_LT(before, 1e-4);
}

}  // namespace
}  // namespace weft
