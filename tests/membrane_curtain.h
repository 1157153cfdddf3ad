// A curtain of membrane, by sweeps and by forces, for the tests of its sweeps.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "weft/simulation.h"

namespace weft {

inline constexpr Membrane kWoven{3000, 2000, 200, 80, 0}, kIsotropic{1500, 1500, 500, 500, 0};

// Held along its first column, which swings it round and down, with a load across.
inline Scene curtain(int n, const Membrane& membrane) {
  Scene scene;
  scene.time.frame = 1.0 / 60;
  scene.gravity = {2, -9, 3};
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {n, n, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.membrane = membrane;
  cloth.bending = 2e-4;
  cloth.drag = 1;
  for (int j = 0; j < n; ++j) cloth.pins.push_back({0, j, {}});
  return scene;
}

inline Scene by_sweeps(Scene scene, Sweep sweep, int order, int substeps) {
  scene.solver.method = Method::compliant;
  scene.solver.sweep = sweep;
  scene.solver.order = order;
  scene.time.substeps = substeps;
  return scene;
}
inline Scene by_lines(Scene scene, int order, int substeps) {
  return by_sweeps(std::move(scene), Sweep::line, order, substeps);
}
inline Scene by_forces(Scene scene) {
  scene.solver.method = Method::spring;
  scene.time.substeps = 900;
  return scene;
}

inline std::vector<double> after(const Scene& scene, int frames) {
  Simulation simulation(scene);
  for (int frame = 0; frame < frames; ++frame) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  EXPECT_FALSE(simulation.plan().fallback);
  return simulation.positions();
}

// Root mean square [m].
inline double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(sum / (double(a.size()) / 3));
}

}  // namespace weft
