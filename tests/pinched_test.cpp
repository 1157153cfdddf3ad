// Bodies, or sheets, that leave a cloth too little room, and bodies that pass through it, are told of; others are not.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <tuple>

#include "made_up_bodies.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr double kOffset = 0.002, kThickness = 0.004;  // m

Cloth sheet(int layer, SelfCollisionMode mode) {
  Cloth c;
  c.grid = {13, 13, {-0.15, 0.004 + 0.005 * layer, -0.15}, {0.3, 0, 0}, {0, 0, 0.3}, 0};
  c.self_collision.mode = mode;
  c.self_collision.thickness = kThickness;
  c.bending = 1e-4;
  return c;
}

Collider body(Shape shape, double offset) {
  Collider b;
  b.shape = std::move(shape);
  b.offset = offset;
  return b;
}

bool tells(const Scene& scene, const std::string& text, int frames = 60) {
  Simulation simulation(scene);
  for (int frame = 0; frame < frames; ++frame) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok);
  const std::vector<std::string> notes = simulation.plan().notes;
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(text) != std::string::npos; });
}

constexpr const char *kNoRoom = "less room than their offsets", *kTooNear = "half of their";

using Press = std::tuple<bool, Method, SelfCollisionMode>;  // spheres or planes
class PinchedTest : public testing::TestWithParam<Press> {};

// Two bodies come so near to each other.
Scene press(const Press& given, double gap, int sheets) {
  const auto& [spheres, method, mode] = given;
  Scene scene;
  scene.solver.method = method;
  for (int k = 0; k < sheets; ++k) scene.cloths.push_back(sheet(k, mode));
  constexpr double kRadius = 0.2;
  const double lift = spheres ? kRadius : 0;
  const Vec3 low{0, -lift, 0}, start{0, 0.1 + lift, 0}, end{0, gap + lift, 0};
  if (spheres)
    scene.colliders = {body(Sphere{low, kRadius}, kOffset), body(Sphere{start, kRadius}, kOffset)};
  else
    scene.colliders = {body(Plane{low, {0, 1, 0}}, kOffset),
                       body(Plane{start, {0, -1, 0}}, kOffset)};
  scene.colliders[1].keys = {{0, start}, {0.5, end}};
  return scene;
}

TEST_P(PinchedTest, WhatBodiesLeaveNoRoomIsToldOf) {
  EXPECT_FALSE(tells(press(GetParam(), 2.5 * kOffset, 1), kNoRoom));
  EXPECT_TRUE(tells(press(GetParam(), 1.5 * kOffset, 1), kNoRoom));
  EXPECT_TRUE(tells(press(GetParam(), -kOffset, 1), kNoRoom)) << "bodies in each other";
}

INSTANTIATE_TEST_SUITE_P(
    , PinchedTest,
    testing::Combine(testing::Bool(),
                     testing::Values(Method::spring, Method::compliant, Method::positional),
                     testing::Values(SelfCollisionMode::off, SelfCollisionMode::surface)));

// Three sheets need two thicknesses between the outer ones.
TEST(Pinched, SheetsThatArePressedTogetherAreToldOf) {
  for (const bool spheres : {false, true}) {
    const Press given{spheres, Method::spring, SelfCollisionMode::surface};
    EXPECT_TRUE(tells(press(given, 2 * kOffset + 0.3 * kThickness, 3), kTooNear, 45)) << spheres;
    EXPECT_FALSE(tells(press(given, 2 * kOffset + 2.2 * kThickness, 3), kTooNear, 45)) << spheres;
  }
}

// A sheet that lies in a groove touches two bodies, which leave it all the room it needs.
TEST(Pinched, NothingIsToldOfASheetInAGroove) {
  Scene scene;
  scene.cloths = {sheet(8, SelfCollisionMode::off)};
  scene.colliders = {body(Plane{{0, 0, 0}, {0.5, 0.8, 0}}, kOffset),
                     body(Plane{{0, 0, 0}, {-0.5, 0.8, 0}}, kOffset)};
  EXPECT_FALSE(tells(scene, kNoRoom, 120));
}

// Edges of a body that the cloth starts on the wrong side of, and those that it lies on.
TEST(Pierced, EdgesThroughAClothAreToldOf) {
  for (const Method method : {Method::spring, Method::compliant}) {
    for (const double start : {0.06, 0.11}) {
      Scene scene;
      scene.solver.method = method;
      scene.cloths = {sheet(0, SelfCollisionMode::off)};
      scene.cloths[0].grid.origin[1] = start;
      // Cloth of 25 mm about a rod 3 mm wide, which stands 0.1 m high.
      scene.colliders = {tests::body_of(tests::box({0.0015, 0.1, 0.0015}), 0.3)};
      scene.colliders[0].offset = kOffset;
      EXPECT_EQ(tells(scene, "pass through cloth", 24), start < 0.1) << int(method);
    }
  }
}

}  // namespace
}  // namespace weft
