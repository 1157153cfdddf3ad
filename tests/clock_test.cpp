// The fixed-step clock on made-up times: nothing sleeps.
#include "weft/clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace weft {
namespace {

constexpr double kStep = 0.25;

TEST(Clock, FirstCallSetsTheOrigin) {
  FixedStepClock clock(kStep);
  EXPECT_EQ(clock.advance(1234.5), 0);
  EXPECT_EQ(clock.time(), 0);
  EXPECT_EQ(clock.advance(1234.5 + kStep), 1);
}

TEST(Clock, StepsOnlyWhenThePhysicsClockIsBehind) {
  FixedStepClock clock(kStep);
  clock.advance(0);
  EXPECT_EQ(clock.advance(0.125), 1);  // physics 0.25: ahead of the frame clock now
  EXPECT_EQ(clock.advance(0.25), 0);
  EXPECT_EQ(clock.advance(0.375), 1);
  EXPECT_EQ(clock.time(), 0.5);
}

TEST(Clock, PhysicsStaysLessThanOneStepAheadForAnyDisplayRate) {
  for (const double rate : {7.0, 24.0, 59.94, 60.0, 144.0, 1000.0}) {
    FixedStepClock clock(1.0 / 60, 100);
    clock.advance(0);
    for (int frame = 1; frame <= 2000; ++frame) {
      const double now = frame / rate;
      clock.advance(now);
      EXPECT_GE(clock.time() - now, -1e-6) << rate;
      EXPECT_LT(clock.time() - now, clock.step()) << rate;
    }
    EXPECT_EQ(clock.dropped(), 0);
  }
}

TEST(Clock, EqualRatesGiveOneStepPerFrameInSpiteOfRounding) {
  FixedStepClock clock(1.0 / 60);
  clock.advance(1e5);
  for (int frame = 1; frame <= 10000; ++frame) ASSERT_EQ(clock.advance(1e5 + frame / 60.0), 1);
}

TEST(Clock, ASlowMachineDropsTimeInsteadOfFreezing) {
  FixedStepClock clock(kStep, 3);
  clock.advance(0);
  EXPECT_EQ(clock.advance(2), 3);  // 8 steps were due
  EXPECT_DOUBLE_EQ(clock.lag(), 5 * kStep);
  EXPECT_DOUBLE_EQ(clock.dropped(), 5 * kStep);
  EXPECT_EQ(clock.advance(2.25), 1);  // and goes on as if nothing had been
  EXPECT_EQ(clock.lag(), 0);
  EXPECT_DOUBLE_EQ(clock.dropped(), 5 * kStep);
}

TEST(Clock, ExactlyTheMostStepsIsNoLag) {
  FixedStepClock clock(kStep, 3);
  clock.advance(0);
  EXPECT_EQ(clock.advance(0.75), 3);
  EXPECT_EQ(clock.lag(), 0);
}

TEST(Clock, PausedTimeIsNeverMadeUpFor) {
  FixedStepClock clock(kStep);
  clock.advance(0);
  clock.pause();
  EXPECT_TRUE(clock.paused());
  EXPECT_EQ(clock.advance(100), 0);
  clock.resume();
  EXPECT_EQ(clock.advance(100.25), 1);
  EXPECT_EQ(clock.dropped(), 0);
}

TEST(Clock, SingleStepsPauseAndAddUp) {
  FixedStepClock clock(kStep);
  clock.advance(0);
  clock.single_step();
  EXPECT_TRUE(clock.paused());
  EXPECT_EQ(clock.advance(10), 1);
  EXPECT_EQ(clock.advance(20), 0);
  clock.single_step();
  clock.single_step();
  EXPECT_EQ(clock.advance(30), 2);
  EXPECT_EQ(clock.steps(), 3);
}

TEST(Clock, ResumingForgetsSingleStepsThatWereNotTaken) {
  FixedStepClock clock(kStep);
  clock.advance(0);
  clock.single_step();
  clock.resume();
  EXPECT_EQ(clock.advance(0), 0);
}

TEST(Clock, SpeedScalesPhysicsTime) {
  FixedStepClock clock(kStep);
  clock.advance(0);
  clock.set_speed(0.5);
  EXPECT_EQ(clock.advance(1), 2);
  clock.set_speed(2);
  EXPECT_EQ(clock.advance(1.5), 4);
  clock.set_speed(0);
  EXPECT_EQ(clock.advance(100), 0);
}

TEST(Clock, TimeThatGoesBackOrIsNoNumberCountsAsNone) {
  FixedStepClock clock(kStep);
  EXPECT_EQ(clock.advance(std::nan("")), 0);
  EXPECT_EQ(clock.advance(10), 0);
  EXPECT_EQ(clock.advance(9), 0);
  EXPECT_EQ(clock.advance(std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(clock.advance(9.25), 1);
}

TEST(Clock, BlendMovesFromThePreviousStateToTheCurrent) {
  FixedStepClock clock(kStep);
  clock.advance(0);
  EXPECT_EQ(clock.blend(), 1);  // no step yet: the start itself
  clock.advance(0.0625);
  EXPECT_DOUBLE_EQ(clock.blend(), 0.25);
  clock.advance(0.1875);
  EXPECT_DOUBLE_EQ(clock.blend(), 0.75);
  clock.advance(0.25);
  EXPECT_DOUBLE_EQ(clock.blend(), 1);
}

TEST(Clock, RefusesWhatMakesNoSense) {
  EXPECT_THROW(FixedStepClock(0), std::invalid_argument);
  EXPECT_THROW(FixedStepClock(-1), std::invalid_argument);
  EXPECT_THROW(FixedStepClock(std::nan("")), std::invalid_argument);
  EXPECT_THROW(FixedStepClock(kStep, 0), std::invalid_argument);
  FixedStepClock clock(kStep);
  EXPECT_THROW(clock.set_speed(-1), std::invalid_argument);
  EXPECT_THROW(clock.set_speed(std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace weft
