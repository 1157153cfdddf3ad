// Sheets that cross where contact finds them come apart, and stay so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "machines.h"
#include "physics/contact/self/untangle.h"
#include "physics/frame/cloth_step.h"
#include "sheets.h"
#include "weft/random.h"

namespace weft {
namespace {

Cloth sheet(const Vec3& origin, const Vec3& u, const Vec3& v, int points) {
  Cloth cloth;
  cloth.grid = {points, points, origin, u, v, 0};
  cloth.density = 0.3;
  cloth.stiffness = {400, 200, 5};
  cloth.drag = 1;
  cloth.self_collision.mode = SelfCollisionMode::surface;
  cloth.self_collision.thickness = 0.005;
  return cloth;
}

Scene weightless(std::vector<Cloth> cloths) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.cloths = std::move(cloths);
  return scene;
}

// A sheet that stands in the middle of another.
Scene upright(int points) {
  return weightless({sheet({0, 0, 0}, {0.5, 0, 0}, {0, 0, 0.5}, 20),
                     sheet({0.2, -0.2, 0.05}, {0.02, 0.5, 0}, {0.1, 0, 0.5}, points)});
}

struct Outcome {
  int frames;      // until nothing crossed
  double kinetic;  // J, at most
  double strain;   // half a second later
};

// Until nothing crosses, and half a second beyond.
Outcome come_apart(Simulation& simulation, int most_frames) {
  Outcome o{};
  EXPECT_GT(simulation.report().penetration.crossings, 0);
  for (std::int64_t left = 1; left > 0 && o.frames < most_frames; ++o.frames) {
    simulation.advance_frame();
    const Report r = simulation.report();
    left = r.penetration.crossings;
    o.kinetic = std::max(o.kinetic, r.energy.kinetic);
  }
  for (int frame = 0; frame < 30; ++frame) {
    simulation.advance_frame();
    EXPECT_EQ(simulation.report().penetration.crossings, 0) << frame;
  }
  o.strain = simulation.report().strain.max;
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  return o;
}

bool told(const Simulation& simulation, const std::string& words) {
  const std::vector<std::string>& notes = simulation.plan().notes;
  return std::any_of(notes.begin(), notes.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

TEST(Untangle, ASheetThroughAnotherIsToldOfAndTakenThrough) {
  for (const int points : {20, 40}) {
    Simulation simulation(upright(points));
    EXPECT_TRUE(told(simulation, "taken through"));
    const Outcome o = come_apart(simulation, 40);
    std::printf("%d points: %d frames, at most %.2g J, then strain %.2f\n", points, o.frames,
                o.kinetic, o.strain);
    EXPECT_LT(o.strain, 0.1);
    EXPECT_LT(o.kinetic, 2);
  }
}

TEST(Untangle, ParticlesAloneAreToldOf) {
  Scene scene = upright(20);
  for (Cloth& cloth : scene.cloths) cloth.self_collision.mode = SelfCollisionMode::particles;
  Simulation simulation(scene);
  EXPECT_TRUE(told(simulation, "kept apart on the sides where they are"));
  EXPECT_FALSE(told(simulation, "taken through"));
}

TEST(Untangle, NothingIsSaidOrMovedWhereNothingCrosses) {
  Scene scene = upright(20);
  scene.cloths[1].grid.origin[1] = 0.05;
  Simulation simulation(scene);
  EXPECT_FALSE(told(simulation, "pass through"));
  advance(simulation, 0.5);
  EXPECT_LT(simulation.report().energy.kinetic, 1e-6);
}

// Nor are sheets looked at that lie on one side of each other: beside, above, or aslant.
TEST(Untangle, FlatSheetsThatCannotCrossAreNotSearched) {
  const auto due = [](Scene scene) {
    std::vector<std::unique_ptr<physics::ClothStep>> cloths;
    for (int c = 0; c < int(scene.cloths.size()); ++c)
      cloths.push_back(std::make_unique<physics::ClothStep>(scene, c, Method::spring, 0,
                                                            physics::kernel_table(Simd::scalar)));
    return physics::Untangle(scene, physics::models_of(cloths)).due();
  };
  Scene scene = upright(20);
  EXPECT_TRUE(due(scene));
  scene.cloths[1].grid.origin[1] = 0.05;
  EXPECT_FALSE(due(scene));
  scene.cloths[1].grid.jitter = 0.1;
  EXPECT_TRUE(due(scene));
  scene.cloths[1].self_collision.mode = SelfCollisionMode::off;
  EXPECT_FALSE(due(scene));
  scene.cloths[0].pins.push_back({0, 0, {{0, {0, 0, 0}}, {1, {0, 1, 0}}}});
  EXPECT_FALSE(due(scene));
  scene.cloths[0].pins[0].keys[0].position[0] = 0.3;  // starts elsewhere on the sheet
  EXPECT_TRUE(due(scene));
}

// Two to four sheets, anyhow in each other, of springs and of constraints.
TEST(Untangle, SheetsThrownTogetherComeApart) {
  Random random(7, 0);
  const auto any = [&] { return random.symmetric(); };
  int most = 0;
  for (int k = 0; k < 12; ++k) {
    Scene scene = weightless({});
    if (k % 2) scene.solver.method = Method::compliant;
    for (int c = 0; c < 2 + k % 3; ++c) {
      Vec3 u{any(), any(), any()}, v{any(), any(), any()}, origin{};
      const auto scale = [](Vec3& a) {
        const double length = std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        for (double& x : a) x *= 0.4 / length;
      };
      scale(u);
      double along = 0;
      for (int i = 0; i < 3; ++i) along += u[i] * v[i] / (0.4 * 0.4);
      for (int i = 0; i < 3; ++i) v[i] -= along * u[i];
      scale(v);
      for (int i = 0; i < 3; ++i) origin[i] = 0.1 * any() - 0.5 * (u[i] + v[i]);
      scene.cloths.push_back(sheet(origin, u, v, 12 + 2 * (k % 4)));
    }
    Simulation simulation(scene);
    if (simulation.report().penetration.crossings == 0) continue;
    SCOPED_TRACE(k);
    most = std::max(most, come_apart(simulation, 60).frames);
  }
  std::printf("%d frames at most\n", most);
  EXPECT_GT(most, 1);
}

// Pins drawn against a sheet that is held, far beyond it and back: it stretches, and the sheet that hangs on
// them stays on its side; a note tells of it.
TEST(Untangle, PinsDrawnAgainstASheetStretchItAndComeBack) {
  Scene scene = weightless({sheet({0, 0, 0}, {0.5, 0, 0}, {0, 0, 0.5}, 24),
                            sheet({0.1, 0.05, 0.1}, {0.3, 0, 0}, {0, 0, 0.3}, 24)});
  for (const int i : {0, 23})
    for (const int j : {0, 23}) scene.cloths[0].pins.push_back({i, j, {}});
  for (const int i : {0, 23}) {
    const double x = 0.1 + 0.3 * i / 23;
    scene.cloths[1].pins.push_back({i,
                                    0,
                                    {{0, {x, 0.05, 0.1}},
                                     {0.5, {x, -0.45, 0.1}},
                                     {1, {x, -0.45, 0.1}},
                                     {1.5, {x, 0.15, 0.1}}}});
  }
  Simulation simulation(scene);
  const auto run = [&](int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      simulation.advance_frame();
      EXPECT_EQ(simulation.report().penetration.crossings, 0) << simulation.time();
    }
  };
  // The lowest and the highest of the second sheet.
  const auto reach = [&](int sign) {
    double most = -1;
    const std::vector<double> x = simulation.positions();
    for (std::size_t n = x.size() / 2; n < x.size(); n += 3) most = std::max(most, sign * x[n + 1]);
    return most;
  };
  run(58);
  EXPECT_GT(reach(-1), 0.3);
  run(90);
  EXPECT_GT(reach(1), 0.1);
  EXPECT_LT(simulation.report().strain.max, 0.3);
  EXPECT_TRUE(simulation.status().ok);
  const std::vector<std::string>& notes = simulation.plan().notes;
  EXPECT_TRUE(std::ranges::any_of(notes, [](const std::string& note) {
    return note.find("cloth 0 is drawn against") != std::string::npos;
  }));
}

// What pins hold in each other cannot come apart: it is given up, and stays calm.
TEST(Untangle, WhatIsHeldInEachOtherIsLeft) {
  Scene scene = upright(20);
  for (Cloth& cloth : scene.cloths)
    for (const int i : {0, 19})
      for (const int j : {0, 19}) cloth.pins.push_back({i, j, {}});
  Simulation simulation(scene);
  advance(simulation, 5);
  const Report r = simulation.report();
  EXPECT_TRUE(simulation.status().ok);
  EXPECT_GT(r.penetration.crossings, 0);
  EXPECT_LT(r.energy.kinetic, 0.2);
  EXPECT_LT(r.strain.max, 2);
}

TEST(Untangle, SameBitsForAnyThreadsAndInstructionSet) {
  std::vector<std::uint64_t> hashes;
  for (const Options& o : machines()) {
    Simulation simulation(upright(20), o);
    advance(simulation, 0.25);
    hashes.push_back(simulation.hash());
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace
}  // namespace weft
