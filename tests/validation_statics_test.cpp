// Columns at rest against closed forms: truth, result and error are printed.
#include <gtest/gtest.h>

#include <string>

#include "sheets.h"

namespace weft {
namespace {

constexpr int kSprings = 10;
constexpr double kMass = 0.01, kStiffness = 100, kLength = 0.05, kGravity = 9.81;

// Elongation of the column after it has come to rest.
double elongation(const Scene& scene) {
  Simulation simulation(scene);
  advance(simulation, 4);
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  return -position(simulation, 0, kSprings)[1] - kSprings * kLength;
}

double truth() {
  return kMass * kGravity * kSprings * (kSprings + 1) / (2 * kStiffness);
}

// Relative error of the result, printed.
double error_of(const std::string& what, double expected, double result) {
  const double error = result / expected - 1;
  std::printf("%-42s truth %.6f m  result %.6f m  error %+.1e\n", what.c_str(), expected, result,
              error);
  testing::Test::RecordProperty(what, std::to_string(error));
  return std::abs(error);
}

Scene column(Method method, Sweep sweep, double dt, int iterations) {
  Scene scene = hanging_column(kSprings, kMass, kStiffness, kLength);
  scene.cloths[0].drag = 10;
  scene.solver.method = method;
  scene.solver.iterations = iterations;
  scene.solver.sweep = sweep;
  scene.time = {0.016, int(std::lround(0.016 / dt)), 10};
  return scene;
}

TEST(HangingColumn, OfSpringsIsAsLongAsItsWeightMakesIt) {
  for (const double dt : {0.004, 0.001, 0.00025})
    EXPECT_LT(error_of("spring, " + std::to_string(dt) + " s", truth(),
                       elongation(column(Method::spring, Sweep::gauss_seidel, dt, 1))),
              1e-4);
}

// Enough sweeps for the step to be solved: the same column, whatever the substep.
TEST(HangingColumn, OfCompliantConstraintsToo) {
  struct Case {
    Sweep sweep;
    double dt;
    int iterations;
  };
  using enum Sweep;
  const Case cases[] = {{gauss_seidel, 0.016, 100}, {gauss_seidel, 0.004, 10},
                        {gauss_seidel, 0.001, 2},   {gauss_seidel, 0.001, 10},
                        {gauss_seidel, 0.00025, 2}, {jacobi, 0.016, 100},
                        {jacobi, 0.004, 10},        {jacobi, 0.001, 10}};
  for (const auto& [sweep, dt, iterations] : cases) {
    const std::string what = std::string("compliant, ") + (sweep == jacobi ? "jacobi, " : "") +
                             std::to_string(dt) + " s, " + std::to_string(iterations) + " sweeps";
    EXPECT_LT(error_of(what, truth(), elongation(column(Method::compliant, sweep, dt, iterations))),
              1e-4);
  }
}

// A single Gauss–Seidel sweep that starts from nothing leaves the springs of its first colour long
// by what their neighbours, solved after them, pull their ends apart: dt²/m times the force of
// these. Summed over the springs 0, 2, 4 … this is an elongation of second order in the substep.
TEST(HangingColumn, OfASingleSweepIsLongerByTheSweepsOwnError) {
  double forces = 0;  // of the neighbours, in particle weights
  for (int s = 0; s < kSprings; s += 2) {
    if (s > 0) forces += kSprings - (s - 1);
    if (s + 1 < kSprings) forces += kSprings - (s + 1);
  }
  for (const double dt : {0.004, 0.001, 0.00025}) {
    const double result = elongation(column(Method::compliant, Sweep::gauss_seidel, dt, 1));
    error_of("one sweep, " + std::to_string(dt) + " s", truth(), result);
    EXPECT_LT(
        error_of("  with the sweep's own error", truth() + forces * kGravity * dt * dt, result),
        1e-4);
  }
}

}  // namespace
}  // namespace weft
