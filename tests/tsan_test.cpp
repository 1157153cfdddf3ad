// Short runs on several threads, for the thread sanitizer (and quick enough to run anywhere).
#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

#include "made_up_bodies.h"
#include "mesh_scenes.h"
#include "physics/step/threads.h"
#include "weft/simulation.h"

namespace weft {
namespace {

// Of 17000 particles: large enough to be shared out by every method (passes.cpp).
Scene falling_sheet(Method method) {
  Cloth cloth;
  cloth.grid.nx = cloth.grid.ny = 130;
  cloth.pins = {{0, 0, {}}, {129, 0, {}}};
  Scene scene;
  scene.cloths = {cloth};
  scene.solver.method = method;
  scene.time.substeps = 10;
  scene.colliders = {{Sphere{{0.5, -0.2, 0.5}, 0.2}, {}, 0.01, {}, false}};
  return scene;
}

std::uint64_t hash_after(const Scene& scene, int threads) {
  Options options;
  options.threads = threads;
  Simulation simulation(scene, options);
  for (int frame = 0; frame < 3; ++frame) simulation.advance_frame();
  return simulation.hash();
}

TEST(Threads, TwoGiveWhatOneGives) {
  for (const Method method : {Method::spring, Method::compliant, Method::positional}) {
    const Scene scene = falling_sheet(method);
    EXPECT_EQ(hash_after(scene, 2), hash_after(scene, 1));
  }
}

TEST(Threads, TwoGiveWhatOneGivesByWholeLines) {
  Scene scene = falling_sheet(Method::compliant);
  scene.solver.sweep = Sweep::line;
  scene.cloths[0].bending = 1e-5;
  EXPECT_EQ(hash_after(scene, 2), hash_after(scene, 1));
}

TEST(Threads, TwoGiveWhatOneGivesOfSheetsSideBySide) {
  Scene scene = falling_sheet(Method::spring);
  scene.time.substeps = 60;
  for (Cloth& c : scene.cloths = std::vector<Cloth>(4, scene.cloths[0])) {
    c.grid.nx = c.grid.ny = 40;
    c.pins = {{0, 0, {}}};
    c.tear_strain = 0.05;
  }
  EXPECT_EQ(hash_after(scene, 2), hash_after(scene, 1));
}

// What tears, and what a tear is told to, lie in rows that several threads work on.
TEST(Threads, TwoGiveWhatOneGivesOfMeshesThatTear) {
  Scene scene = scene_of(made_up({.nx = 130, .ny = 130, .shift = 0.2}));
  Cloth& cloth = scene.cloths[0];
  cloth.tear_strain = 0.01;
  cloth.bending = 1e-5;
  cloth.pins = {{0, 0, {}}, {129, 0, {}}};
  scene.time.substeps = 10;
  scene.solver.method = Method::compliant;
  scene.colliders = {{Sphere{{0.5, 0.1, 0.5}, 0.3}, {}, 0.01, {}, false}};
  for (const bool membrane : {false, true}) {
    if (membrane)
      cloth.membrane = {.warp = 400, .weft = 300, .coupling = 30, .shear = 60, .damping = 0};
    EXPECT_EQ(hash_after(scene, 2), hash_after(scene, 1)) << membrane;
    Simulation run(scene, {.threads = 2});
    for (int frame = 0; frame < 3; ++frame) run.advance_frame();
    EXPECT_GT(run.report(false).torn, 0) << membrane;
  }
  scene.solver.method = Method::spring;
  scene.time.substeps = 0;
  scene.time.frame = 2e-3;
  scene.wind = {.velocity = {0, 3, 1}, .drag = 1, .lift = 1};
  scene.colliders.push_back(
      {Sphere{{0.3, 0, 0}, 0.1}, {}, 0.01, {{0, {0.3, 0, 0}}, {0.01, {0.3, 0, 1}}}, true});
  EXPECT_EQ(hash_after(scene, 2), hash_after(scene, 1));
}

TEST(Threads, TwoGiveWhatOneGivesOfAGas) {
  Scene scene = scene_of(tests::ball(160, 110, 0.3));
  scene.cloths[0].pressure.inflate = 1.2;
  for (const Method method : {Method::spring, Method::compliant}) {
    scene.solver.method = method;
    scene.time.frame = method == Method::spring ? 1e-3 : 1.0 / 60;
    scene.time.substeps = method == Method::spring ? 0 : 10;
    EXPECT_EQ(hash_after(scene, 2), hash_after(scene, 1));
  }
}

// Every share of every round is worked on once, by a thread of its own number, after all of the round
// before.
TEST(Threads, ShareOutRoundAfterRound) {
  for (const int count : {1, 2, 3, 8}) {
    physics::Threads threads(count);
    std::vector<int> rounds(100, 0);
    std::vector<int> worked(std::size_t(count), 0);
    const auto round = [&](int number, std::size_t shares) {
      threads.share(shares, false, [&](std::size_t n) {
        EXPECT_EQ(rounds[n], number);
        if (count > 1) ++worked[std::size_t(physics::Threads::index())];
      });
      threads.share(shares, false, [&](std::size_t n) { ++rounds[n]; });
    };
    threads.together([&] {
      for (int number = 0; number < 300; ++number) round(number, rounds.size());
    });
    round(300, rounds.size());  // woken for once
    std::size_t all = 0;
    threads.together([&] {
      threads.share(70000, false, [&](std::size_t n) {
        if (n == 69999) all = n;
      });
    });
    EXPECT_EQ(all, 69999u);
    EXPECT_THROW(threads.together([] { throw std::runtime_error("no work"); }), std::runtime_error);
    round(301, rounds.size());
  }
}

TEST(Threads, TwoSimulationsAtOnceDoNotMeet) {
  const Scene scene = falling_sheet(Method::spring);
  std::uint64_t first = 0;
  std::uint64_t second = 0;
  std::thread one([&] { first = hash_after(scene, 2); });
  std::thread two([&] { second = hash_after(scene, 2); });
  one.join();
  two.join();
  EXPECT_EQ(first, second);
}

}  // namespace
}  // namespace weft
