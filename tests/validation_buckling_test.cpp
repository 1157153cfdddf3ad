// A strip clamped on edge at one end gives way sideways under its own weight: lateral buckling.
//
// Its critical weight q a length has q L³/√(EI GJ) = 12.85, with EI = D w, GJ = 2 D w without lateral contraction.
// A small load sideways bends it by δ; δ grows without bound as the weight gets critical, and 1/δ is a smooth
// function of the weight's square (its sign does not matter), whose zero is looked for.
#include <cmath>
#include <string>

#include "truth.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr double kRigidity = 0.05, kDensity = 0.3;  // N·m, kg/m²; the strip is 1 m long

// What the end moves sideways, by `sideways` m/s² of gravity across the strip.
double bent(double width, double gravity, double sideways) {
  constexpr int nx = 65, ny = 5;
  const double h = 1 / (nx - 1.5);
  Scene scene;
  scene.gravity = {0, -gravity, sideways};
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {nx, ny, {-h / 2, 0, 0}, {h * (nx - 1), 0, 0}, {0, width, 0}, 0};
  // In its plane it is 400 times as stiff as across it.
  const double stiffness = 400 * 12 * kRigidity / (width * width);
  cloth.membrane = {stiffness, stiffness, 0, stiffness / 2, 0};
  cloth.bending = kRigidity;
  cloth.density = kDensity;
  cloth.drag = 1;  // about critical for the slowest motion
  for (int j = 0; j < ny; ++j)
    for (const int i : {0, 1}) cloth.pins.push_back({i, j, {}});
  Simulation simulation(scene, {.threads = 1});
  for (int frame = 0; frame < 15 * 60; ++frame) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok);
  return simulation.positions()[3 * std::size_t(2 * nx + nx - 1) + 2];
}

// The critical q L³/√(EI GJ) of a strip so wide.
double critical(double width) {
  // Weights near the closed form's, and the parabola through the three.
  const double expected = 12.85 * std::sqrt(2.0) * kRigidity / kDensity;
  const double sideways = 1e-3 * expected;
  double x[3], y[3];
  for (int n = 0; n < 3; ++n) {
    const double share = 0.75 + 0.08 * n;
    x[n] = share * share;
    y[n] = sideways / bent(width, share * expected, sideways);
  }
  const double first = (y[1] - y[0]) / (x[1] - x[0]), second = (y[2] - y[1]) / (x[2] - x[1]);
  const double curved = (second - first) / (x[2] - x[0]);
  double zero = 1;
  for (int n = 0; n < 20; ++n) {  // Newton's steps
    const double value = y[2] + (zero - x[2]) * (second + curved * (zero - x[1]));
    const double slope = second + curved * (2 * zero - x[1] - x[2]);
    zero -= value / slope;
  }
  return 12.85 * std::sqrt(zero);
}

TEST(LateralBuckling, OfAStripOnEdgeComesAtTheClosedFormsWeight) {
  const double wide = critical(0.1), narrow = critical(0.05);
  const double none = 2 * narrow - wide;
  expect({"lateral buckling of a strip on edge", "q L³/√(EI GJ), width to 0", 12.85, 0.03, ""},
         none);
  EXPECT_LT(narrow, wide);
}

}  // namespace
}  // namespace weft
