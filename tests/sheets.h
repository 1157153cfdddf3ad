// Small scenes whose motion is known in closed form, and ways to look at them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "cases.h"
#include "weft/simulation.h"

namespace weft {

// Two columns and n+1 rows hanging from the first row: two equal chains of n springs. The springs
// between the columns stay at rest, so that each column is a chain of single springs.
inline Scene hanging_column(int n, double mass, double stiffness, double spring_length) {
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {2, n + 1, {0, 0, 0}, {spring_length, 0, 0}, {0, -n * spring_length, 0}, 0};
  cloth.particle_mass = mass;
  cloth.stiffness = {stiffness, 0, 0};
  cloth.pins = {{0, 0, {}}, {1, 0, {}}};
  return scene;
}

inline Vec3 position(const Simulation& simulation, int i, int j) {
  const ClothView c = simulation.view().cloths[0];
  const auto at = std::size_t(j) * std::size_t(c.stride) + std::size_t(i);
  return {c.x[at], c.y[at], c.z[at]};
}

// Seconds of ten swings of a mass on one spring, from crossing to crossing of its rest length.
inline double ten_periods(double dt) {
  Scene scene = hanging_column(1, 0.1, 10, 1);
  scene.gravity = {0, 0, 0};
  scene.time = {dt, 1, 100};
  Simulation simulation(scene);
  std::vector<double> x = simulation.positions();
  x[7] -= 0.1;
  x[10] -= 0.1;
  simulation.set_state(x, std::vector<double>(12, 0.0));
  double before = -0.1, first = 0;
  for (int crossings = 0;;) {
    simulation.advance_frame();
    const double now = position(simulation, 0, 1)[1] + 1;
    if (before < 0 && now >= 0) {
      const double at = simulation.time() - dt * now / (now - before);
      if (crossings == 0) first = at;
      if (crossings++ == 10) return at - first;
    }
    before = now;
  }
}

inline void advance(Simulation& simulation, double seconds) {
  const double frames = seconds / simulation.scene().time.frame;
  for (int frame = 0; frame < int(std::lround(frames)); ++frame) simulation.advance_frame();
}

// How a sheet folds hangs on the last bit of where it starts: of three starts (five in the long form), each jittered by
// a seed of its own, the middle one of each measure is told.
template <class... Measures>
std::array<double, sizeof...(Measures)> medians_of_starts(const Scene& scene, double seconds,
                                                          const Measures&... measures) {
  const std::size_t starts = whole_sweeps() ? 5 : 3;
  std::array<std::vector<double>, sizeof...(Measures)> measured;
  for (std::size_t i = 0; i < starts; ++i) {
    Options options;
    options.seed = i + 1;
    Simulation simulation(scene, options);
    advance(simulation, seconds);
    std::size_t n = 0;
    (measured[n++].push_back(measures(simulation)), ...);
  }
  std::array<double, sizeof...(Measures)> medians;
  for (std::size_t n = 0; n < medians.size(); ++n) {
    std::sort(measured[n].begin(), measured[n].end());
    medians[n] = measured[n][starts / 2];
  }
  return medians;
}

// The same velocity for every particle.
inline void set_velocity(Simulation& simulation, const Vec3& v) {
  const std::vector<double> x = simulation.positions();
  std::vector<double> all;
  while (all.size() < x.size()) all.insert(all.end(), v.begin(), v.end());
  simulation.set_state(x, all);
}

}  // namespace weft
