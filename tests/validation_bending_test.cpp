// The cantilever against the elastica: under its own weight, tip drop, reach and angle and the
// root's curvature for every Γ = ρ g L³/D, and under a load P at its end, drop and reach for every
// P L²/D.
//
// A strip clamped by two pinned columns: the tangent is held halfway between them, which is where
// the beam begins. The last column has half a particle's mass, so that the load ends with the
// strip.
#include <cmath>
#include <numbers>
#include <string>

#include "truth.h"
#include "weft/simulation.h"

namespace weft {
namespace {

struct Row {
  double gamma, drop, reach, angle, curvature;
};
const Row kTable[] = {{1, .1235, .9912, 9.46, .497},     {2, .2385, .9669, 18.43, .977},
                      {5, .4959, .8467, 39.94, 2.227},   {10, .7002, .6564, 60.31, 3.742},
                      {20, .8299, .4452, 76.75, 5.762},  {50, .9079, .2450, 87.46, 9.529},
                      {100, .9375, .1592, 89.62, 13.69}, {200, .9568, .1074, 89.97, 19.56},
                      {500, .9731, .0659, 90.0, 31.19}};

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

struct Shape {
  double drop = 0, reach = 0;  // m, of the end's middle
  double angle = 0;            // degrees, of the last cells below the level
  double curvature = 0;        // 1/m, at the clamp
};

Shape shape_at_rest(const Scene& scene, double seconds) {
  Simulation simulation(scene);
  while (simulation.time() < seconds) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  const Grid& grid = scene.cloths[0].grid;
  const std::vector<double> all = simulation.positions();
  // Middle of a column.
  const auto middle = [&](int i, std::size_t component) {
    double sum = 0;
    for (int j = 0; j < grid.ny; ++j) sum += all[3 * std::size_t(j * grid.nx + i) + component];
    return sum / grid.ny;
  };
  const auto curvature = [&](int i) {
    const double h = spacing_u(grid);
    const auto bent = [&](std::size_t c) {
      return (middle(i - 1, c) - 2 * middle(i, c) + middle(i + 1, c)) / (h * h);
    };
    return std::hypot(bent(0), bent(1));
  };
  const int end = grid.nx - 1;
  Shape shape;
  shape.reach = middle(end, 0);
  shape.drop = -middle(end, 1);
  shape.angle =
      std::atan2(middle(end - 1, 1) - middle(end, 1), middle(end, 0) - middle(end - 1, 0)) * 180 /
      std::numbers::pi;
  // The columns next to the clamp lie half a cell and one and a half from it.
  shape.curvature = 1.5 * curvature(1) - 0.5 * curvature(2);
  return shape;
}

std::string numbered(const char* symbol, double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%s = %g", symbol, value);
  return text;
}

void check(const std::string& name, const Scene& scene, const Row& row, double seconds) {
  const std::string law = "cantilever under its own weight",
                    what = numbered("Γ", row.gamma) + ", " + name + ": ";
  const Shape shape = shape_at_rest(scene, seconds);
  expect({law, what + "drop", row.drop, 0.02, "L"}, shape.drop);
  expect({law, what + "reach", row.reach, 0.02, "L"}, shape.reach);
  expect({law, what + "angle of the tip", row.angle, 0.02, "°"}, shape.angle);
  expect({law, what + "curvature of the root", row.curvature, 0.02, "/L"}, shape.curvature);
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
    s.solver.order = 1;
    s.time.substeps = 64;
    check("compliant, line, 64 substeps", s, row, 6);
  }
}

TEST(Cantilever, SpringsMeetTheElastica) {
  for (const Row& row : kTable) {
    Scene s = cantilever(row.gamma, 60, 2);
    s.cloths[0].stiffness = {5000, 2500, 0};
    check("spring", s, row, 5);
  }
}

// All but the last column weighs next to nothing.
TEST(Cantilever, LineSweepsMeetTheElasticaUnderALoadAtTheEnd) {
  struct EndLoad {
    double p, drop, shortening;
  };
  const EndLoad rows[] = {{.25, .08275, .00412}, {.5, .16214, .01592}, {1, .30172, .05643},
                          {2, .49346, .16064},   {3, .60325, .25442},  {4, .66996, .32894},
                          {5, .71379, .38763},   {10, .81061, .55500}};
  for (const EndLoad& row : rows) {
    constexpr int nx = 60, ny = 3;
    Scene s = cantilever(1, nx, ny);
    Cloth& c = s.cloths[0];
    const double width = (ny - 1) / (nx - 1.5), load = 0.1 * width;
    c.masses.assign(std::size_t(nx) * ny, 1e-3 * load / kGravity / nx / ny);
    for (int j = 0; j < ny; ++j) c.masses[std::size_t(j) * nx + nx - 1] = load / kGravity / ny;
    c.bending = 0.1 / row.p;
    s.solver.method = Method::compliant;
    s.solver.sweep = Sweep::line;
    // A light cloth under a heavy edge: the sweeps converge with small substeps.
    s.time.substeps = 128;
    const Shape shape = shape_at_rest(s, 6);
    const std::string law = "cantilever under a load at its end",
                      what = numbered("PL²/D", row.p) + ", compliant, line: ";
    expect({law, what + "drop", row.drop, 0.02, "L"}, shape.drop);
    expect({law, what + "reach", 1 - row.shortening, 0.02, "L"}, shape.reach);
  }
}

}  // namespace
}  // namespace weft
