// The cantilever under its own weight, against the elastica: tip drop and reach for every Γ = ρ g
// L³/D.
//
// A strip clamped by two pinned columns: the tangent is held halfway between them, which is where
// the beam begins. The last column has half a particle's mass, so that the load ends with the
// strip.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "weft/simulation.h"

namespace weft {
namespace {

struct Row {
  double gamma, drop, reach;
};
const Row kTable[] = {{1, .1235, .9912},   {2, .2385, .9669},  {5, .4959, .8467},
                      {10, .7002, .6564},  {20, .8299, .4452}, {50, .9079, .2450},
                      {100, .9375, .1592}, {200, .9568, .1074}};

constexpr double kDensity = 0.3, kGravity = 9.81;

Scene cantilever(double gamma, int nx, int ny) {
  Scene s;
  const double h = 1 / (nx - 1.5);  // free length 1 m
  Cloth c;
  c.grid = {nx, ny, {-0.5 * h, 0, 0}, {h * (nx - 1), 0, 0}, {0, 0, h * (ny - 1)}, 0};
  c.masses.assign(std::size_t(nx) * ny, kDensity * h * h * (ny - 1) / ny);
  for (int j = 0; j < ny; ++j) {
    c.masses[std::size_t(j) * nx + nx - 1] /= 2;
    c.pins.push_back({0, j, {}});
    c.pins.push_back({1, j, {}});
  }
  c.bending = kDensity * kGravity / gamma;
  c.stiffness = {1e5, 5e4, 0};
  c.drag = 4;
  s.gravity = {0, -kGravity, 0};
  s.cloths.push_back(c);
  return s;
}

void check(const char* name, Scene scene, const Row& row, double seconds) {
  Simulation simulation(scene);
  while (simulation.time() < seconds) simulation.advance_frame();
  ASSERT_TRUE(simulation.status().ok) << simulation.status().text;
  const int nx = scene.cloths[0].grid.nx, ny = scene.cloths[0].grid.ny;
  const std::vector<double> x = simulation.positions();
  double drop = 0, reach = 0;
  for (int j = 0; j < ny; ++j) {
    reach += x[3 * std::size_t(j * nx + nx - 1)] / ny;
    drop -= x[3 * std::size_t(j * nx + nx - 1) + 1] / ny;
  }
  std::printf(
      "%-28s G %3g  drop %.4f truth %.4f error %+.2f %%   reach %.4f truth %.4f error %+.2f %%\n",
      name, row.gamma, drop, row.drop, 100 * (drop / row.drop - 1), reach, row.reach,
      100 * (reach / row.reach - 1));
  EXPECT_NEAR(drop, row.drop, 0.02 * row.drop);
  EXPECT_NEAR(reach, row.reach, 0.02 * row.reach);
}

TEST(Cantilever, LineSweepsMeetTheElastica) {
  for (const Row& row : kTable) {
    Scene s = cantilever(row.gamma, 60, 3);
    s.solver.method = Method::compliant;
    s.solver.sweep = Sweep::line;
    s.time.substeps = 16;
    check("compliant, line", s, row, 6);
    s.solver.order = 2;
    check("compliant, line, order 2", s, row, 6);
  }
}

TEST(Cantilever, SpringsMeetTheElastica) {
  for (const Row& row : kTable) {
    Scene s = cantilever(row.gamma, 40, 2);
    s.cloths[0].stiffness = {5000, 2500, 0};
    check("spring", s, row, 5);
  }
}

}  // namespace
}  // namespace weft
