// Hanging shapes at rest against closed forms, energy over a long time, and a pendulum: truth,
// result and error are printed.
#include <gtest/gtest.h>

#include <algorithm>

#include "sheets.h"

namespace weft {
namespace {

double error_of(const std::string& what, double truth, double result) {
  const double error = result / truth - 1;
  std::printf("%-34s truth %.6f  result %.6f  error %+.1e\n", what.c_str(), truth, result, error);
  testing::Test::RecordProperty(what, std::to_string(error));
  return std::abs(error);
}

// Sag of an inextensible chain between supports 1 m apart: length = 2 a sinh(1/2a).
double catenary_sag(double chain_length) {
  double low = 0.01, high = 100;
  for (int n = 0; n < 200; ++n) {
    const double a = (low + high) / 2;
    (2 * a * std::sinh(1 / (2 * a)) > chain_length ? low : high) = a;
  }
  return low * (std::cosh(1 / (2 * low)) - 1);
}

struct Hung {
  double sag = 0, length = 0;
};

// A chain of 64 stiff links, two side by side: laid straight, then its right end carried in to 1 m.
Hung hung_chain(double chain_length) {
  constexpr int kLinks = 64;
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {kLinks + 1, 2, {0, 0, 0}, {chain_length, 0, 0}, {0, 0, 0.1}, 0};
  cloth.particle_mass = 0.001;
  cloth.stiffness = {30000, 0, 0};
  cloth.drag = 4;
  for (int j = 0; j < 2; ++j) {
    cloth.pins.push_back({0, j, {}});
    cloth.pins.push_back({kLinks, j, {{0, {chain_length, 0, 0.1 * j}}, {0.5, {1, 0, 0.1 * j}}}});
  }
  scene.time = {1.0 / 60, kAutoSubsteps, 10};
  Simulation simulation(scene);
  advance(simulation, 5);
  Hung hung;
  for (int i = 0; i < kLinks; ++i) {
    const Vec3 a = position(simulation, i, 0), b = position(simulation, i + 1, 0);
    hung.length += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    hung.sag = std::max(hung.sag, -b[1]);
  }
  return hung;
}

TEST(Catenary, HasTheSagOfItsLength) {
  const std::pair<double, double> truths[] = {
      {1.05, 0.13930}, {1.1, 0.20030}, {1.2, 0.29234}, {1.5, 0.50263}, {2, 0.79639}};
  for (const auto& [chain_length, sag] : truths) {
    EXPECT_NEAR(catenary_sag(chain_length), sag, 1e-5);
    // The links stretch a little; the truth is that of the length the chain then has.
    const Hung hung = hung_chain(chain_length);
    EXPECT_NEAR(hung.length / chain_length, 1, 2e-3);
    EXPECT_LT(error_of("catenary, length " + std::to_string(chain_length),
                       catenary_sag(hung.length), hung.sag),
              1e-3);
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

struct Drift {
  double worst, change;  // of the energy: greatest error, and of the mean from half to half
};

// A free sheet that breathes within its plane for 100000 substeps of a share of the stability
// limit.
Drift energy_drift(double share) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {12, 12, {-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.particle_mass = 0.01;
  cloth.stiffness = {100, 100, 20};
  scene.time = {0.1, kAutoSubsteps, 100};
  scene.time.substeps = int(std::ceil(0.1 / share / Simulation(scene).plan().dt_limit));
  Simulation simulation(scene);
  const std::vector<double> x = simulation.positions();
  std::vector<double> v(x.size(), 0.0);
  for (std::size_t n = 0; n < x.size(); ++n)
    if (n % 3 != 1) v[n] = 0.2 * std::sin(3.14159 * x[n]);
  simulation.set_state(x, v);
  const double start = simulation.report().energy.total;
  const int frames = 100000 / simulation.substeps();
  double halves[2] = {0, 0}, worst = 0;
  for (int frame = 0; frame < frames; ++frame) {
    simulation.advance_frame();
    const double error = simulation.report().energy.total / start - 1;
    worst = std::max(worst, std::abs(error));
    halves[2 * frame / frames] += 2 * error / frames;
  }
  std::printf("energy, substep %.3f of the limit: largest error %.1e, change of the mean %+.1e\n",
              share, worst, halves[1] - halves[0]);
  return {worst, std::abs(halves[1] - halves[0])};
}

// What the leapfrog keeps is its own energy, off from the true one by the square of the substep: it
// swings, but does not drift.
TEST(Energy, OfAFreeSheetIsKeptFor100000Substeps) {
  const Drift half = energy_drift(0.5), eighth = energy_drift(0.125);
  EXPECT_LT(half.worst, 1e-2);
  EXPECT_LT(half.change, 1e-3);
  EXPECT_LT(eighth.worst, 1e-3);
  EXPECT_LT(eighth.change, 2e-4);
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
