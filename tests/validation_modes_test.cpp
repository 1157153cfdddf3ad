// Frequencies of small oscillations against closed forms: a hanging chain, a square membrane.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sheets.h"
#include "truth.h"

namespace weft {
namespace {

constexpr double kPi = std::numbers::pi;

// Frequency [Hz] of one mode: the state's projection on `shape` (one weight a particle, for
// displacements along `axis`) is followed through `swings` whole oscillations.
double frequency(Simulation& simulation, const std::vector<double>& shape, std::size_t axis,
                 int swings) {
  const std::vector<double> rest = simulation.positions();
  const auto amplitude = [&] {
    const std::vector<double> x = simulation.positions();
    double sum = 0;
    for (std::size_t p = 0; p < shape.size(); ++p)
      sum += shape[p] * (x[3 * p + axis] - rest[3 * p + axis]);
    return sum;
  };
  std::vector<double> x = rest;
  for (std::size_t p = 0; p < shape.size(); ++p) x[3 * p + axis] += shape[p];
  simulation.set_state(x, std::vector<double>(x.size(), 0.0));
  double before = amplitude(), first = 0;
  for (int crossings = 0;;) {
    simulation.advance_frame();
    const double now = amplitude();
    if (before > 0 && now <= 0) {
      const double at = simulation.time() - simulation.scene().time.frame * now / (now - before);
      if (crossings == 0) first = at;
      if (crossings++ == swings) return swings / (at - first);
    }
    before = now;
  }
}

// A chain of n links, two side by side, whose mass ends with its length: the last particle of each
// weighs half. It hangs as long as its weight makes it, 1 m by a ten-thousandth.
Scene hanging_chain(int n) {
  Scene scene = hanging_column(n, 1.0 / n, 1e4 * 9.81 * n, 1.0 / n);
  Cloth& cloth = scene.cloths[0];
  for (int p = 0; p < 2 * (n + 1); ++p) cloth.masses.push_back(p / 2 == n ? 0.5 / n : 1.0 / n);
  scene.time = {1e-3, kAutoSubsteps, 100};
  return scene;
}

void lengthen_by_weight(Simulation& simulation, int n) {
  std::vector<double> x = simulation.positions();
  const double k = simulation.scene().cloths[0].stiffness.structural;
  double y = 0;
  for (int j = 1; j <= n; ++j) {
    y -= 1.0 / n + 9.81 * (n - j + 0.5) / n / k;
    x[6 * std::size_t(j) + 1] = x[6 * std::size_t(j) + 4] = y;
  }
  simulation.set_state(x, std::vector<double>(x.size(), 0.0));
}

TEST(Modes, OfAHangingChain) {
  constexpr int kLinks = 100;
  // Zeros of the Bessel function J0; f √(L/g) = zero/(4π).
  const double zeros[] = {2.404825558, 5.520078110, 8.653727913};
  for (int mode = 0; mode < 3; ++mode) {
    Simulation simulation(hanging_chain(kLinks));
    lengthen_by_weight(simulation, kLinks);
    std::vector<double> shape;
    for (int j = 0; j <= kLinks; ++j)
      for (int i = 0; i < 2; ++i)
        shape.push_back(1e-3 *
                        std::cyl_bessel_j(0.0, zeros[mode] * std::sqrt(1 - double(j) / kLinks)));
    shape[0] = shape[1] = 0;
    const double f = frequency(simulation, shape, 2, 1 + mode) * std::sqrt(1 / 9.81);
    expect({"hanging chain, small oscillations", "mode " + std::to_string(mode + 1) + ", 100 links",
            zeros[mode] / (4 * kPi), 0.01, "f √(L/g)"},
           f);
  }
}

// A square of n cells a side, stretched by half in both directions and held along its border.
TEST(Modes, OfASquareMembrane) {
  constexpr int n = 40;
  constexpr double kStretch = 1.5, kStiffness = 100, kMass = 1e-3;
  const double h = kStretch / n, tension = kStiffness * (kStretch - 1) / n / h;
  const std::pair<int, int> modes[] = {{1, 1}, {2, 1}, {2, 2}, {3, 1}};
  for (const auto& [p, q] : modes) {
    Scene scene;
    scene.gravity = {0, 0, 0};
    scene.cloths.emplace_back();
    Cloth& cloth = scene.cloths[0];
    cloth.grid.nx = cloth.grid.ny = n + 1;
    cloth.particle_mass = kMass;
    cloth.stiffness = {kStiffness, 0, 0};
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        if (i % n == 0 || j % n == 0) cloth.pins.push_back({i, j, {}});
    scene.time = {1e-3, kAutoSubsteps, 100};
    Simulation simulation(scene);
    std::vector<double> x = simulation.positions(), shape;
    for (double& c : x) c *= kStretch;
    simulation.set_state(x, std::vector<double>(x.size(), 0.0));
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        shape.push_back(1e-3 * std::sin(p * kPi * i / n) * std::sin(q * kPi * j / n));
    const double f = frequency(simulation, shape, 1, 6);
    expect({"square membrane under tension",
            "mode " + std::to_string(p) + "," + std::to_string(q) + ", 40 × 40 cells",
            std::hypot(p, q) / 2, 0.01, "f a √(σ/T)"},
           f * kStretch * std::sqrt(kMass / (h * h) / tension));
  }
}

}  // namespace
}  // namespace weft
