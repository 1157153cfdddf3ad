// The membrane of meshes by method compliant: what cloth may have besides, damping, starts from anywhere, and what is
// told.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "machines.h"
#include "mesh_strain_scenes.h"

namespace weft {
namespace {

TEST(MeshStrains, HaveOneResult) {
  const std::function<void(Scene&)> variants[] = {
      [](Scene&) {},
      [](Scene& s) { s.solver.order = 2, s.solver.tethers = true; },
      [](Scene& s) { s.solver.iterations = 3, s.cloths[0].membrane = kDamped; },
      [](Scene& s) { s.cloths[0].bending = 1e-4, s.cloths[0].strain_limit = 0.02; },
      [](Scene& s) {
        s.colliders.push_back({Sphere{{0.5, -0.26, 0.5}, 0.25}, {}, 0.01, {}, false});
        s.wind = {{2, 1, 3}, 0.4, 0.2, 0.5};
      },
      [](Scene& s) {
        s.cloths[0].self_collision = {SelfCollisionMode::surface, 0.01};
      },
      [](Scene& s) {
        s.cloths[0].self_collision = {SelfCollisionMode::particles, 0.02};
      },
      [](Scene& s) {
        s.solver.sleep = 0.05, s.cloths[0].seams = {{10, 330}, {30, 350}};
      },
      [](Scene& s) { s.solver.sweep = Sweep::line; },
      [](Scene& s) {
        s.solver.sweep = Sweep::line, s.solver.order = 2, s.solver.iterations = 2;
        s.cloths[0].membrane = kDamped, s.cloths[0].bending = 1e-4, s.time.substeps = 40;
      },
  };
  const auto mesh = made_up({.nx = 23, .ny = 19, .shift = 0.3, .shuffled = true});
  for (const auto& change : variants) {
    Scene scene = projected(mesh, kCanvas, 1, 8);
    scene.cloths[0].pins = {{3, 0, {{0, mesh->vertices[3]}, {0.1, {0, 0.1, 0}}}}, {300, 0, {}}};
    change(scene);
    std::uint64_t hash = 0;
    for (const Options& machine : machines()) {
      Simulation run(scene, machine);
      for (int n = 0; n < 5; ++n) run.advance_frame();
      ASSERT_TRUE(run.status().ok) << run.status().text;
      if (hash == 0) hash = run.hash();
      EXPECT_EQ(run.hash(), hash) << int(machine.simd) << " " << machine.threads;
    }
  }
}

// A strip that swings along itself: the same motion is left as with forces.
TEST(MeshStrains, AreDampedAsForcesAre) {
  const auto swung = [](const Scene& scene) {
    Simulation run(scene, {.threads = 1});
    double most = 0;
    for (int n = 0; n < 60; ++n) {
      run.advance_frame();
      if (n >= 40) most = std::max(most, run.report(false).energy.kinetic);
    }
    return most;
  };
  const auto mesh = made_up({.nx = 5, .ny = 21, .width = 0.2, .height = 1, .shift = 0.2});
  for (const auto& [order, sweep] :
       {std::pair(1, Sweep::gauss_seidel), {2, Sweep::gauss_seidel}, {2, Sweep::line}}) {
    Scene scene = projected(mesh, {100, 100, 0, 40, 4e-3}, order, 400);
    scene.solver.sweep = sweep;
    scene.gravity = {0, 0, 9.81};
    for (int n = 0; n < 5; ++n) scene.cloths[0].pins.push_back({n, 0, {}});
    const double damped = swung(scene), by_force = swung(by_forces(scene));
    scene.cloths[0].membrane.damping = 0;
    EXPECT_NEAR(damped, by_force, 0.1 * by_force) << order;
    EXPECT_GT(swung(scene), 1.5 * damped) << order;
  }
}

// Turning is no strain: with damping as without.
TEST(MeshStrains, DampNoTurning) {
  const auto mesh = made_up({.nx = 11, .ny = 11, .shift = 0.3});
  double kinetic[2];
  for (const bool damped : {false, true}) {
    Scene scene = projected(mesh, kCanvas, 2, 64);
    scene.cloths[0].membrane.damping = damped ? 0.05 : 0;
    scene.gravity = {};
    scene.cloths[0].spin = {0, 6, 0};
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 60; ++n) run.advance_frame();
    kinetic[damped] = run.report(false).energy.kinetic;
  }
  EXPECT_NEAR(kinetic[1], kinetic[0], 5e-3 * kinetic[0]);
}

// Pressed to a third, turned over, laid onto a line, or thrown together: a first sweep may go too far, most of all
// from a line, but nothing flies apart.
TEST(MeshStrains, UnfoldFromAnywhere) {
  const auto mesh = made_up({.nx = 12, .ny = 10, .shift = 0.3});
  const std::function<Vec3(const Vec3&)> starts[] = {
      [](const Vec3& p) {
        return Vec3{p[0] / 3, 0, p[2] / 3};
      },
      [](const Vec3& p) {
        return Vec3{1e-3 * p[0], 0, 1e-3 * p[2]};
      },
      [](const Vec3& p) {
        return Vec3{-p[0], 0, p[2]};
      },
      [](const Vec3& p) {
        return Vec3{p[0] + p[2], 0, 1e-4 * p[2]};
      },
      [](const Vec3& p) {
        return Vec3{0.3 * std::sin(40 * p[0] + 7 * p[2]), 0.3 * std::cos(31 * p[0]),
                    0.3 * std::sin(50 * p[2])};
      },
  };
  for (const Membrane& membrane : {kCanvas, kIsotropic, Membrane{1e7, 1e7, 0, 1e6, 0}})
    for (const auto& start : starts)
      for (const int substeps : {1, 8}) {
        Scene scene = projected(mesh, membrane, 1, substeps);
        scene.gravity = {};
        Simulation run(scene, {.threads = 1});
        std::vector<Vec3> x;
        for (const Vec3& p : mesh->vertices) x.push_back(start(p));
        run.set_state(flat(x), std::vector<double>(3 * x.size()));
        const double before = run.report(false).energy.total;
        double most = 0;
        for (int n = 0; n < 40; ++n) {
          run.advance_frame();
          most = std::max(most, run.report(false).energy.total);
        }
        EXPECT_LT(most, (substeps == 1 ? 20 : 2.5) * before + 1e-6);
        EXPECT_LT(run.report(false).energy.total, 2 * before + 1e-6);
        EXPECT_FALSE(run.plan().fallback);
        EXPECT_LT(run.report(false).momentum[0], 1e-3);
      }
}

TEST(MeshStrains, KeepToAStrainLimitAndTethers) {
  double strain[3];
  for (const int kind : {0, 1, 2}) {
    Scene scene = projected(made_up({.nx = 21, .ny = 21, .shift = 0.3}), {20, 20, 0, 8, 0}, 1, 16);
    scene.cloths[0].drag = 1;
    scene.cloths[0].strain_limit = kind == 1 ? 0.05 : 0;
    scene.solver.tethers = kind == 2;
    for (int n = 0; n < 21; ++n) scene.cloths[0].pins.push_back({n, 0, {}});
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 60; ++n) run.advance_frame();
    ASSERT_TRUE(run.status().ok);
    const auto x = positions_of(run);
    double lowest = 0;
    for (const Vec3& p : x) lowest = std::min(lowest, p[1]);
    strain[kind] = kind == 2 ? -lowest - 1 : run.report().strain.max;
  }
  EXPECT_GT(strain[0], 0.1);
  EXPECT_LT(strain[1], 0.07);
  EXPECT_LT(strain[2], 0.02);
}

TEST(MeshStrains, FallAsleepAndLieOnABody) {
  Scene scene =
      projected(made_up({.nx = 21, .ny = 21, .shift = 0.3}), {300, 300, 50, 80, 1e-3}, 1, 16);
  scene.solver.sleep = 0.05;
  scene.cloths[0].drag = 4;
  scene.colliders.push_back({Plane{{0, -0.05, 0}, {0, 1, 0}}, {}, 0.01, {}, false});
  scene.colliders[0].friction.dynamic = scene.colliders[0].friction.statik = 0.5;
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 240; ++n) run.advance_frame();
  EXPECT_EQ(run.report().asleep, 21 * 21);
  for (const Vec3& p : positions_of(run)) EXPECT_NEAR(p[1], -0.04, 1e-4);
}

// The method that runs in the place of forces whose substeps are too long, and a note of what sweeps leave.
TEST(MeshStrains, TakeThePlaceOfForces) {
  Scene scene = curtain(17, kCanvas, 1, 4);
  scene.solver.method = Method::spring;
  Simulation run(scene, {.threads = 1});
  EXPECT_TRUE(run.plan().fallback);
  Scene compliant = scene;
  compliant.solver.method = Method::compliant;
  Simulation same(compliant, {.threads = 1});
  for (int n = 0; n < 20; ++n) run.advance_frame(), same.advance_frame();
  EXPECT_EQ(run.hash(), same.hash());
}

TEST(MeshStrains, TellOfStrainThatNothingPutIn) {
  for (const auto mode :
       {SelfCollisionMode::off, SelfCollisionMode::particles, SelfCollisionMode::surface})
    for (const auto& [stiff, substeps] : {std::pair(1e6, 2), {100.0, 64}}) {
      Scene scene = curtain(25, {stiff, stiff, 0, stiff / 10, 0}, 1, substeps);
      scene.cloths[0].self_collision.mode = mode;
      scene.cloths[0].self_collision.thickness = 0.002;
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 40; ++n) run.advance_frame();
      bool told = false;
      for (const std::string& note : run.plan().notes)
        told |= note.find("leave strain") != std::string::npos;
      EXPECT_EQ(told, substeps == 2) << int(mode);
    }
}

}  // namespace
}  // namespace weft
