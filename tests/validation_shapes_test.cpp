// Hanging shapes at rest against closed forms, energy over a long time, and a pendulum: truth,
// result and error are printed.
#include <gtest/gtest.h>

#include <algorithm>

#include "physics/random.h"
#include "sheets.h"

namespace weft {
namespace {

double error_of(const std::string& what, double truth, double result) {
  const double error = result / truth - 1;
  std::printf("%-34s truth %.6f  result %.6f  error %+.1e\n", what.c_str(), truth, result, error);
  testing::Test::RecordProperty(what, std::to_string(error));
  return std::abs(error);
}

// A chain of 64 stiff links between supports 1 m apart, two rows side by side: it starts as a
// straight line stretched to its supports, whose links are too long by nothing once it sags.
double sag_of_chain(double chain_length) {
  constexpr int kLinks = 64;
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {kLinks + 1, 2, {0, 0, 0}, {chain_length, 0, 0}, {0, 0, 0.1}, 0};
  cloth.particle_mass = 0.001;
  cloth.stiffness = {3000, 0, 0};
  cloth.drag = 4;
  // The right support is carried in to 1 m.
  for (int j = 0; j < 2; ++j) {
    cloth.pins.push_back({0, j, {}});
    cloth.pins.push_back({kLinks, j, {{0, {chain_length, 0, 0.1 * j}}, {0.5, {1, 0, 0.1 * j}}}});
  }
  scene.time = {1.0 / 60, kAutoSubsteps, 10};
  Simulation simulation(scene);
  advance(simulation, 5);
  double lowest = 0;
  for (int i = 0; i <= kLinks; ++i) lowest = std::min(lowest, position(simulation, i, 0)[1]);
  return -lowest;
}

TEST(Catenary, HasTheSagOfItsLength) {
  const std::pair<double, double> truths[] = {
      {1.05, 0.13930}, {1.1, 0.20030}, {1.2, 0.29234}, {1.5, 0.50263}, {2, 0.79639}};
  for (const auto& [chain_length, sag] : truths)
    EXPECT_LT(error_of("catenary, length " + std::to_string(chain_length), sag,
                       sag_of_chain(chain_length)),
              2e-3);
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
  // Particles of equal mass on an (n-1)-cell grid: each column bears density/n of the width, and
  // the first spring all rows but the pinned one.
  const double density = 0.5 * (kColumns - 1) / kColumns * (kRows - 1) / kRows;
  const double spring = 1.0 / (kRows - 1);
  const double top = -position(simulation, 5, 1)[1] / spring - 1;
  const double longer = -position(simulation, 5, kRows - 1)[1] - 1;
  EXPECT_LT(error_of("strip, top strain", density * 9.81 / 200, top), 1e-3);
  // Half the top strain in the continuum; (n+1)/2n of it for n springs.
  EXPECT_LT(
      error_of("strip, elongation", density * 9.81 / 200 * kRows / (2.0 * (kRows - 1)), longer),
      1e-3);
}

TEST(Energy, OfAFreeSheetIsKeptFor100000Substeps) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {12, 12, {-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.particle_mass = 0.01;
  cloth.stiffness = {100, 100, 20};
  scene.time = {0.1, 1, 100};
  scene.time.substeps = 2 * int(std::ceil(0.1 / Simulation([&] {
                                                  Scene automatic = scene;
                                                  automatic.time.substeps = kAutoSubsteps;
                                                  return automatic;
                                                }())
                                                    .plan()
                                                    .dt_limit));
  Simulation simulation(scene);
  const std::vector<double> x = simulation.positions();
  physics::Random random(5, 5);
  std::vector<double> v;
  for (std::size_t n = 0; n < x.size(); ++n) v.push_back(0.05 * random.symmetric());
  simulation.set_state(x, v);
  const double start = simulation.report().energy.total;
  const int frames = 100000 / simulation.substeps();
  double first = 0, last = 0, worst = 0;
  for (int frame = 0; frame < frames; ++frame) {
    simulation.advance_frame();
    const double error = simulation.report().energy.total / start - 1;
    worst = std::max(worst, std::abs(error));
    (frame < frames / 2 ? first : last) += 2 * error / frames;
  }
  std::printf("energy over 100000 substeps: largest error %.1e, means of the halves %+.1e %+.1e\n",
              worst, first, last);
  EXPECT_LT(std::abs(last - first), 1e-3);
  testing::Test::RecordProperty("energy, largest error", std::to_string(worst));
}

// Time that a rigid link takes from level to plumb: a quarter of the period.
double quarter_period(Method method, int substeps) {
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {2, 2, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.particle_mass = 0.1;
  cloth.stiffness = {1e8, 0, 0};
  cloth.pins = {{0, 0, {}}, {0, 1, {}}};
  scene.solver.method = method;
  scene.time = {0.6 / substeps, 1, 10};
  Simulation simulation(scene);
  double before = 1;
  for (;;) {
    simulation.advance_frame();
    const double now = position(simulation, 1, 0)[0];
    if (now <= 0) return simulation.time() - scene.time.frame * now / (now - before);
    before = now;
  }
}

TEST(Pendulum, OnARigidLinkConvergesToItsPeriod) {
  const double truth = 4 * std::sqrt(1 / 9.81) * 1.8540746773 / 4;
  for (const Method method : {Method::positional, Method::compliant}) {
    double before = 0;
    for (const int substeps : {50, 100, 200, 400}) {
      const double error =
          error_of(std::string(method == Method::positional ? "positional" : "compliant") + ", " +
                       std::to_string(substeps) + " substeps",
                   truth, quarter_period(method, substeps));
      if (before > 0) {
        EXPECT_GT(std::log2(before / error), 0.8) << substeps;
      }
      before = error;
    }
    EXPECT_LT(before, 3e-3);
  }
}

}  // namespace
}  // namespace weft
