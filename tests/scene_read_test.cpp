// Reading scenes: both formats, the shipped scenes, overrides, and writing them back.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "weft/read_scene.h"

namespace {

using weft::Override;
using weft::read_scene;
using weft::read_scene_text;
using weft::Scene;

std::string told(const std::vector<weft::Fault>& faults) {
  std::string text;
  for (const auto& fault : faults)
    text += fault.place + ": " + fault.what + " (" + fault.allowed + ")\n";
  return text;
}

// The scene of a text that has no faults.
Scene good(const std::string& text, const std::vector<Override>& overrides = {}) {
  const weft::SceneFile file = read_scene_text(text, overrides);
  EXPECT_EQ(told(file.faults), "") << text;
  return file.scene;
}

Scene shipped(const std::string& name, const std::vector<Override>& overrides = {}) {
  const weft::SceneFile file = read_scene(name, overrides);
  EXPECT_EQ(told(file.faults), "") << name;
  return file.scene;
}

TEST(ShippedScenes, ReadWithoutFaultAndSurviveWriting) {
  const auto scenes = weft::shipped_scenes();
  EXPECT_GE(scenes.size(), 19u);
  for (std::size_t k = 1; k < scenes.size(); ++k) EXPECT_LT(scenes[k - 1].name, scenes[k].name);
  for (const auto& entry : scenes) {
    SCOPED_TRACE(entry.name);
    const Scene scene = shipped(entry.name);
    EXPECT_EQ(scene.name, entry.name);
    EXPECT_EQ(scene.about, entry.about);
    EXPECT_FALSE(entry.about.empty());
    EXPECT_EQ(told(weft::validate(scene)), "");
    EXPECT_EQ(good(weft::write_scene_text(scene)), scene);
  }
}

TEST(ShippedScenes, AreLookedForInTheChosenFolderFirst) {
  const auto folder = std::filesystem::temp_directory_path() / "weft_no_scenes";
  std::filesystem::create_directories(folder);
  ASSERT_EQ(setenv("WEFT_SCENES", folder.c_str(), 1), 0);
  EXPECT_TRUE(weft::shipped_scenes().empty());
  EXPECT_FALSE(read_scene("swing").found);
  ASSERT_EQ(unsetenv("WEFT_SCENES"), 0);
  EXPECT_TRUE(read_scene("swing").found);
  const std::string path = read_scene("swing").path;
  EXPECT_EQ(read_scene(path).scene, read_scene("swing").scene);
}

TEST(Weft, BendingIsOneNumberOrOneForEachDirection) {
  const auto read = [](const std::string& bending) {
    return weft::read_scene_text(R"({"weft": 1, "cloths": [{"bending": )" + bending + "}]}");
  };
  EXPECT_EQ(read("2e-5").scene.cloths[0].bending, weft::Bending(2e-5));
  const weft::SceneFile file = read(R"({"warp": 1e-5, "twist": 3e-6, "damping": 0.01})");
  ASSERT_EQ(file.faults.size(), 1u);  // a grid bends alike in all directions
  weft::Scene scene = file.scene;
  weft::Bending expected(1e-5);
  expected.weft = 0, expected.twist = 3e-6, expected.damping = 0.01;
  EXPECT_EQ(scene.cloths[0].bending, expected);
  scene.cloths[0].membrane = {5000, 4000, -300, 50, 1e-4};
  EXPECT_EQ(weft::read_scene_text(weft::write_scene_text(scene)).scene, scene);
}

TEST(Course, MeansWhatTheCourseSays) {
  const Scene scene = shipped("pinned2");
  EXPECT_EQ(scene.gravity, (weft::Vec3{0, -9.8, 0}));
  EXPECT_EQ(scene.time.frame, 1.0 / 90);
  EXPECT_EQ(scene.time.substeps, 30);
  ASSERT_EQ(scene.cloths.size(), 1u);
  const weft::Cloth& cloth = scene.cloths[0];
  EXPECT_DOUBLE_EQ(spacing_u(cloth.grid), 0.02);
  EXPECT_DOUBLE_EQ(spacing_v(cloth.grid), 0.02);
  EXPECT_EQ(cloth.grid.origin, (weft::Vec3{0, 1, 0}));
  EXPECT_EQ(cloth.grid.v[1], 0);
  EXPECT_EQ(cloth.grid.jitter, 0);
  EXPECT_DOUBLE_EQ(particle_mass(cloth, 3, 4), 0.06);
  EXPECT_EQ(cloth.stiffness, (weft::Kinds{5000, 5000, 1000}));
  const double dt = scene.time.frame / scene.time.substeps;
  EXPECT_DOUBLE_EQ(1 - dt * cloth.drag, 1 - 0.2 / 100);
  EXPECT_EQ(cloth.strain_limit, 0.1);
  EXPECT_EQ(cloth.self_collision.mode, weft::SelfCollisionMode::particles);
  EXPECT_EQ(cloth.strain_limit_order, weft::StrainLimitOrder::strict);
  EXPECT_EQ(cloth.self_collision.response, weft::SelfCollisionResponse::course);
  EXPECT_DOUBLE_EQ(cloth.self_collision.thickness, 0.019);
  ASSERT_EQ(cloth.pins.size(), 2u);
  EXPECT_EQ(cloth.pins[1].i, 49);
  EXPECT_EQ(cloth.pins[1].j, 0);
}

TEST(Course, UprightSheetIsRoughAndCollidersHaveTheCourseFriction) {
  const Scene scene = shipped("selfCollision");
  const weft::Grid& grid = scene.cloths[0].grid;
  EXPECT_EQ(grid.origin, (weft::Vec3{0, 0, 0}));
  EXPECT_EQ(grid.jitter, 0.001);
  EXPECT_DOUBLE_EQ(grid.v[1], 0.98);
  ASSERT_EQ(scene.colliders.size(), 1u);
  EXPECT_EQ(scene.colliders[0].offset, 1e-4);
  EXPECT_EQ(scene.colliders[0].friction, (weft::Friction{weft::FrictionModel::course, 0.5, 0.5}));
  const Scene ball = shipped("sphere");
  EXPECT_EQ(std::get<weft::Sphere>(ball.colliders[0].shape), (weft::Sphere{{0.5, 0.2, 0.5}, 0.2}));
  EXPECT_EQ(ball.colliders[0].offset, 0);
}

TEST(Course, SpringsCanBeTurnedOff) {
  const Scene scene =
      good(R"({"cloth": {"enable_structural": false, "enable_bending": false, "ks": 7}})");
  EXPECT_EQ(scene.cloths[0].stiffness, (weft::Kinds{0, 7, 0}));
}

TEST(WeftScene, MinimalOneIsTheDefaultScene) {
  Scene expected;
  expected.cloths.emplace_back();
  EXPECT_EQ(good(R"({"weft": 1, "cloths": [{}]})"), expected);
}

TEST(WeftScene, ReadsTheFormsOfTheContract) {
  const Scene scene = good(R"({"weft": 1,
    "time": {"frame": 0.016667, "substeps": 20},
    "solver": {"method": "compliant", "sweep": "line", "tethers": true, "order": 2},
    "cloths": [{"grid": {"points": [3, 4]},
      "pins": [[2,3], {"at": [0,1], "keys": [[0, 1,2,3], [2, 4,5,6]]}]}],
    "colliders": [
      {"sphere": {"center": [1,2,3], "radius": 4}, "friction": 0.3, "keys": [[0, 1,2,3]]},
      {"plane": {"point": [0,-1,0]}, "friction": {"static": 0.5, "dynamic": 0.4}},
      {"capsule": {"a": [0,0,1], "b": [0,0,2], "radius": 3}, "friction": {"course": 0.25}},
      {"box": {"half": [1,2,3], "rotation": [0,45,0], "rounding": 0.5}, "cuts": true}]})");
  EXPECT_EQ(scene.time.substeps, 20);
  EXPECT_EQ(scene.solver.method, weft::Method::compliant);
  EXPECT_EQ(scene.solver.sweep, weft::Sweep::line);
  EXPECT_EQ(scene.cloths[0].grid.nx, 3);
  EXPECT_EQ(scene.cloths[0].pins[0], (weft::Pin{2, 3, {}}));
  EXPECT_EQ(scene.cloths[0].pins[1], (weft::Pin{0, 1, {{0, {1, 2, 3}}, {2, {4, 5, 6}}}}));
  EXPECT_EQ(scene.colliders[0].friction, (weft::Friction{weft::FrictionModel::coulomb, 0.3, 0.3}));
  EXPECT_EQ(scene.colliders[1].friction, (weft::Friction{weft::FrictionModel::coulomb, 0.5, 0.4}));
  EXPECT_EQ(std::get<weft::Plane>(scene.colliders[1].shape).normal, (weft::Vec3{0, 1, 0}));
  EXPECT_EQ(scene.colliders[2].friction, (weft::Friction{weft::FrictionModel::course, 0.25, 0.25}));
  EXPECT_EQ(std::get<weft::Box>(scene.colliders[3].shape).rounding, 0.5);
  EXPECT_TRUE(scene.colliders[3].cuts);
  EXPECT_EQ(good(weft::write_scene_text(scene)), scene);
}

TEST(WeftScene, OneOfStaticAndDynamicFrictionStandsForBoth) {
  const auto read = [](const std::string& friction) {
    return good(R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}, "friction": )" +
                friction + "}]}")
        .colliders[0]
        .friction;
  };
  const weft::Friction both{weft::FrictionModel::coulomb, 0.5, 0.5};
  EXPECT_EQ(read("0.5"), both);
  EXPECT_EQ(read(R"({"static": 0.5})"), both);
  EXPECT_EQ(read(R"({"dynamic": 0.5})"), both);
  EXPECT_EQ(read(R"({"static": 0.5, "dynamic": 0})"),
            (weft::Friction{weft::FrictionModel::coulomb, 0.5, 0}));
  const weft::Friction damped = read(R"({"static": 0.5, "damping": 2, "bias": 0.1})");
  EXPECT_EQ(damped.dynamic, 0.5);
  EXPECT_EQ(damped.damping, 2);
}

TEST(WeftScene, NumbersSurviveWritingExactly) {
  Scene scene = good(R"({"weft": 1, "cloths": [{}]})");
  scene.gravity = {1.0 / 3, -0.0, std::nextafter(1.0, 2.0)};
  scene.cloths[0].masses = {1e-9, 0.1, 2.0 / 3, 1e6};
  scene.about = "quotes \" and \\ and ü";
  const Scene again = good(weft::write_scene_text(scene));
  EXPECT_EQ(again, scene);
  EXPECT_TRUE(std::signbit(again.gravity[1]));
}

TEST(Mass, ComesFromMassesElseParticleMassElseDensity) {
  weft::Cloth cloth;
  cloth.density = 8;
  EXPECT_DOUBLE_EQ(particle_mass(cloth, 0, 0), 2);
  cloth.particle_mass = 3;
  EXPECT_DOUBLE_EQ(particle_mass(cloth, 0, 0), 3);
  cloth.masses = {4, 5, 6, 7};
  EXPECT_DOUBLE_EQ(particle_mass(cloth, 0, 1), 6);
}

TEST(Overrides, ReplaceAndFillIn) {
  const std::string text = R"({"weft": 1, "cloths": [{}], "colliders": [{"sphere": {}}]})";
  const Scene scene = good(text, {{"/solver/iterations", "20"},
                                  {"/solver/method", "compliant"},
                                  {"/gravity/1", "-5"},
                                  {"/time/substeps", "auto"},
                                  {"/cloths/0/grid/points/0", "7"},
                                  {"/cloths/0/pins/0", "[0,0]"},
                                  {"/cloths/0/pins/-", R"({"at": [1, 0]})"},
                                  {"/colliders/0/friction/static", "0.5"},
                                  {"/about", "two words"}});
  EXPECT_EQ(scene.solver.iterations, 20);
  EXPECT_EQ(scene.solver.method, weft::Method::compliant);
  EXPECT_EQ(scene.gravity, (weft::Vec3{0, -5, 0}));
  EXPECT_EQ(scene.time.substeps, weft::kAutoSubsteps);
  EXPECT_EQ(scene.cloths[0].grid.nx, 7);
  EXPECT_EQ(scene.cloths[0].grid.ny, 2);
  EXPECT_EQ(scene.cloths[0].pins.size(), 2u);
  EXPECT_EQ(scene.colliders[0].friction.statik, 0.5);
  EXPECT_EQ(scene.about, "two words");
}

TEST(Overrides, OfACourseSceneReachTheFileAndTheSceneThatItMeans) {
  const Scene scene = shipped(
      "pinned2",
      {{"/cloth/ks", "100"}, {"/time/substeps", "60"}, {"/cloths/0/self_collision/mode", "off"}});
  EXPECT_EQ(scene.cloths[0].stiffness.structural, 100);
  EXPECT_EQ(scene.time.substeps, 60);
  EXPECT_EQ(scene.cloths[0].self_collision.mode, weft::SelfCollisionMode::off);
}

}  // namespace
