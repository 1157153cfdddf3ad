// Scenes far from zero are simulated as finely as those near it: about an origin of their own.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "folder.h"
#include "weft/output.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr Vec3 kFar{4000, 200, -7000}, kFarther{-9000, 9000, 5000};

// A sheet with a moving pin, a keyed ball and a wall, that a hand pulls, cuts and pushes about.
Scene busy_scene(Method method) {
  Scene scene;
  Cloth cloth;
  cloth.grid = {24, 20, {0.25, 1, 0}, {1, 0, 0}, {0, 0, 0.8}, 1e-3};
  cloth.pins = {{0, 0, {}}, {23, 0, {{0, {1.25, 1, 0}}, {0.5, {1, 1, 0.25}}}}};
  cloth.self_collision.mode = SelfCollisionMode::particles;
  scene.cloths = {cloth};
  scene.solver.method = method;
  scene.colliders = {{Sphere{{0.75, 0.5, 0.5}, 0.2},
                      {},
                      0.01,
                      {{0, {0.75, 0.5, 0.5}}, {1, {0.5, 0.75, 0.5}}},
                      false},
                     {Plane{{0, 0.25, 0}, {0, 1, 0}}, {}, 0.01, {}, false},
                     {Capsule{{0, 0.5, 1}, {1, 0.5, 1}, 0.1}, {}, 0.01, {}, false}};
  return scene;
}

Simulation after_a_busy_second(Method method, const Vec3& where) {
  Simulation simulation(moved(busy_scene(method), where));
  for (int frame = 0; frame < 60; ++frame) {
    if (frame == 10) simulation.grab(0, 19 * 24 + 12, plus(where, {0.75, 1.5, 1}));
    if (frame == 30) simulation.release();
    if (frame == 35) simulation.move_collider(2, plus(where, {0.25, 0.75, 0.75}));
    if (frame == 45) {
      const std::vector<double> x = simulation.positions();
      const auto at = [&](int i, int j) {
        const double* const p = x.data() + 3 * (j * 24 + i);
        return Vec3{p[0], p[1], p[2]};
      };
      EXPECT_GT(simulation.cut(at(6, 8), at(9, 8), 0.01), 0);
    }
    simulation.advance_frame();
  }
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  return simulation;
}

class Origin : public testing::TestWithParam<Method> {};

TEST_P(Origin, TheSameBitsWhereverFarAway) {
  const Simulation a = after_a_busy_second(GetParam(), kFar);
  const Simulation b = after_a_busy_second(GetParam(), kFarther);
  EXPECT_EQ(a.hash(), b.hash());
  const std::vector<double> x = a.positions(), y = b.positions();
  for (std::size_t n = 0; n < x.size(); ++n)
    ASSERT_NEAR(x[n] - kFar[n % 3], y[n] - kFarther[n % 3], 1e-11);
  EXPECT_LT(a.report().penetration.collider_max, 1e-3);
}

TEST_P(Origin, MovesAsNearZero) {
  constexpr double kError = 3e-5;  // m; that of springs against the double reference is 6e-5
  Scene scene = read_scene("swing").scene;
  scene.solver.method = GetParam();
  Simulation near(scene), far(moved(scene, kFar));
  for (int frame = 0; frame < 30; ++frame) {
    near.advance_frame();
    far.advance_frame();
  }
  const std::vector<double> x = near.positions(), y = far.positions();
  double squares = 0;
  for (std::size_t n = 0; n < x.size(); ++n) squares += std::pow(x[n] - (y[n] - kFar[n % 3]), 2);
  EXPECT_LT(std::sqrt(3 * squares / double(x.size())), kError);
  const Report here = near.report(), there = far.report();
  EXPECT_NEAR(there.energy.kinetic, here.energy.kinetic, 1e-4);
  EXPECT_NEAR(there.energy.elastic, here.energy.elastic, 1e-4);
  const double mass = 0.3 * (1022.0 / 1024);  // that can move
  EXPECT_NEAR(there.energy.gravity - here.energy.gravity, mass * 9.81 * kFar[1], 1e-4);
  EXPECT_NEAR(there.angular_momentum[2] - here.angular_momentum[2],
              kFar[0] * there.momentum[1] - kFar[1] * there.momentum[0], 0.1);
}

// Positions of some meters round by so much that stiff springs would make motion of it.
TEST_P(Origin, SomeMetersAwayMakeNoMotion) {
  if (GetParam() == Method::positional) return;
  Scene scene;
  scene.time.substeps = kAutoSubsteps;
  scene.solver.method = GetParam();
  scene.cloths.emplace_back();
  scene.cloths[0].grid = {20, 20, {0, 0, 0}, {1, 0, 0}, {0, -1, 0}, 0};
  scene.cloths[0].density = 0.1;
  scene.cloths[0].stiffness = {1e5, 1e5, 2e4};
  for (int i = 0; i < 20; ++i) scene.cloths[0].pins.push_back({i, 0, {}});
  const auto motion = [&](const Vec3& where) {
    Simulation simulation(moved(scene, where));
    for (int frame = 0; frame < 20; ++frame) simulation.advance_frame();
    return simulation.report().energy.kinetic;
  };
  const double near = motion({});
  for (const Vec3& where : {Vec3{3, 0, 0}, Vec3{0, 5, 0}, Vec3{7, 7, 0}, Vec3{20, 1, -6}})
    EXPECT_LT(motion(where), 2 * near + 1e-7) << where[0];
}

INSTANTIATE_TEST_SUITE_P(, Origin,
                         testing::Values(Method::spring, Method::positional, Method::compliant));

TEST(OriginOf, ASceneIsShownAsItWasGiven) {
  const Scene scene = moved(busy_scene(Method::spring), kFar);
  Simulation simulation(scene);
  EXPECT_EQ(simulation.scene(), scene);
  const View view = simulation.view();
  EXPECT_EQ(view.origin, (Vec3{4001, 201, -7000}));
  EXPECT_NEAR(view.origin[0] + view.cloths[0].x[0], 4000.25, 1e-6);
  simulation.move_collider(2, plus(kFar, {0, 1, 1}));
  simulation.advance_frame();
  EXPECT_EQ(simulation.scene().colliders[2].keys.back().position, plus(kFar, {0, 1, 1}));
  EXPECT_EQ(Simulation(busy_scene(Method::spring)).view().origin, Vec3{});
}

TEST(OriginOf, SnapshotsAndStatesGoFromOneToAnother) {
  Simulation far(moved(busy_scene(Method::spring), kFar));
  for (int frame = 0; frame < 20; ++frame) far.advance_frame();
  Simulation again(moved(busy_scene(Method::spring), kFar));
  again.restore(far.snapshot());
  EXPECT_EQ(again.hash(), far.hash());
  again.set_state(far.positions(), far.velocities());
  EXPECT_EQ(again.hash(), far.hash());
  // A cloth that is to start elsewhere stays where it is, and as fine, until it starts anew.
  const std::vector<double> x = far.positions();
  far.set_scene(busy_scene(Method::spring));
  EXPECT_EQ(far.positions(), x);
  EXPECT_EQ(far.scene(), busy_scene(Method::spring));
  // A snapshot of a scene somewhere else is put where it was, as finely.
  Simulation near(busy_scene(Method::spring));
  near.restore(again.snapshot());
  EXPECT_EQ(near.positions(), x);
  EXPECT_EQ(near.scene().cloths, busy_scene(Method::spring).cloths);  // paths are the snapshot's
  EXPECT_EQ(near.hash(), again.hash());
}

TEST(OriginOf, FilesTellWhereThingsStand) {
  const Folder folder;
  const Simulation simulation(moved(busy_scene(Method::spring), kFar));
  for (const char* name : {"a.pc2", "a.mdd", "a.gltf", "a.obj"}) {
    const auto animation = open_animation(folder / name, simulation.view());
    animation->append(simulation.view());
    animation->append(simulation.view());
    animation->finish();
  }
  const std::string pc2 = folder.read("a.pc2");
  float x = 0;
  std::memcpy(&x, pc2.data() + 32, sizeof x);
  EXPECT_EQ(x, 4000.25F);
  const std::string mdd = folder.read("a.mdd");
  std::uint32_t bits = 0;
  for (std::size_t byte = 16; byte < 20; ++byte)
    bits = bits << 8 | static_cast<unsigned char>(mdd[byte]);
  EXPECT_EQ(std::bit_cast<float>(bits), 4000.25F);
  EXPECT_NE(folder.read("a_0000.obj").find("\nv 4000.25 "), std::string::npos);
  EXPECT_NE(folder.read("a.gltf").find("\"translation\":[4001.0,201.0,-7000.0]"),
            std::string::npos);
}

}  // namespace
}  // namespace weft
