// Sleeping row-blocks: what rests is left alone, what touches it wakes it, and nobody else notices.
#include <algorithm>
#include <cstdio>

#include "contact_scenes.h"
#include "machines.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

constexpr int kRows = 60, kColumns = 40;

// A sheet that lies on rough ground.
Scene lying(Method method, Sweep sweep = Sweep::gauss_seidel) {
  Scene scene;
  scene.solver.method = method;
  scene.solver.sweep = sweep;
  scene.solver.sleep = 0.01;
  if (method != Method::spring) scene.time.substeps = 12;
  Cloth c = flat_sheet(kColumns, 1, {0, 0.002, 0});
  c.grid.ny = kRows;
  c.drag = 2;
  scene.cloths.push_back(c);
  scene.colliders.push_back(collider_of(Plane{}, 0.5));
  return scene;
}

std::int64_t asleep(const Simulation& simulation) {
  return simulation.report().asleep;
}

struct Way {
  Method method;
  Sweep sweep;
};
constexpr Way kWays[] = {{Method::spring, Sweep::gauss_seidel},
                         {Method::positional, Sweep::gauss_seidel},
                         {Method::compliant, Sweep::gauss_seidel},
                         {Method::compliant, Sweep::jacobi},
                         {Method::compliant, Sweep::line}};

TEST(Rest, ASheetOnTheGroundFallsAsleepAndStaysWhereItIs) {
  for (const Way& way : kWays) {
    Simulation simulation(lying(way.method, way.sweep));
    advance(simulation, 0.3);
    EXPECT_EQ(asleep(simulation), 0);
    advance(simulation, 2);
    EXPECT_EQ(asleep(simulation), kRows * kColumns);
    const std::uint64_t hash = simulation.hash();
    advance(simulation, 3);
    EXPECT_EQ(simulation.hash(), hash);
    const Report r = simulation.report();
    EXPECT_EQ(r.energy.kinetic, 0);
    EXPECT_NEAR(r.energy.gravity, 0, 1e-3);
    EXPECT_TRUE(std::any_of(r.skipped.begin(), r.skipped.end(),
                            [](const SkippedStage& s) { return s.name == "sleep"; }));
    for (const float w : simulation.view().cloths[0].inverse_mass.first(kColumns))
      EXPECT_GT(w, 0);  // it sleeps, it is not pinned
  }
}

TEST(Rest, NothingSleepsUnlessTheSceneAsks) {
  Scene scene = lying(Method::spring);
  scene.solver.sleep = 0;
  Simulation simulation(scene);
  advance(simulation, 2);
  EXPECT_EQ(asleep(simulation), 0);
}

TEST(Rest, MotionIsTheSameBitsWhileNothingSleeps) {
  for (const Way& way : kWays) {
    Scene scene = lying(way.method, way.sweep);
    scene.colliders.clear();
    scene.cloths[0].drag = 0;
    scene.cloths[0].pins = {{0, 0, {}}, {kColumns - 1, 0, {}}};
    Scene restless = scene;
    restless.solver.sleep = 0;
    Simulation a(scene), b(restless);
    advance(a, 1.5);
    advance(b, 1.5);
    EXPECT_EQ(a.hash(), b.hash());
    EXPECT_EQ(asleep(a), 0);
  }
}

// Two pins carry one end of the sheet about: the blocks near it work, those far away sleep.
TEST(Rest, BlocksSleepApart) {
  for (const Way& way : kWays) {
    if (way.sweep == Sweep::line) continue;  // whose lines cross all rows
    Scene scene = lying(way.method, way.sweep);
    scene.cloths[0].drag = 8;
    scene.solver.sleep = 0.05;
    for (const int i : {0, kColumns - 1}) {
      const double x = double(i) / (kColumns - 1) - 0.5;
      std::vector<Key> keys;
      for (int n = 0; n < 40; ++n) keys.push_back({0.1 * n, {x, n % 2 ? 0.06 : 0.03, -0.5}});
      scene.cloths[0].pins.push_back({i, 0, keys});
    }
    Simulation simulation(scene);
    advance(simulation, 3);
    std::printf("method %d, sweep %d: %lld of %d asleep\n", int(way.method), int(way.sweep),
                (long long)asleep(simulation), kRows * kColumns);
    EXPECT_GT(asleep(simulation), 0);
    EXPECT_LT(asleep(simulation), kRows * kColumns);
    const std::vector<double> before = simulation.positions();
    simulation.advance_frame();
    const std::vector<double> after = simulation.positions();
    EXPECT_NE(at(before, 1), at(after, 1));
    EXPECT_EQ(at(before, (kRows - 1) * kColumns), at(after, (kRows - 1) * kColumns));
    advance(simulation, 8);  // the pins are still
    EXPECT_EQ(asleep(simulation), kRows * kColumns);
  }
}

TEST(Rest, WhatTouchesItWakesIt) {
  for (const Way& way : {kWays[0], kWays[1], kWays[4]}) {
    Scene scene = lying(way.method, way.sweep);
    scene.colliders.push_back(collider_of(Sphere{{0, 0.5, 0}, 0.1}, 0.3));
    scene.colliders[1].keys = {{2.5, {0, 0.5, 0}}, {3, {0, 0.05, 0}}, {3.5, {0.3, 0.08, 0}}};
    Simulation simulation(scene);
    advance(simulation, 2.4);
    EXPECT_EQ(asleep(simulation), kRows * kColumns);
    const Vec3 lay = at(simulation.positions(), std::size_t(kRows / 2 * kColumns + kColumns / 2));
    double deepest = 0;
    bool woke = false;
    while (simulation.time() < 3.6) {
      simulation.advance_frame();
      woke |= asleep(simulation) == 0;
      deepest = std::max(deepest, simulation.report().penetration.collider_max);
    }
    EXPECT_TRUE(woke);
    EXPECT_NE(at(simulation.positions(), std::size_t(kRows / 2 * kColumns + kColumns / 2)), lay);
  }
}

TEST(Rest, HandsWakeIt) {
  const auto sleeping = [] {
    Simulation simulation(lying(Method::spring));
    advance(simulation, 2);
    EXPECT_EQ(asleep(simulation), kRows * kColumns);
    return simulation;
  };
  Simulation grabbed = sleeping();
  grabbed.grab(0, 5 * kColumns + 5, {0, 0.5, 0}, 50);
  advance(grabbed, 2.5);
  EXPECT_GT(at(grabbed.positions(), 5 * kColumns + 5)[1], 0.1);
  grabbed.release();
  advance(grabbed, 12);
  EXPECT_EQ(asleep(grabbed), kRows * kColumns);

  Simulation pinned = sleeping();
  pinned.pin(0, 3 * kColumns + 3);
  EXPECT_EQ(asleep(pinned), 0);
  advance(pinned, 4);
  EXPECT_EQ(asleep(pinned), kRows * kColumns);
  pinned.unpin(0, 3 * kColumns + 3);
  EXPECT_GT(
      pinned.view().cloths[0].inverse_mass[std::size_t(3 * pinned.view().cloths[0].stride + 3)], 0);

  Simulation cut = sleeping();
  EXPECT_GT(cut.cut({-1, 0, 0}, {1, 0, 0}, 0.02), 0);
  EXPECT_EQ(asleep(cut), 0);

  Simulation moved = sleeping();
  std::vector<double> x = moved.positions(), v(x.size());
  for (std::size_t k = 1; k < x.size(); k += 3) x[k] += 0.5;
  moved.set_state(x, v);
  moved.advance_frame();
  EXPECT_LT(moved.positions()[1], x[1]);
}

// A second sheet falls on one that sleeps.
TEST(Rest, AFallingSheetWakesTheOneBelow) {
  Scene scene = lying(Method::spring);
  scene.cloths.push_back(flat_sheet(20, 0.5, {0, 1.5, 0}));
  scene.cloths[1].drag = 2;
  for (Cloth& c : scene.cloths) {
    c.self_collision.mode = SelfCollisionMode::particles;
    c.self_collision.thickness = 0.02;
  }
  scene.cloths[1].drag = 6;  // falls slowly: the first is asleep before it arrives
  Simulation simulation(scene);
  bool slept = false, woken = false;
  while (simulation.time() < 4) {
    simulation.advance_frame();
    const double height = at(simulation.positions(), kRows * kColumns + 210)[1];
    slept |= height > 0.3 && asleep(simulation) >= kRows * kColumns;
    woken |= slept && height < 0.1 && asleep(simulation) < kRows * kColumns;
  }
  EXPECT_TRUE(slept);
  EXPECT_TRUE(woken);
  EXPECT_EQ(simulation.report().penetration.self_pairs, 0);
}

// Triangles over edges and corners hold still, too.
TEST(Rest, ASheetDrapedOverABoxFallsAsleepAltogether) {
  for (const int n : {30, 36, 40}) {
    Scene scene = read_scene("box_drape").scene;
    scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = n;
    scene.solver.sleep = 0.01;
    Simulation simulation(scene);
    advance(simulation, 10);
    EXPECT_EQ(asleep(simulation), n * n);
    EXPECT_LT(simulation.report().penetration.collider_max, 1e-5);
  }
}

TEST(Rest, SameBitsForAnyThreadsAndInstructionSet) {
  for (const Way& way : {kWays[0], kWays[2], kWays[3]}) {
    Scene scene = lying(way.method, way.sweep);
    Cloth& c = scene.cloths[0];
    c.grid.nx = c.grid.ny = 90;  // large enough to be shared out
    std::vector<Key> keys;
    for (int n = 0; n < 40; ++n) keys.push_back({0.1 * n, {-0.5, n % 2 ? 0.04 : 0.03, -0.5}});
    c.pins.push_back({0, 0, keys});
    std::vector<std::uint64_t> hashes;
    std::int64_t most = 0;
    for (const Options& o : machines()) {
      Simulation simulation(scene, o);
      advance(simulation, 1.5);
      most = std::max(most, asleep(simulation));
      hashes.push_back(simulation.hash());
    }
    EXPECT_GT(most, 0);
    EXPECT_LT(most, 90 * 90);
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
  }
}

}  // namespace
}  // namespace weft
