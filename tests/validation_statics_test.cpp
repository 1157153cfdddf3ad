// Columns at rest against closed forms: truth, result and error are printed.
#include <gtest/gtest.h>

#include "sheets.h"

namespace weft {
namespace {

constexpr int kSprings = 10;
constexpr double kMass = 0.01, kStiffness = 100, kLength = 0.05, kGravity = 9.81;

// Elongation of the column after it has come to rest.
double elongation(const Scene& scene) {
  Simulation simulation(scene);
  advance(simulation, 6);
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  return -position(simulation, 0, kSprings)[1] - kSprings * kLength;
}

double truth() {
  return kMass * kGravity * kSprings * (kSprings + 1) / (2 * kStiffness);
}

double report(const char* what, double result) {
  const double error = result / truth() - 1;
  std::printf("%-44s truth %.6f m  result %.6f m  error %+.1e\n", what, truth(), result, error);
  return std::abs(error);
}

Scene column(Method method, double dt, int iterations, Sweep sweep) {
  Scene scene = hanging_column(kSprings, kMass, kStiffness, kLength);
  scene.cloths[0].drag = 10;
  scene.solver.method = method;
  scene.solver.iterations = iterations;
  scene.solver.sweep = sweep;
  scene.time = {0.016, int(std::lround(0.016 / dt)), 10};
  return scene;
}

TEST(HangingColumn, OfSpringsIsAsLongAsItsWeightMakesIt) {
  for (const double dt : {0.004, 0.001, 0.00025}) {
    const std::string what = "spring, substep " + std::to_string(dt);
    EXPECT_LT(report(what.c_str(), elongation(column(Method::spring, dt, 1, Sweep::gauss_seidel))),
              1e-4);
  }
}

TEST(HangingColumn, CompliantTable) {
  for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::jacobi})
    for (const double dt : {0.016, 0.004, 0.001, 0.00025})
      for (const int iterations : {1, 2, 10, 100}) {
        const std::string what = "compliant, substep " + std::to_string(dt) + ", " +
                                 std::to_string(iterations) + " sweeps" +
                                 (sweep == Sweep::jacobi ? " J" : "");
        report(what.c_str(), elongation(column(Method::compliant, dt, iterations, sweep)));
      }
}

}  // namespace
}  // namespace weft
