// Small scenes for the tests of contact.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "weft/shape.h"
#include "weft/simulation.h"

namespace weft {

// A sheet of n x n particles, `side` m wide, lying flat with its middle at `middle`.
inline Cloth flat_sheet(int n, double side, Vec3 middle) {
  Cloth cloth;
  cloth.grid.nx = cloth.grid.ny = n;
  cloth.grid.origin = {middle[0] - side / 2, middle[1], middle[2] - side / 2};
  cloth.grid.u = {side, 0, 0};
  cloth.grid.v = {0, 0, side};
  return cloth;
}

// Four particles that nothing joins.
inline Cloth loose_particles(Vec3 middle) {
  Cloth cloth = flat_sheet(2, 0.02, middle);
  cloth.particle_mass = 0.01;
  cloth.stiffness = {0, 0, 0};
  return cloth;
}

inline Collider collider_of(Shape shape, double friction = 0) {
  Collider c;
  c.shape = std::move(shape);
  c.friction = {FrictionModel::coulomb, friction, friction};
  return c;
}

inline Vec3 at(const std::vector<double>& all, std::size_t p) {
  return {all[3 * p], all[3 * p + 1], all[3 * p + 2]};
}

inline void advance(Simulation& simulation, double seconds) {
  while (simulation.time() < seconds - 1e-9) {
    simulation.advance_frame();
    ASSERT_TRUE(simulation.status().ok) << simulation.status().text;
  }
}

}  // namespace weft
