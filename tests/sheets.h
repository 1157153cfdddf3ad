// Small scenes whose motion is known in closed form, and ways to look at them.
#pragma once

#include <cmath>
#include <vector>

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

inline void advance(Simulation& simulation, double seconds) {
  const double frames = seconds / simulation.scene().time.frame;
  for (int frame = 0; frame < int(std::lround(frames)); ++frame) simulation.advance_frame();
}

// The same velocity for every particle.
inline void set_velocity(Simulation& simulation, const Vec3& v) {
  const std::vector<double> x = simulation.positions();
  std::vector<double> all;
  while (all.size() < x.size()) all.insert(all.end(), v.begin(), v.end());
  simulation.set_state(x, all);
}

}  // namespace weft
