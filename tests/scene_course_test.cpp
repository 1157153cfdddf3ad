// Course files as students write them: keys of their own, several bodies, pins that repeat. What is
// meant is read, what is ignored is told, and a slip of the pen stays a fault.
#include <gtest/gtest.h>

#include <algorithm>

#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

bool tells(const SceneFile& file, const std::string& place) {
  return std::any_of(file.notes.begin(), file.notes.end(),
                     [&](const std::string& note) { return note.starts_with(place + " "); });
}

std::string faults_of(const SceneFile& file) {
  std::string text;
  for (const Fault& f : file.faults) text += f.place + ": " + f.what + "\n";
  return text;
}

const std::string kCloth = R"("cloth": {"width": 1, "height": 1, "num_width_points": 10,
  "num_height_points": 12, "pinned": [[0, 0], [9, 0]]})";

SceneFile with_bodies(const std::string& bodies, const std::vector<Override>& overrides = {}) {
  return read_scene_text("{" + kCloth + ", " + bodies + "}", overrides);
}

TEST(CourseFile, KeysOfItsOwnAreIgnoredAndTold) {
  const SceneFile file = read_scene_text(R"({
    "cloth": {"width": 2, "height": 1, "depth": 3, "num_width_points": 20, "num_height_points": 10,
      "thickness": 0.01, "orientation": 0, "ks": 700, "color": [1, 0, 0], "wind": {"x": [1, [2]]}},
    "sphere": {"origin": [0, 1, 0], "radius": 0.3, "friction": 0.1, "pinned": [[1, 2]], "mass": 3},
    "plane": {"point": [0, 0, 0], "normal": [0, 1, 0], "friction": 0.4, "a/b~c": null}})");
  EXPECT_EQ(faults_of(file), "");
  for (const char* place : {"/cloth/depth", "/cloth/color", "/cloth/wind", "/sphere/pinned",
                            "/sphere/mass", "/plane/a~1b~0c"})
    EXPECT_TRUE(tells(file, place)) << place;
  EXPECT_EQ(file.notes.size(), 6u);
  EXPECT_EQ(file.scene.cloths[0].stiffness.structural, 700);
  ASSERT_EQ(file.scene.colliders.size(), 2u);
  EXPECT_EQ(std::get<Sphere>(file.scene.colliders[0].shape).radius, 0.3);
  EXPECT_TRUE(file.scene.cloths[0].pins.empty());
  Simulation(file.scene).advance_frame();
}

// The same bodies, however they are written.
TEST(CourseFile, ListsPluralsAndNumbersAreSeveralBodies) {
  const std::string a = R"({"origin": [0, 0.2, 0], "radius": 0.1, "friction": 0.3})",
                    b = R"({"origin": [1, 0.4, 1], "radius": 0.25, "friction": 0})",
                    p = R"({"point": [0, -1, 0], "normal": [0, 1, 0], "friction": 0.5})",
                    q = R"({"point": [2, 0, 0], "normal": [-1, 0, 0], "friction": 0.1})";
  const std::string written[] = {
      "\"sphere\": [" + a + ", " + b + "], \"plane\": [" + p + ", " + q + "]",
      "\"spheres\": [" + a + ", " + b + "], \"planes\": [" + p + ", " + q + "]",
      "\"sphere0\": " + a + ", \"sphere1\": " + b + ", \"plane0\": " + p + ", \"plane1\": " + q,
      "\"sphere_1\": " + a + ", \"sphere_2\": " + b + ", \"plane-1\": " + p + ", \"plane-2\": " + q,
      "\"sphere\": " + a + ", \"sphere2\": " + b + ", \"plane\": " + p + ", \"plane2\": " + q,
      "\"sphere\": " + a + ", \"spheres\": [" + b + "], \"plane\": [" + p + "], \"planes\": " + q,
      "\"sphere1\": [" + a + "], \"sphere2\": [" + b + "], \"plane\": " + p + ", \"plane 9\": " + q,
  };
  for (const std::string& text : written) {
    const SceneFile file = with_bodies(text);
    EXPECT_EQ(faults_of(file), "") << text;
    EXPECT_TRUE(file.notes.empty()) << text;
    ASSERT_EQ(file.scene.colliders.size(), 4u) << text;
    EXPECT_EQ(file.scene.colliders, with_bodies(written[0]).scene.colliders) << text;
  }
  const Scene scene = with_bodies(written[0]).scene;
  EXPECT_EQ(std::get<Sphere>(scene.colliders[1].shape).center, (Vec3{1, 0.4, 1}));
  EXPECT_EQ(scene.colliders[3].friction, (Friction{FrictionModel::course, 0.1, 0.1}));
  EXPECT_EQ(scene.colliders[2].offset, 1e-4);
  EXPECT_EQ(with_bodies("\"sphere\": [], \"plane\": []").scene.colliders.size(), 0u);
}

TEST(CourseFile, FaultsAndOverridesOfEveryBodyHaveItsPlace) {
  EXPECT_EQ(faults_of(with_bodies(R"("sphere": [{"radius": 1}, {"radius": -1}], "sphere7": 5,
      "planes": [{"normal": [0, 0, 0]}], "plane2": {"friction": 2, "norml": [0, 1, 0]})")),
            "/sphere/1/radius: radius is -1\n"
            "/sphere7: sphere is 5\n"
            "/plane2/friction: friction is 2\n"
            "/plane2/norml: unknown key \"norml\"\n"
            "/planes/0/normal: normal is zero\n");
  const std::string bodies = R"("sphere": [{"radius": 1}, {"radius": 2}], "plane0": {})";
  const SceneFile changed = with_bodies(
      bodies, {{"/sphere/1/radius", "3"}, {"/plane0/point", "[0, 5, 0]"}, {"/cloth/ks", "9"}});
  EXPECT_EQ(faults_of(changed), "");
  EXPECT_EQ(std::get<Sphere>(changed.scene.colliders[1].shape).radius, 3);
  EXPECT_EQ(std::get<Plane>(changed.scene.colliders[2].shape).point, (Vec3{0, 5, 0}));
  EXPECT_EQ(changed.scene.cloths[0].stiffness.structural, 9);
  EXPECT_EQ(faults_of(with_bodies(bodies, {{"/sphere/1/radus", "3"}})),
            "/sphere/1/radus: there is no \"radus\" to override\n");
  EXPECT_EQ(faults_of(with_bodies(bodies, {{"/sphere/0/radius", "big"}})),
            "/sphere/0/radius: radius is \"big\"\n");
}

TEST(CourseFile, PinsThatRepeatHoldOnce) {
  const SceneFile file = read_scene_text(R"({"cloth": {"num_width_points": 10,
      "num_height_points": 12, "pinned": [[0, 0], [9, 0], [0, 0], [9.0, 0], [3, 4], [0, 0]]}})");
  EXPECT_EQ(faults_of(file), "");
  EXPECT_TRUE(tells(file, "/cloth/pinned"));
  ASSERT_EQ(file.scene.cloths[0].pins.size(), 3u);
  EXPECT_EQ(file.scene.cloths[0].pins[2], (Pin{3, 4, {}}));
  Simulation(file.scene).advance_frame();
  // Places are those of the file, behind repetitions too.
  EXPECT_EQ(faults_of(read_scene_text(R"({"cloth": {"num_width_points": 10,
      "num_height_points": 12, "pinned": [[0, 0], [0, 0], [1, 1], [1, 1], [10, 3], [2, "x"]]}})")),
            "/cloth/pinned/5/1: pinned[5][1] is \"x\"\n"
            "/cloth/pinned/4: the pin [10, 3] is outside of the grid\n");
}

// A default must not take the place of a value that was misspelt.
TEST(CourseFile, SlipsOfThePenAreFaults) {
  for (const char* text :
       {R"({"cloth": {"kss": 5}})", R"({"cloth": {"Ks": 5}})", R"({"cloth": {"widht": 2}})",
        R"({"cloth": {"num_width_point": 20}})", R"({"cloth": {"dampng": 1}})",
        R"({"cloth": {}, "sphere": {"radios": 1}})",
        R"({"cloth": {}, "sphere": {"center": [0,0,0]}})", R"({"cloth": {}, "spher": {}})",
        R"({"cloth": {}, "sphere2x": {}})", R"({"cloth": {}, "cylinder": {}})",
        R"({"cloths": {}, "sphere0": {}})", R"({"cloth": {}, "plane0": {"piont": [0,0,0]}})",
        R"({"cloth": [], "sphere": [[]]})", R"({"cloth": {}, "sphere": [null]})",
        R"({"cloth": {}, "sphere1": "big"})"})
    EXPECT_FALSE(read_scene_text(text).faults.empty()) << text;
  // Beside the right key, one that resembles it is a key of the file's own.
  EXPECT_EQ(faults_of(read_scene_text(R"({"cloth": {"ks": 5, "kss": 5}})")), "");
}

TEST(CourseFile, ManyBodiesAndManyOddKeysAreBounded) {
  std::string bodies = "\"spheres\": [{}", keys = R"("sphere": {"x": 0)";
  for (int n = 0; n < 2000; ++n) bodies += ", {}";
  EXPECT_LE(with_bodies(bodies + "]").scene.colliders.size(), 1001u);
  EXPECT_FALSE(validate(with_bodies(bodies + "]").scene).empty());
  for (int n = 0; n < 900; ++n) keys += ", \"own key " + std::to_string(n) + "\": [1]";
  const SceneFile file = with_bodies(keys + "}");
  EXPECT_EQ(faults_of(file), "");
  EXPECT_LE(file.notes.size(), 21u);
  EXPECT_GE(file.notes.size(), 20u);
}

}  // namespace
}  // namespace weft
