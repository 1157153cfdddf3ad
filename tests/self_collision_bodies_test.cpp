// Layers of cloth on bodies: what lies below is held, and slides, as the body's friction says of all that presses it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "weft/simulation.h"
#include "weft/vec3.h"

namespace weft {
namespace {

constexpr int kPoints = 10;
constexpr double kSide = 0.22, kThickness = 0.012;

struct Way {
  const char* name;
  Method method;
  Sweep sweep;
  SelfCollisionMode mode;
  int substeps;
};
constexpr Way kWays[] = {
    {"springs, surfaces", Method::spring, Sweep::gauss_seidel, SelfCollisionMode::surface,
     kAutoSubsteps},
    {"colours, surfaces", Method::compliant, Sweep::gauss_seidel, SelfCollisionMode::surface, 16},
    {"lines, surfaces", Method::compliant, Sweep::line, SelfCollisionMode::surface, 64},
    {"colours, particles", Method::compliant, Sweep::gauss_seidel, SelfCollisionMode::particles,
     16},
    {"positional, particles", Method::positional, Sweep::gauss_seidel, SelfCollisionMode::particles,
     32},
};

// A plane, so much aslant, and two sheets on it, the upper one so many times as heavy.
Scene stack(const Way& way, double degrees, double heavier, double friction, double between) {
  Scene scene;
  scene.time = {1.0 / 60, way.substeps, 2};
  scene.solver.method = way.method;
  scene.solver.sweep = way.sweep;
  const double angle = degrees * std::numbers::pi / 180;
  const Vec3 along{std::cos(angle), -std::sin(angle), 0},
      normal{std::sin(angle), std::cos(angle), 0};
  for (const int layer : {0, 1}) {
    Cloth& cloth = scene.cloths.emplace_back();
    const Vec3 corner = minus(times(normal, layer * kThickness), times(along, kSide / 2));
    cloth.grid = {kPoints, kPoints, corner, times(along, kSide), {0, 0, kSide}, 0};
    cloth.density = layer == 0 ? 0.2 : 0.2 * heavier;
    cloth.stiffness = {1000, 500, 10};
    cloth.drag = 0;
    cloth.self_collision.mode = way.mode;
    cloth.self_collision.thickness = kThickness;
    cloth.self_collision.friction = between;
  }
  Collider plane;
  plane.shape = Plane{{0, 0, 0}, normal};
  plane.friction.statik = plane.friction.dynamic = friction;
  scene.colliders = {plane};
  return scene;
}

// How far the middle of each sheet goes down the slope between two times [m].
std::array<double, 2> slid(const Scene& scene, int from, int to) {
  Simulation simulation(scene, {.threads = 1});
  const Vec3 along = times(scene.cloths[0].grid.u, 1 / kSide);
  const auto middles = [&] {
    std::array<double, 2> sum{};
    const std::vector<double> x = simulation.positions();
    for (std::size_t p = 0; p < x.size() / 3; ++p)
      sum[p / (kPoints * kPoints)] +=
          dot({x[3 * p], x[3 * p + 1], x[3 * p + 2]}, along) / (kPoints * kPoints);
    return sum;
  };
  for (int frame = 0; frame < from; ++frame) simulation.advance_frame();
  const auto start = middles();
  for (int frame = from; frame < to; ++frame) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  const auto end = middles();
  return {end[0] - start[0], end[1] - start[1]};
}

TEST(LayersOnABody, StickBelowItsAngleHoweverHeavyTheUpperOneIs) {
  for (const Way& way : kWays)
    for (const double heavier : {1.0, 10.0}) {
      const auto [below, above] = slid(stack(way, 22, heavier, 0.5, 2), 12, 40);
      EXPECT_LT(std::abs(below), 1e-4) << way.name << ", " << heavier << " times as heavy";
      EXPECT_LT(std::abs(above), 1e-4) << way.name << ", " << heavier << " times as heavy";
    }
}

TEST(LayersOnABody, SlideTogetherAboveItsAngle) {
  const double angle = 32 * std::numbers::pi / 180, from = 6.0 / 60, to = 30.0 / 60;
  const double expected =
      9.81 / 2 * (std::sin(angle) - 0.5 * std::cos(angle)) * (to * to - from * from);
  for (const Way& way : kWays)
    for (const double heavier : {1.0, 10.0}) {
      const auto [below, above] = slid(stack(way, 32, heavier, 0.5, 2), 6, 30);
      EXPECT_NEAR(below / expected, 1, 0.06) << way.name << ", " << heavier << " times as heavy";
      EXPECT_NEAR(above / expected, 1, 0.06) << way.name << ", " << heavier << " times as heavy";
    }
}

TEST(LayersOnABody, AtRestHaveNoVelocity) {
  for (const Way& way : kWays) {
    Scene scene = stack(way, 0, 20, 0.5, 0.5);
    for (Cloth& cloth : scene.cloths) cloth.drag = 5;  // springs by themselves swing on
    Simulation simulation(scene, {.threads = 1});
    for (int frame = 0; frame < 60; ++frame) simulation.advance_frame();
    // What gravity gives in half a substep: velocities of springs are told as if what is above another fell freely for
    // so long.
    const double speed = 1e-4 + 9.81 * scene.time.frame / simulation.plan().substeps / 2;
    EXPECT_LT(simulation.report(false).energy.kinetic,
              0.5 * 21 * 0.2 * kSide * kSide * speed * speed)
        << way.name;
  }
}

// Between two planes, each as steep as the other.
TEST(LayersOnABody, LieInAGrooveOfTwoBodies) {
  for (const Way& way : kWays)
    for (const double heavier : {1.0, 10.0}) {
      Scene scene = stack(way, 0, heavier, 0.3, 0.3);
      const double s = std::sqrt(0.5);
      scene.colliders[0].shape = Plane{{0, -0.04, 0}, {s, s, 0}};
      Collider other = scene.colliders[0];
      other.shape = Plane{{0, -0.04, 0}, {-s, s, 0}};
      scene.colliders.push_back(other);
      Simulation simulation(scene, {.threads = 1});
      double deepest = 0;
      for (int frame = 0; frame < 40; ++frame) {
        simulation.advance_frame();
        deepest = std::max(deepest, simulation.report().penetration.collider_max);
      }
      EXPECT_LT(deepest, 1e-4) << way.name << ", " << heavier << " times as heavy";
    }
}

// A ball comes up below them.
TEST(LayersOnABody, AreNotPressedIntoABall) {
  for (const Way& way : kWays)
    for (const double heavier : {1.0, 20.0}) {
      Scene scene = stack(way, 0, heavier, 0.3, 0.3);
      Collider& ball = scene.colliders[0];
      ball.shape = Sphere{{0, -0.1, kSide / 2}, 0.09};
      ball.keys = {{0, {0, -0.1, kSide / 2}}, {1, {0, 0.9, kSide / 2}}};
      Simulation simulation(scene, {.threads = 1});
      double deepest = 0;
      for (int frame = 0; frame < 12; ++frame) {
        simulation.advance_frame();
        deepest = std::max(deepest, simulation.report().penetration.collider_max);
      }
      EXPECT_LT(deepest, 1e-4) << way.name << ", " << heavier << " times as heavy";
    }
}

}  // namespace
}  // namespace weft
