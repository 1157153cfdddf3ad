// Strain limits that hold (StrainLimitOrder::strict), against what must be true of any: lengths, momentum, energy;
// and against one pass a substep.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>

#include "weft/simulation.h"

namespace weft {
namespace {

struct Way {
  Method method;
  Sweep sweep;
  const char* name;
};
constexpr Way kWays[] = {{Method::spring, Sweep::gauss_seidel, "springs"},
                         {Method::spring_friction, Sweep::gauss_seidel, "springs with friction"},
                         {Method::compliant, Sweep::gauss_seidel, "compliant"},
                         {Method::compliant, Sweep::line, "compliant lines"},
                         {Method::positional, Sweep::gauss_seidel, "positional"}};

double drawn(std::mt19937& random, double low, double high) {
  return low + (high - low) * double(random()) / 4294967295.0;
}

Scene soft_sheet(std::mt19937& random, const Way& way, double limit) {
  Scene s;
  s.solver.method = way.method;
  s.solver.sweep = way.sweep;
  s.time.substeps = 60;
  Cloth c;
  const int nx = 9 + int(random() % 24), ny = 9 + int(random() % 24);
  c.grid = {nx, ny, {0, 1, 0}, {drawn(random, 0.5, 1.5), 0, 0}, {0, 0, drawn(random, 0.5, 1.5)}, 0};
  c.density = drawn(random, 0.1, 1);
  c.stiffness = {drawn(random, 30, 300), drawn(random, 10, 100), 0};
  c.strain_limit = limit;
  s.cloths.push_back(c);
  return s;
}

// The greatest structural strain at any frame's end.
double greatest_strain(Simulation& simulation, int frames) {
  double greatest = 0;
  for (int f = 0; f < frames; ++f) {
    simulation.advance_frame();
    greatest = std::max(greatest, simulation.report().strain.max);
  }
  return greatest;
}

Scene with(Scene scene, StrainLimitOrder order) {
  scene.cloths[0].strain_limit_order = order;
  return scene;
}

// Hung by one corner or two, or let fall on a ball.
TEST(StrainLimit, HoldsWherePinsLeaveRoom) {
  std::mt19937 random(11);
  for (const Way& way : kWays)
    for (int n = 0; n < 6; ++n) {
      const double limit = std::array{0.01, 0.03, 0.1}[std::size_t(n % 3)];
      Scene s = soft_sheet(random, way, limit);
      Cloth& c = s.cloths[0];
      if (n < 4) c.pins.push_back({0, 0, {}});
      if (n < 2) c.pins.push_back({c.grid.nx - 1, 0, {}});
      if (n >= 4) {
        s.colliders.emplace_back();
        s.colliders[0].shape = Sphere{{c.grid.u[0] / 2, 0.6, c.grid.v[2] / 2}, 0.25};
      }
      Simulation simulation(with(s, StrainLimitOrder::strict), {.threads = 2});
      const double greatest = greatest_strain(simulation, 60);
      EXPECT_LT(greatest, 1.6 * limit) << way.name << ", sheet " << n;
      EXPECT_TRUE(simulation.status().ok);
    }
}

// Two pins drawn apart to up to three times the sheet's width: no limit can hold.
TEST(StrainLimit, MakesNoMotionWherePinsLeaveNoRoom) {
  std::mt19937 random(12);
  for (const Way& way : kWays)
    for (int n = 0; n < 4; ++n) {
      Scene s = soft_sheet(random, way, std::array{0.02, 0.1}[std::size_t(n % 2)]);
      Cloth& c = s.cloths[0];
      const Vec3 at{c.grid.u[0], 1, 0}, away{c.grid.u[0] * (1 + drawn(random, 0.5, 2)), 1, 0};
      if (n >= 2) c.tear_strain = 0.5;
      c.pins = {{0, 0, {}}, {c.grid.nx - 1, 0, {{0, at}, {0.5, away}, {1, at}}}};
      const auto kinetic = [&](StrainLimitOrder order) {
        Simulation simulation(with(s, order), {.threads = 2});
        double greatest = 0;
        for (int f = 0; f < 70; ++f) {
          simulation.advance_frame();
          greatest = std::max(greatest, simulation.report().energy.kinetic);
        }
        EXPECT_TRUE(simulation.status().ok) << way.name << ", sheet " << n;
        return greatest;
      };
      EXPECT_LT(kinetic(StrainLimitOrder::strict), 3 * kinetic(StrainLimitOrder::colours))
          << way.name << ", sheet " << n;
    }
}

// A free sheet that flies apart and turns: momentum and turns stay, and energy does not grow. (Positional
// constraints round their velocities by more than that, limit or not.)
TEST(StrainLimit, KeepsMomentumAndAddsNoEnergy) {
  std::mt19937 random(13);
  for (const Way& way : std::span(kWays).first(4))
    for (int n = 0; n < 3; ++n) {
      Scene s = soft_sheet(random, way, 0.02);
      s.gravity = {0, 0, 0};
      Simulation simulation(with(s, StrainLimitOrder::strict), {.threads = 2});
      std::vector<double> x = simulation.positions(), v(x.size());
      const Grid& g = s.cloths[0].grid;
      const double spin = drawn(random, 1, 4), apart = drawn(random, 0.5, 2);
      for (std::size_t p = 0; p < x.size(); p += 3) {
        const double px = x[p] - g.u[0] / 2, pz = x[p + 2] - g.v[2] / 2;
        v[p] = apart * px + spin * pz + 0.3;
        v[p + 1] = 0.2 * std::sin(9 * px) * std::cos(7 * pz);
        v[p + 2] = apart * pz - spin * px;
      }
      simulation.set_state(x, v);
      const Report start = simulation.report();
      simulation.advance_frame();
      const double energy = simulation.report().energy.total;
      for (int f = 1; f < 60; ++f) simulation.advance_frame();
      const Report end = simulation.report();
      const double scale =
          std::sqrt(2 * start.energy.kinetic * s.cloths[0].density * g.u[0] * g.v[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(end.momentum[k], start.momentum[k], 1e-4 * scale)
            << way.name << ", sheet " << n;
        EXPECT_NEAR(end.angular_momentum[k], start.angular_momentum[k], 2e-3 * scale)
            << way.name << ", sheet " << n;
      }
      EXPECT_LT(end.energy.total, 1.02 * std::max(energy, start.energy.total))
          << way.name << ", sheet " << n;
    }
}

}  // namespace
}  // namespace weft
