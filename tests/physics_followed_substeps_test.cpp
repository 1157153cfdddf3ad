// Automatic substeps that follow what stretch asks for: few changes, so that none heat a cloth.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "physics/frame/time_step.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using physics::FollowedSubsteps;

TEST(FollowedSubsteps, MoreAtOnceAndFewerAfterAWhile) {
  FollowedSubsteps followed;
  followed.take(10, 0);
  EXPECT_EQ(followed.next(10, 0.1, false), 10);
  const int more = followed.next(30, 0.2, false);
  EXPECT_GE(more, 30);
  for (double time = 0.3; time < 1.15; time += 0.1) EXPECT_EQ(followed.next(10, time, false), more);
  const int fewer = followed.next(12, 1.3, false);
  EXPECT_GE(fewer, 12);
  EXPECT_LT(fewer, more);
}

// What swings to and fro ends up with what its swings need.
TEST(FollowedSubsteps, NeedsThatComeAndGoChangeThemAFewTimes) {
  for (const double period : {0.3, 2.1, 7.0}) {
    FollowedSubsteps followed;
    followed.take(10, 0);
    int now = 0, changes = 0;
    for (int frame = 1; frame <= 60 * 200; ++frame) {
      const double time = frame / 60.0;
      const bool stretched = time / period - int(time / period) < 0.1;
      const int next = followed.next(stretched ? 13 : 10, time, false);
      changes += next != now;
      now = next;
      ASSERT_GE(now, stretched ? 13 : 10);
    }
    EXPECT_LE(changes, 9) << period;
  }
}

TEST(FollowedSubsteps, WhatAHandAskedForPassesAtOnce) {
  FollowedSubsteps followed;
  followed.take(10, 0);
  EXPECT_EQ(followed.next(10, 0.1, false), 10);
  EXPECT_EQ(followed.next(40, 0.2, true), 40);
  EXPECT_EQ(followed.next(20, 0.3, true), 20);
  EXPECT_EQ(followed.next(11, 0.4, false), 11);
  EXPECT_EQ(followed.next(10, 0.5, false), 11);
}

enum class Held { side, corner, middle };

// Undamped, let go from flat: gravity puts energy in, and nothing else does.
Scene swinging(bool membrane, Held held) {
  Scene scene;
  scene.time.substeps = kAutoSubsteps;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {12, 10, {0, 0, 0}, {1, 0, 0}, {0, 0, 0.8}, 0};
  if (membrane)
    cloth.membrane = {400, 300, 20, 60, 0};
  else
    cloth.stiffness = {300, 300, 0};
  for (int i = 0; i < (held == Held::side ? 12 : 1); ++i)
    cloth.pins.push_back(held == Held::middle ? Pin{6, 5, {}} : Pin{i, 0, {}});
  return scene;
}

TEST(AutomaticSubsteps, MakeNoEnergyOfChangingStretch) {
  for (const bool membrane : {false, true})
    for (const Held held : {Held::side, Held::corner, Held::middle}) {
      Simulation simulation(swinging(membrane, held));
      const auto total = [](const Report& r) {
        return r.energy.kinetic + r.energy.elastic + r.energy.gravity;
      };
      const double start = total(simulation.report());
      double made = 0, motion = 0;
      for (int frame = 0; frame < 60 * 20; ++frame) {
        simulation.advance_frame();
        if (frame % 10 != 0) continue;
        const Report report = simulation.report();
        made = std::max(made, total(report) - start);
        motion = std::max(motion, report.energy.kinetic);
      }
      EXPECT_LT(made, 0.02 * motion) << (membrane ? "membrane " : "springs ") << int(held);
      EXPECT_FALSE(simulation.plan().fallback);
    }
}

}  // namespace
}  // namespace weft
