// Meshes at the limits of what a substep carries: refused, stopped or told of, never wrong in silence.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh_scenes.h"
#include "weft/estimate.h"

namespace weft {
namespace {

Scene membrane(double warp) {
  Scene scene = scene_of(made_up({.nx = 9, .ny = 9, .shift = 0.4}));
  scene.cloths[0].membrane = {warp, warp, -0.3 * warp, 0.2 * warp, 0};
  return scene;
}

bool has_note(const Plan& plan, const std::string& words) {
  return std::any_of(plan.notes.begin(), plan.notes.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

TEST(MeshLimits, AMembraneThatNoSubstepIsShortEnoughForRunsByTheCompliantMethod) {
  Scene scene = membrane(1e9);
  scene.cloths[0].density = 1e-3;
  scene.cloths.push_back(membrane(1).cloths[0]);
  std::swap(scene.cloths[0], scene.cloths[1]);
  ASSERT_TRUE(validate(scene).empty());
  Simulation run(scene, {.threads = 1});
  EXPECT_EQ(estimate(scene).substeps, run.substeps());
  EXPECT_TRUE(run.plan().fallback);
  EXPECT_TRUE(has_note(run.plan(), "compliant"));
  for (int n = 0; n < 20; ++n) run.advance_frame();
  EXPECT_TRUE(run.status().ok) << run.status().text;
  EXPECT_LT(run.report(false).energy.kinetic, 100);
}

TEST(MeshLimits, AnEstimateNeedsNoBodiesThatPinsFollow) {
  Scene scene = membrane(100);
  scene.colliders.push_back({Sphere{{0, -3, 0}, 0.1}, {}, 0, {}, false});
  scene.cloths[0].pins = {{0, 0, {}}};
  scene.cloths[0].pins[0].follow = 0;
  EXPECT_EQ(estimate(scene).substeps, Simulation(scene).substeps());
}

TEST(MeshLimits, APinThatStartsFarAwayIsToldOf) {
  Scene scene = membrane(100);
  scene.cloths[0].pins = {{40, 0, {{0, {0, 2, 0}}}}};
  EXPECT_TRUE(has_note(Simulation(scene).plan(), "1 pin starts 2."));
  scene.cloths[0].pins[0].keys[0].position = placed_vertices(scene.cloths[0].mesh)[40];
  EXPECT_FALSE(has_note(Simulation(scene).plan(), "pin starts"));
  // One that turns starts where it is, or turned by its first angle.
  scene.cloths[0].pins[0] = {40, 0, {}};
  scene.cloths[0].pins[0].rotate = {{0, 0, 1}, {0, -2, 0}, {{0, 0}, {1, 90}}};
  EXPECT_FALSE(has_note(Simulation(scene).plan(), "pin starts"));
  scene.cloths[0].pins[0].rotate.keys[0].degrees = 180;
  EXPECT_TRUE(has_note(Simulation(scene).plan(), "1 pin starts"));
}

// Whatever becomes of a membrane that is torn away from its pins at the start, the last state is finite.
TEST(MeshLimits, WhatFliesApartStopsInItsLastGoodState) {
  int stopped = 0;
  for (const double far : {3.0, 100.0, 3000.0})
    for (const int substeps : {kAutoSubsteps, 41}) {
      Scene scene = membrane(3000);
      scene.time.substeps = substeps;
      scene.cloths[0].density = 0.02;
      scene.cloths[0].spin = {1, -10, -6};
      scene.cloths[0].pins = {{0, 0, {}}, {40, 0, {{0, {0, far, 0}}}}};
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 3 && run.status().ok; ++n) run.advance_frame();
      stopped += !run.status().ok;
      for (const double value : run.positions()) ASSERT_TRUE(std::isfinite(value)) << far;
      for (const double value : run.velocities()) ASSERT_TRUE(std::isfinite(value)) << far;
      EXPECT_TRUE(!run.status().ok || run.plan().fallback) << far;
    }
  EXPECT_GT(stopped, 0);
}

}  // namespace
}  // namespace weft
