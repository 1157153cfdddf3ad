// By the course's rule, and with the response `neighbours`, neighbours on the grid push each other apart once
// they are nearer than the thickness; by default neighbours do not touch.
#include <gtest/gtest.h>

#include <cmath>

#include "weft/simulation.h"

namespace weft {
namespace {

constexpr int kColumns = 9, kRows = 7;
constexpr double kSpacing = 0.02, kThickness = 0.019;  // m, of the course's 50 x 50 points over 1 m

// Loose particles in the grid of the course.
Scene loose(SelfCollisionResponse response) {
  Scene scene;
  scene.gravity = {};
  scene.time = {1.0 / 90, 30, 1};
  Cloth cloth;
  cloth.grid = {
      kColumns, kRows, {}, {kSpacing * (kColumns - 1), 0, 0}, {0, 0, kSpacing * (kRows - 1)}};
  cloth.stiffness = {0, 0, 0};
  cloth.particle_mass = 0.06;
  cloth.drag = 20;
  cloth.self_collision = {SelfCollisionMode::particles, kThickness, 0.3, response};
  scene.cloths = {cloth};
  return scene;
}

// Where its particles are with the grid pressed together along x and z.
std::vector<double> pressed(double along, double across) {
  std::vector<double> x;
  for (int j = 0; j < kRows; ++j)
    for (int i = 0; i < kColumns; ++i)
      x.insert(x.end(), {along * kSpacing * i, 0, across * kSpacing * j});
  return x;
}

double nearest(const std::vector<double>& x) {
  double least = 1;
  for (std::size_t a = 0; a < x.size(); a += 3)
    for (std::size_t b = 0; b < a; b += 3)
      least = std::min(least, std::hypot(x[a] - x[b], x[a + 1] - x[b + 1], x[a + 2] - x[b + 2]));
  return least;
}

TEST(Neighbours, PushEachOtherApartByTheCoursesRule) {
  for (const auto response : {SelfCollisionResponse::course, SelfCollisionResponse::neighbours})
    for (const double along : {0.75, 0.9, 1.0}) {
      Simulation simulation(loose(response), {.threads = along < 0.9 ? 1 : 2});
      const std::vector<double> start = pressed(along, 0.8);
      simulation.set_state(start, std::vector<double>(start.size()));
      for (int n = 0; n < 360; ++n) simulation.advance_frame();
      const std::vector<double> end = simulation.positions();
      EXPECT_GT(nearest(end), 0.999 * kThickness) << along;
      // By pairs: what both ends of a pair are moved by is the same but for the averaging.
      double middle = 0, before = 0;
      for (std::size_t k = 2; k < end.size(); k += 3) middle += end[k], before += start[k];
      EXPECT_NEAR(middle, before, 1e-4 * kRows * kColumns) << along;
    }
}

TEST(Neighbours, StandWhereTheyAreOnTheGridAtRest) {
  Simulation simulation(loose(SelfCollisionResponse::course), {.threads = 1});
  const std::vector<double> start = simulation.positions();
  for (int n = 0; n < 30; ++n) simulation.advance_frame();
  EXPECT_EQ(simulation.positions(), start);
}

TEST(Neighbours, DoNotTouchByDefault) {
  Simulation simulation(loose(SelfCollisionResponse::stiff), {.threads = 1});
  const std::vector<double> start = pressed(0.9, 1);
  simulation.set_state(start, std::vector<double>(start.size()));
  const std::vector<double> set = simulation.positions();
  for (int n = 0; n < 30; ++n) simulation.advance_frame();
  EXPECT_EQ(simulation.positions(), set);
}

}  // namespace
}  // namespace weft
