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

// The name of a method in rows of the accuracy page.
inline const char* name_of(Method method) {
  switch (method) {
    case Method::positional:
      return "positional";
    case Method::spring:
      return "spring";
    case Method::spring_friction:
      return "spring and friction";
    case Method::compliant:
      return "compliant";
  }
  return "";
}

// Loose particles on the ground under gravity that is tilted by `degrees`.
inline Scene incline(double degrees, double statik, double dynamic, Method method) {
  Scene scene;
  const double a = degrees * M_PI / 180;
  scene.gravity = {9.81 * std::sin(a), -9.81 * std::cos(a), 0};
  scene.time.substeps = 20;
  scene.solver.method = method;
  scene.cloths.push_back(loose_particles({0, 0, 0}));
  scene.colliders.push_back(collider_of(Plane{}));
  scene.colliders[0].friction = {FrictionModel::coulomb, statik, dynamic};
  return scene;
}

}  // namespace weft
