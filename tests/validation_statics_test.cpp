// Columns at rest against closed forms.
#include <string>

#include "sheets.h"
#include "truth.h"

namespace weft {
namespace {

const char* const kLaw = "hanging column of 10 springs, elongation";
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

std::string milliseconds(double dt) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g ms", 1e3 * dt);
  return text;
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
    expect({kLaw, "spring, " + milliseconds(dt), truth(), 1e-4, "m"},
           elongation(column(Method::spring, Sweep::gauss_seidel, dt, 1)));
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
    const std::string what = std::string("compliant, ") + (sweep == jacobi ? "Jacobi, " : "") +
                             milliseconds(dt) + ", " + std::to_string(iterations) + " sweeps";
    expect({kLaw, what, truth(), 1e-4, "m"},
           elongation(column(Method::compliant, sweep, dt, iterations)));
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
    const std::string what = "compliant, " + milliseconds(dt) + ", 1 sweep";
    show({kLaw, what, truth(), 1e-4, "m"}, result);
    expect({kLaw, what + ", the sweep's own error known", truth() + forces * kGravity * dt * dt,
            1e-4, "m"},
           result);
  }
}

}  // namespace
}  // namespace weft
