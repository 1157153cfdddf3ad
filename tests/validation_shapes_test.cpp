// Hanging shapes at rest against closed forms, and against themselves at finer resolutions.
#include <algorithm>

#include "sheets.h"
#include "truth.h"

namespace weft {
namespace {

// A chain of 64 links that cannot stretch, two side by side: laid straight, then its right end
// carried in to 1 m. Solved as a whole, however long it is.
double sag(double chain_length) {
  constexpr int kLinks = 64;
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {kLinks + 1, 2, {0, 0, 0}, {chain_length, 0, 0}, {0, 0, 0.1}, 0};
  cloth.particle_mass = 0.001;
  cloth.stiffness = {1e9, 0, 0};
  cloth.drag = 4;
  for (int j = 0; j < 2; ++j) {
    cloth.pins.push_back({0, j, {}});
    cloth.pins.push_back({kLinks, j, {{0, {chain_length, 0, 0.1 * j}}, {0.5, {1, 0, 0.1 * j}}}});
  }
  scene.solver.method = Method::compliant;
  scene.solver.sweep = Sweep::line;
  scene.time.substeps = 16;
  Simulation simulation(scene);
  advance(simulation, 5);
  EXPECT_LT(simulation.report().strain.max, 1e-5);
  double lowest = 0;
  for (int i = 0; i < kLinks; ++i) lowest = std::max(lowest, -position(simulation, i, 0)[1]);
  return lowest;
}

TEST(Catenary, HasTheSagOfItsLength) {
  const std::pair<double, double> truths[] = {
      {1.05, 0.13930}, {1.1, 0.20030}, {1.2, 0.29234}, {1.5, 0.50263}, {2, 0.79639}};
  for (const auto& [chain_length, truth] : truths) {
    char name[64];
    std::snprintf(name, sizeof name, "span 1 m, length %.4g m, 64 links, compliant, line",
                  chain_length);
    expect({"catenary, sag", name, truth, 1e-3, "m"}, sag(chain_length));
  }
}

// A strip hung by its upper edge: structural springs only, E₂D = kn for a load along the columns.
TEST(HangingStrip, StretchesByItsWeight) {
  constexpr int kRows = 41, kColumns = 11;
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {kColumns, kRows, {0, 0, 0}, {0.25, 0, 0}, {0, -1, 0}, 0};
  cloth.density = 0.5;
  cloth.stiffness = {200, 0, 0};
  cloth.drag = 6;
  for (int i = 0; i < kColumns; ++i) cloth.pins.push_back({i, 0, {}});
  scene.time = {1.0 / 60, kAutoSubsteps, 10};
  Simulation simulation(scene);
  advance(simulation, 5);
  const double load = 0.5 * 9.81 / 200, spring = 1.0 / (kRows - 1);
  const double top = -position(simulation, 5, 1)[1] / spring - 1;
  const double longer = -position(simulation, 5, kRows - 1)[1] - 1;
  // In the middle of the first spring.
  expect({"hanging strip", "top strain", load * (1 - spring / 2), 1e-3, ""}, top);
  expect({"hanging strip", "elongation", load / 2, 1e-3, "m"}, longer);
}

// Positions of a hammock of (n+1) x (n+1) particles after 0.3 s at 25 x 25 places, the same for
// all n: 1 m square, 0.3 kg, held along two opposite sides, springs that a membrane of any
// resolution shares.
std::vector<double> hammock(int n) {
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid.nx = cloth.grid.ny = n + 1;
  cloth.stiffness = {200, 100, 0};
  // The border stands for half a cell, a corner for a quarter.
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      cloth.masses.push_back(0.3 / n / n * (i % n == 0 ? 0.5 : 1) * (j % n == 0 ? 0.5 : 1));
  for (int i = 0; i <= n; ++i)
    for (const int j : {0, n}) cloth.pins.push_back({i, j, {}});
  scene.time = {0.01, kAutoSubsteps, 1};
  Simulation simulation(scene);
  advance(simulation, 0.3);
  std::vector<double> x;
  for (int j = 0; j <= 24; ++j)
    for (int i = 0; i <= 24; ++i)
      for (const double c : position(simulation, i * n / 24, j * n / 24)) x.push_back(c);
  return x;
}

TEST(Resolution, FinerSheetsComeTogether) {
  std::vector<double> coarse = hammock(24);
  double before = 0;
  for (const int n : {48, 96, 192}) {
    const std::vector<double> fine = hammock(n);
    double squared = 0;
    for (std::size_t c = 0; c < fine.size(); ++c)
      squared += (fine[c] - coarse[c]) * (fine[c] - coarse[c]);
    const double change = std::sqrt(3 * squared / double(fine.size()));
    const std::string name = std::to_string(n / 2 + 1) + " to " + std::to_string(n + 1);
    show({"hammock in motion, distance of resolutions", "N = " + name, 0, 0.02, "m"}, change);
    if (before > 0) {
      // The springs of a free border stand for half a cell and are as stiff as all: first order.
      expect({"hammock in motion, distance of resolutions", "order at N = " + name, 1, 0.5, "log₂"},
             std::log2(before / change));
    }
    coarse = fine;
    before = change;
  }
}

}  // namespace
}  // namespace weft
