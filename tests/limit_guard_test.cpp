// Strain limits hold in every frame of automatic substeps, whatever presses on a cloth: where they would not, the frame
// runs again with more substeps.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "weft/simulation.h"

namespace weft {
namespace {

struct Stuff {
  double density, stiffness, limit;
};

// Sheets held by two corners each fall on a ball, and on one another.
Scene sheets_on_a_ball(const Stuff& stuff, SelfCollisionMode mode, Method method) {
  constexpr int kPoints = 21, kSheets = 3;
  Scene scene;
  const double thickness = mode == SelfCollisionMode::surface ? 0.01 : 0.02;
  for (int k = 0; k < kSheets; ++k) {
    Cloth c;
    c.grid = {kPoints, kPoints, {-0.5, 0.02 * k, -0.5}, {1, 0, 0}, {0, 0, 1}, 0};
    c.density = stuff.density;
    c.stiffness = {stuff.stiffness, stuff.stiffness / 2, 0};
    c.bending = 1e-4;
    c.strain_limit = stuff.limit;
    c.self_collision.mode = mode;
    c.self_collision.thickness = thickness;
    c.self_collision.friction = 0.3;
    c.pins = {{0, 0, {}}, {kPoints - 1, 0, {}}};
    scene.cloths.push_back(c);
  }
  Collider ball;
  ball.shape = Sphere{{0, -0.27, 0}, 0.25};
  ball.friction = {FrictionModel::coulomb, 0.3, 0.3};
  ball.offset = thickness / 2;
  scene.colliders.push_back(ball);
  scene.solver.method = method;
  if (method == Method::compliant) {
    scene.solver.sweep = Sweep::line;
    scene.solver.tethers = true;
  }
  return scene;
}

struct Strains {
  double greatest = 0;
  int fewest = 1 << 30, most = 0;  // substeps
};

Strains run(const Scene& scene, int frames) {
  Simulation simulation(scene);
  Strains s;
  s.fewest = simulation.substeps();
  for (int frame = 0; frame < frames; ++frame) {
    simulation.advance_frame();
    s.greatest = std::max(s.greatest, simulation.report().strain.max);
    s.fewest = std::min(s.fewest, simulation.substeps());
    s.most = std::max(s.most, simulation.substeps());
  }
  return s;
}

class LimitGuard : public testing::TestWithParam<std::tuple<SelfCollisionMode, Method>> {};

TEST_P(LimitGuard, LimitsHoldWhateverPresses) {
  const auto [mode, method] = GetParam();
  for (const Stuff& stuff : {Stuff{1, 1000, 0.05}, Stuff{3, 500, 0.02}, Stuff{0.3, 500, 0.01}}) {
    Scene scene = sheets_on_a_ball(stuff, mode, method);
    const Strains automatic = run(scene, 30);
    EXPECT_LT(automatic.greatest, 1.25 * stuff.limit) << stuff.density;
    EXPECT_GT(automatic.most, automatic.fewest) << stuff.density;
    scene.time.substeps = automatic.fewest;
    const Strains fixed = run(scene, 30);
    EXPECT_LT(automatic.greatest, fixed.greatest) << stuff.density;
    EXPECT_EQ(fixed.most, fixed.fewest) << "fixed substeps stay what they are";
  }
}

INSTANTIATE_TEST_SUITE_P(, LimitGuard,
                         testing::Combine(testing::Values(SelfCollisionMode::surface,
                                                          SelfCollisionMode::particles),
                                          testing::Values(Method::spring, Method::compliant)));

// No substep holds a limit against pins that leave no room for it: substeps stay what they are, but for a few tries.
TEST(LimitGuardAlone, WhatPinsDrawApartIsLetBe) {
  Scene scene;
  Cloth c;
  c.grid = {9, 9, {0, 0, 0}, {0.4, 0, 0}, {0, 0, 0.4}, 0};
  c.strain_limit = 0.05;
  c.pins = {{0, 4, {}}, {8, 4, {{0, {0.4, 0, 0.2}}, {0.5, {0.8, 0, 0.2}}}}};
  scene.cloths = {c};
  Simulation simulation(scene);
  const int due = simulation.substeps();
  int finer = 0;
  for (int frame = 0; frame < 120; ++frame) {
    simulation.advance_frame();
    finer += simulation.substeps() > 2 * due;
  }
  EXPECT_GT(simulation.report().strain.max, 0.5);
  EXPECT_LT(finer, 30);
}

}  // namespace
}  // namespace weft
