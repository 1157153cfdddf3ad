// Going back to a snapshot, going on with another scene, and hands that move colliders and pins.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "sheets.h"
#include "weft/read_scene.h"
#include "weft/shape.h"
#include "weft/simulation.h"

namespace weft {
namespace {

Scene curtain() {
  Cloth cloth;
  cloth.grid = {.nx = 12, .ny = 10, .origin = {}, .u = {1, 0, 0}, .v = {0, -1, 0}, .jitter = 1e-3};
  cloth.pins = {{.i = 0, .j = 0, .keys = {}}, {.i = 11, .j = 0, .keys = {}}};
  cloth.drag = 1;
  Scene scene;
  scene.cloths = {cloth};
  scene.colliders = {
      {.shape = Sphere{{0.5, -0.6, 0.5}, 0.2}, .friction = {}, .offset = 0.01, .keys = {}}};
  return scene;
}

void run(Simulation& simulation, int frames) {
  for (int n = 0; n < frames; ++n) simulation.advance_frame();
  ASSERT_TRUE(simulation.status().ok) << simulation.status().text;
}

long held(const Simulation& simulation) {
  const View view = simulation.view();
  const ClothView& cloth = view.cloths[0];
  long count = 0;
  for (int j = 0; j < cloth.rows; ++j)
    for (int i = 0; i < cloth.columns; ++i)
      count += cloth.inverse_mass[std::size_t(j * cloth.stride + i)] == 0;
  return count;
}

TEST(Snapshot, BringsBackPositionsTimePinsAndTears) {
  Simulation simulation(curtain());
  run(simulation, 5);
  simulation.pin(0, 9 * 12 + 5);
  simulation.cut({0.3, -0.5, -0.5}, {0.3, -0.5, 0.5}, 0.06);
  run(simulation, 5);
  const Snapshot snapshot = simulation.snapshot();
  const auto hash = simulation.hash();
  const auto torn = simulation.report().torn;
  ASSERT_GT(torn, 0);
  simulation.unpin(0, 9 * 12 + 5);
  simulation.cut({0.7, -0.5, -0.5}, {0.7, -0.5, 0.5}, 0.06);
  run(simulation, 20);
  ASSERT_NE(simulation.hash(), hash);
  simulation.restore(snapshot);
  EXPECT_EQ(simulation.hash(), hash);
  EXPECT_EQ(simulation.frame(), 10);
  EXPECT_EQ(simulation.report().torn, torn);
  EXPECT_EQ(held(simulation), 3);
}

TEST(Snapshot, TheSameWayFollowsTwice) {
  Simulation a(curtain()), b(curtain());
  run(a, 8);
  const Snapshot snapshot = a.snapshot();
  a.restore(snapshot);
  b.restore(snapshot);
  run(a, 12);
  run(b, 12);
  EXPECT_EQ(a.hash(), b.hash());
}

// What self-collision remembers of the way so far is no part of a snapshot: it starts anew in a simulation
// that goes back as in one that has just begun.
TEST(Snapshot, TheSameWayFollowsTwiceWithSelfCollision) {
  for (const char* text :
       {R"({"weft": 1, "cloths": [{"grid": {"points": [3, 10], "origin": [0.1, 0, 0],
            "u": [0.08, 0, 0], "v": [0, 0, 0.1]}, "stiffness": {"shear": 0},
            "self_collision": {"mode": "particles"}}],
            "colliders": [{"box": {"center": [0.128, 0, 0.09]}}]})",
        R"({"weft": 1, "time": {"substeps": 4}, "cloths": [{"grid": {"points": [18, 15]},
            "self_collision": {"mode": "surface"},
            "pins": [{"at": [0, 0], "keys": [[0, 0, 1, 0], [0.02, 0, 0, 0]]}]},
            {"grid": {"points": [18, 14]}}]})"}) {
    const Scene scene = read_scene_text(text).scene;
    for (int frames = 1; frames < 6; ++frames) {
      Simulation a(scene), b(scene);
      run(a, frames);
      const Snapshot snapshot = a.snapshot();
      a.restore(snapshot);
      b.restore(snapshot);
      for (int n = 0; n < 4; ++n) {
        run(a, 1);
        run(b, 1);
        ASSERT_EQ(a.hash(), b.hash()) << text << ": " << frames << " and " << n + 1 << " frames";
      }
    }
  }
}

// A sheet that is pulled far, where its substeps follow its stretch.
TEST(Snapshot, LettingGoOfWhatIsFreeChangesNothing) {
  const Scene scene = read_scene("tug").scene;
  Simulation a(scene), b(scene);
  run(a, 20);
  run(b, 20);
  b.unpin(0, particle_number(scene.cloths[0].grid, 5, 9));
  run(a, 40);
  run(b, 40);
  EXPECT_EQ(a.substeps(), b.substeps());
  EXPECT_EQ(a.hash(), b.hash());
}

TEST(Snapshot, OfAnotherGridIsRefused) {
  Scene other = curtain();
  other.cloths[0].grid.nx = 13;
  other.cloths[0].pins.clear();
  Simulation a(curtain()), b(other);
  EXPECT_THROW(b.restore(a.snapshot()), std::invalid_argument);
}

TEST(SetScene, GoesOnWithOtherValues) {
  Simulation simulation(curtain());
  run(simulation, 10);
  const std::vector<double> before = simulation.positions();
  Scene stiff = curtain();
  stiff.cloths[0].stiffness.structural = 20000;
  stiff.cloths[0].pins.pop_back();
  simulation.set_scene(stiff);
  EXPECT_EQ(simulation.positions(), before);
  EXPECT_EQ(simulation.frame(), 10);
  EXPECT_EQ(simulation.scene().cloths[0].stiffness.structural, 20000);
  EXPECT_EQ(held(simulation), 1);
  run(simulation, 30);
}

// A ball put into the middle of a swinging sheet, and then made larger, pushes it aside as gently as
// one that is there from the start.
TEST(SetScene, CollidersPutIntoAClothMoveItGently) {
  for (const auto& [method, sweep] : {std::pair{Method::spring, Sweep::gauss_seidel},
                                      std::pair{Method::compliant, Sweep::gauss_seidel},
                                      std::pair{Method::compliant, Sweep::line}}) {
    Scene scene = read_scene("swing").scene;
    scene.solver.method = method;
    scene.solver.sweep = sweep;
    scene.cloths[0].drag = 1;
    Simulation simulation(scene);
    run(simulation, 30);
    const Grid& grid = scene.cloths[0].grid;
    const Vec3 middle = position(simulation, grid.nx / 2, grid.ny / 2);
    double fastest = 0, longest = 0;
    for (const double radius : {0.1, 0.2, 0.3}) {
      scene.colliders = {{.shape = Sphere{middle, radius}, .friction = {}, .keys = {}}};
      simulation.set_scene(scene);
      for (int frame = 0; frame < 12; ++frame) {
        simulation.advance_frame();
        for (const double v : simulation.velocities()) fastest = std::max(fastest, std::abs(v));
        longest = std::max(longest, simulation.report().strain.max);
      }
    }
    std::printf("method %d, sweep %d: fastest %.1f m/s, longest %.0f %%\n", int(method), int(sweep),
                fastest, 100 * longest);
    EXPECT_LT(fastest, 20);
    EXPECT_LT(longest, 0.3);
    EXPECT_LT(simulation.report().penetration.collider_max, 1e-4);
  }
}

// While it does, a snapshot goes on alike in another simulation.
TEST(SetScene, SnapshotsKnowWhatCollidersHaveMet) {
  Scene scene = curtain();
  Simulation simulation(scene);
  run(simulation, 20);
  scene.colliders[0].shape = Sphere{position(simulation, 6, 5), 0.2};
  simulation.set_scene(scene);
  run(simulation, 5);
  const Snapshot snapshot = simulation.snapshot();
  EXPECT_GT(snapshot.cloths[0].inside[0].particle, 0.1);
  Simulation other(scene);
  for (Simulation* s : {&simulation, &other}) {
    s->restore(snapshot);
    run(*s, 8);
  }
  EXPECT_EQ(simulation.hash(), other.hash());
}

TEST(SetScene, StartsAnewWithAnotherGridAndRefusesFaults) {
  Simulation simulation(curtain());
  run(simulation, 3);
  Scene faulty = curtain();
  faulty.cloths[0].density = -1;
  const auto hash = simulation.hash();
  EXPECT_THROW(simulation.set_scene(faulty), SceneError);
  EXPECT_EQ(simulation.hash(), hash);
  Scene finer = curtain();
  finer.cloths[0].grid.ny = 20;
  simulation.set_scene(finer);
  EXPECT_EQ(simulation.frame(), 0);
}

TEST(Hand, ACollidersMovePushesTheCloth) {
  for (const Method method : {Method::spring, Method::compliant}) {
    Scene scene = curtain();
    scene.solver.method = method;
    Simulation simulation(scene);
    run(simulation, 30);
    for (int n = 1; n <= 60; ++n) {
      simulation.move_collider(0, {0.5, -0.6, 0.5 - 0.01 * n});
      run(simulation, 1);
    }
    const Collider& sphere = simulation.scene().colliders[0];
    EXPECT_NEAR(displacement(sphere, simulation.time())[2], -0.6, 1e-9);
    EXPECT_LT(simulation.report().penetration.collider_max, 1e-4);
    const std::vector<double> x = simulation.positions();
    double farthest = 0;
    for (std::size_t k = 2; k < x.size(); k += 3) farthest = std::min(farthest, x[k]);
    EXPECT_LT(farthest, -0.25);
  }
  Simulation simulation(curtain());
  EXPECT_THROW(simulation.move_collider(1, {}), std::out_of_range);
}

// A snapshot is a caller's data: whatever is wrong with it is refused, and nothing has changed.
TEST(Snapshot, RefusesWhatIsOutOfRange) {
  Scene scene = curtain();
  scene.cloths[0].tear_strain = 0.5;
  Simulation simulation(scene);
  run(simulation, 3);
  const Snapshot sound = simulation.snapshot();
  const auto hash = simulation.hash();
  const double nan = std::nan("");
  const std::vector<std::function<void(Snapshot&)>> faults = {
      [](Snapshot& m) { m.cloths[0].held.push_back(120); },
      [](Snapshot& m) { m.cloths[0].held.push_back(-1); },
      [](Snapshot& m) { m.cloths[0].held.push_back(1 << 30); },
      [](Snapshot& m) { m.cloths[0].columns = 10; },
      [](Snapshot& m) {
        m.cloths[0].torn.push_back({0, 120});
      },
      [](Snapshot& m) {
        m.cloths[0].torn.push_back({-1, 0});
      },
      [](Snapshot& m) {
        m.cloths[0].torn.push_back({119, 1 << 30});
      },
      [](Snapshot& m) {
        m.cloths[0].torn.push_back({7, 7});
      },
      [](Snapshot& m) { m.cloths[0].positions.pop_back(); },
      [](Snapshot& m) { m.cloths[0].velocities.clear(); },
      [&](Snapshot& m) { m.cloths[0].positions[5] = float(nan); },
      [](Snapshot& m) { m.cloths[0].velocities[7] = INFINITY; },
      [](Snapshot& m) { m.cloths[0].inside.clear(); },
      [&](Snapshot& m) { m.cloths[0].inside[0].particle = nan; },
      [](Snapshot& m) { m.cloths[0].inside[0].triangle = -1; },
      [](Snapshot& m) { m.cloths.clear(); },
      [](Snapshot& m) { m.cloths.push_back(m.cloths[0]); },
      [](Snapshot& m) {
        m.origin = {1e30, 0, 0};
      },
      [&](Snapshot& m) {
        m.origin = {0, nan, 0};
      },
      [](Snapshot& m) {
        m.origin = {0, 0, 0.5};
      },
      [](Snapshot& m) { m.lag = -1e-9; },
      [](Snapshot& m) { m.lag = 1.1; },
      [&](Snapshot& m) { m.lag = nan; },
      [](Snapshot& m) { m.time = -1; },
      [](Snapshot& m) { m.time = 1e300; },
      [&](Snapshot& m) { m.time = nan; },
      [](Snapshot& m) { m.paths.clear(); },
      [&](Snapshot& m) {
        m.paths[0] = {{0, {0, nan, 0}}};
      },
      [](Snapshot& m) {
        m.paths[0] = {{1, {0, 0, 0}}, {1, {0, 0, 0}}};
      },
  };
  for (std::size_t n = 0; n < faults.size(); ++n) {
    Snapshot snapshot = sound;
    faults[n](snapshot);
    EXPECT_THROW(simulation.restore(snapshot), std::invalid_argument) << n;
    EXPECT_EQ(simulation.hash(), hash) << n;
  }
  Snapshot snapshot = sound;
  snapshot.cloths[0].held.push_back(119);
  snapshot.cloths[0].torn.push_back({8 * 12 + 11, 9 * 12 + 11});
  snapshot.cloths[0].torn.push_back({3, 70});  // nothing joins these
  snapshot.origin = {100, 0, -3};
  simulation.restore(snapshot);
  run(simulation, 3);
  EXPECT_EQ(held(simulation), 3);
}

TEST(Hand, WhatIsHeldIsCarriedAndRests) {
  for (const Method method : {Method::spring, Method::positional, Method::compliant}) {
    Scene scene = curtain();
    scene.solver.method = method;
    Simulation simulation(scene);
    run(simulation, 2);
    const std::vector<double> start = simulation.positions();
    simulation.carry(0, {0, 0, 0.6});
    run(simulation, 60);
    simulation.carry(0, {});
    run(simulation, 10);
    const std::vector<double> x = simulation.positions();
    EXPECT_NEAR(x[2] - start[2], 0.6, 1e-6);
    EXPECT_NEAR(x[3 * 11 + 2] - start[3 * 11 + 2], 0.6, 1e-6);
    EXPECT_EQ(held(simulation), 2);
  }
}

// No hand is a part of a snapshot: the same follows as in a simulation that none has touched, and it may be
// faster than any scene.
TEST(Hand, LetsGoWhenASnapshotIsPutBack) {
  for (const Method method : {Method::spring, Method::positional, Method::compliant})
    for (const double speed : {0.6, -1e7}) {
      Scene scene = curtain();
      scene.solver.method = method;
      Simulation touched(scene), fresh(scene);
      run(touched, 2);
      const Snapshot snapshot = touched.snapshot();
      touched.carry(0, {0, speed, 0});
      touched.grab(0, 50, {0, -1, 0});
      run(touched, 2);
      for (Simulation* s : {&touched, &fresh}) {
        s->restore(snapshot);
        run(*s, 5);
        EXPECT_TRUE(s->status().ok) << speed;
      }
      EXPECT_EQ(touched.positions(), fresh.positions()) << speed;
      EXPECT_EQ(touched.velocities(), fresh.velocities()) << speed;
      EXPECT_EQ(touched.plan().notes, fresh.plan().notes) << speed;
    }
}

TEST(Hand, CarriesOnFromAStateThatIsSet) {
  Simulation simulation(curtain());
  simulation.carry(0, {0, 0, 0.6});
  run(simulation, 10);
  std::vector<double> x = simulation.positions();
  const std::vector<double> v = simulation.velocities();
  for (std::size_t n = 0; n < x.size(); n += 3) x[n] += 0.25;
  simulation.set_state(x, v);
  run(simulation, 10);
  const std::vector<double> now = simulation.positions();
  EXPECT_NEAR(now[0] - x[0], 0, 1e-6);
  EXPECT_NEAR(now[2] - x[2], 10 * 0.6 * simulation.scene().time.frame, 1e-6);
}

TEST(Hand, IsNotFasterThanTheWorldIsWide) {
  Simulation simulation(curtain());
  for (const double speed : {1.1e7, -1e38, 1e300, double(NAN), double(INFINITY)})
    EXPECT_THROW(simulation.carry(0, {0, speed, 0}), std::invalid_argument) << speed;
}

TEST(Report, WithoutContactsTheRestIsTheSame) {
  Simulation simulation(curtain());
  run(simulation, 10);
  const Report whole = simulation.report(), part = simulation.report(false);
  EXPECT_EQ(part.energy.total, whole.energy.total);
  EXPECT_EQ(part.strain.max, whole.strain.max);
  EXPECT_EQ(part.hash, whole.hash);
}

}  // namespace
}  // namespace weft
