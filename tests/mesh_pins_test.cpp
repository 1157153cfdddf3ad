// Pins of several particles: by number, by group of the file, by box, on paths that count from where each
// starts; the same as pins of one.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "folder.h"
#include "weft/mesh.h"
#include "weft/read_scene.h"
#include "weft/recording.h"
#include "weft/simulation.h"

namespace weft {
namespace {

// 5 × 4 vertices 0.1 m apart, number 5 j + i at (0.1 i, 0, 0.1 j); the faces of the first row are the
// group "hem", the last square that of "tip".
std::string sheet() {
  std::string text = "o sheet\n";
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 5; ++i)
      text += "v " + std::to_string(0.1 * i) + " 0 " + std::to_string(0.1 * j) + "\n";
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i) {
      if (i == 0) text += j == 0 ? "g hem\n" : "g body\n";
      if (j == 2 && i == 3) text += "g tip\n";
      const int a = 5 * j + i + 1;
      text += "f " + std::to_string(a) + " " + std::to_string(a + 5) + " " + std::to_string(a + 6) +
              " " + std::to_string(a + 1) + "\n";
    }
  return text;
}

class MeshPins : public testing::Test {
 protected:
  MeshPins() { std::ofstream(folder_ / "sheet.obj") << sheet(); }
  SceneFile read(const std::string& pins,
                 const std::string& cloth = R"("mesh": {"file": "sheet.obj"})") {
    std::ofstream(folder_ / "s.json")
        << R"({"weft": 1, "cloths": [{)" << cloth << R"(, "pins": )" << pins
        << R"(}], "colliders": [{"sphere": {"center": [3, 0, 0]}, "keys": [[0, 3, 0, 0], [1, 3, 1, 0]]}]})";
    return read_scene(folder_ / "s.json");
  }
  std::uint64_t hash(const std::string& pins,
                     const std::string& cloth = R"("mesh": {"file": "sheet.obj"})") {
    const SceneFile file = read(pins, cloth);
    EXPECT_TRUE(file.faults.empty()) << file.faults[0].place << ": " << file.faults[0].what;
    if (!file.faults.empty()) return 0;
    Simulation run(file.scene, {.threads = 1});
    for (int n = 0; n < 10; ++n) run.advance_frame();
    return run.hash();
  }
  std::string fault(const std::string& pins,
                    const std::string& cloth = R"("mesh": {"file": "sheet.obj"})") {
    std::string all;
    for (const Fault& f : read(pins, cloth).faults)
      all += f.place + ": " + f.what + " (" + f.allowed + ")\n";
    return all;
  }
  Folder folder_;
};

const std::string kGrid = R"("grid": {"points": [5, 4], "u": [0.4, 0, 0], "v": [0, 0, 0.3]})";

TEST_F(MeshPins, HoldTheSameAsPinsOfOne) {
  const std::uint64_t tip = hash("[13, 14, 18, 19]");
  EXPECT_NE(tip, hash("[13, 14, 18]"));
  EXPECT_EQ(tip, hash(R"([{"vertices": [19, 13, 18, 14]}])"));
  EXPECT_EQ(tip, hash(R"([{"group": "tip"}])"));
  EXPECT_EQ(tip, hash(R"([{"box": [[0.41, -1, 0.31], [0.29, 1, 0.19]]}])"));
  EXPECT_EQ(hash("[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]"), hash(R"([{"group": "hem"}])"));
  EXPECT_EQ(hash("[[0, 0], [1, 0], [4, 3]]", kGrid),
            hash(R"([{"box": [[-0.01, 0, 0], [0.11, 0, 0]]}, {"vertices": [19]}])", kGrid));
}

TEST_F(MeshPins, KeysCountFromWhereEachStarts) {
  EXPECT_EQ(hash(R"([{"at": 0, "keys": [[0, 0, 0, 0], [0.1, 0, 0.5, 0]]},
                     {"at": 4, "keys": [[0, 0.4, 0, 0], [0.1, 0.4, 0.5, 0]]}])"),
            hash(R"([{"vertices": [0, 4], "keys": [[0, 0, 0, 0], [0.1, 0, 0.5, 0]]}])"));
}

TEST_F(MeshPins, TurnAndFollowAsOne) {
  const std::string motion =
      R"("rotate": {"axis": [0, 1, 0], "about": [0.35, 0, 0.25], "keys": [[0, 0], [0.1, 30]]}, "follow": 0)";
  EXPECT_EQ(hash(R"([{"at": 13, )" + motion + R"(}, {"at": 14, )" + motion + R"(}, {"at": 18, )" +
                 motion + R"(}, {"at": 19, )" + motion + "}]"),
            hash(R"([{"group": "tip", )" + motion + "}]"));
}

TEST_F(MeshPins, AreAlikeFarAway) {
  const std::string far = R"("mesh": {"file": "sheet.obj", "translate": [100, 0, 0]})";
  EXPECT_EQ(hash("[13, 14, 18, 19]", far),
            hash(R"([{"box": [[100.29, -1, 0.19], [101, 1, 1]]}])", far));
  const SceneFile file = read(R"([{"box": [[100.29, -1, 0.19], [101, 1, 1]]}])", far);
  EXPECT_EQ(Simulation(file.scene, {.threads = 1}).scene(), file.scene);
}

TEST_F(MeshPins, FaultsAreNamed) {
  EXPECT_EQ(fault(R"([{"group": "collar"}])"),
            "/cloths/0/pins/0/group: the mesh has no group \"collar\" (\"body\", \"hem\", "
            "\"sheet\", \"tip\")\n");
  EXPECT_EQ(fault(R"([0, {"box": [[1, 0, 0], [2, 1, 1]]}])"),
            "/cloths/0/pins/1/box: no particle starts in the box (corners of a box, in m, with at "
            "least one in it)\n");
  EXPECT_EQ(fault(R"([{"group": "hem"}, {"vertices": [13, 7]}])"),
            "/cloths/0/pins/1: the vertex 7 is pinned twice (once; it is held by "
            "/cloths/0/pins/0)\n");
  EXPECT_EQ(fault(R"([{"vertices": [3, 3]}])"),
            "/cloths/0/pins/0: the vertex 3 is pinned twice (once; it is held by "
            "/cloths/0/pins/0)\n");
  EXPECT_EQ(fault(R"([{"vertices": [3, 20]}])"),
            "/cloths/0/pins/0/vertices/1: the pin 20 is no vertex of the mesh (0 to 19)\n");
  EXPECT_EQ(fault(R"([{"group": "hem"}])", kGrid),
            "/cloths/0/pins/0/group: a grid has no groups (at, vertices or box)\n");
  EXPECT_NE(fault(R"([{"vertices": []}])"), "");
  EXPECT_NE(fault(R"([{"group": "hem", "box": [[0, 0, 0], [1, 1, 1]]}])"), "");
  EXPECT_NE(fault(R"([{"keys": [[0, 0, 0, 0]]}])"), "");
  EXPECT_NE(fault(R"([{"box": [[0, 0, 0], [1, 1, "x"]]}])"), "");
}

// What would take hours to look up, or all memory to hold, is refused.
TEST_F(MeshPins, HoldAndNameSoMuch) {
  Scene scene;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {1024, 1024, {}, {1, 0, 0}, {0, 0, 1}, 0};
  Pin corner;
  corner.box = BoxCorners{Vec3{}, Vec3{}};
  cloth.pins.assign(1025, corner);
  std::vector<Fault> faults = validate(scene);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].what, "the pins' boxes and groups are 1074790400 to be looked up");
  cloth.pins.assign(1, corner);
  EXPECT_TRUE(validate(scene).empty());
  cloth.pins[0].box = BoxCorners{Vec3{}, Vec3{1, 0, 1}};
  cloth.pins[0].keys = {{0, {}}, {1, {}}, {2, {}}, {3, {}}};
  EXPECT_TRUE(validate(scene).empty());
  cloth.pins[0].keys.push_back({4, {}});
  faults = validate(scene);
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_EQ(faults[0].what,
            "with this pin, pins of several hold particles by 5242880 keys, each counted for each "
            "particle");
}

TEST_F(MeshPins, AreWrittenAsTheyAreRead) {
  const SceneFile file = read(
      R"([1, {"vertices": [3]}, {"group": "tip", "keys": [[0, 0, 0, 0]]}, {"box": [[0, 0, 0], [0, 0, 0]], "follow": 0}])");
  ASSERT_TRUE(file.faults.empty()) << file.faults[0].what;
  EXPECT_EQ(read_scene_text(write_scene_text(file.scene)).scene.cloths[0].pins,
            file.scene.cloths[0].pins);
}

TEST_F(MeshPins, ChangeWhileTheClothMoves) {
  Simulation run(read(R"([{"group": "tip"}])").scene, {.threads = 1});
  for (int n = 0; n < 5; ++n) run.advance_frame();
  const std::vector<double> before = run.positions();
  run.set_scene(read(R"([{"vertices": [0, 13]}])").scene);
  for (int n = 0; n < 5; ++n) run.advance_frame();
  const std::vector<double> after = run.positions();
  const auto moved = [&](std::size_t p) {
    return before[3 * p] != after[3 * p] || before[3 * p + 1] != after[3 * p + 1];
  };
  EXPECT_FALSE(moved(0));
  EXPECT_FALSE(moved(13));
  EXPECT_TRUE(moved(19));
}

TEST_F(MeshPins, NameGroupsOfFilesInCapitals) {
  std::ofstream(folder_ / "SHEET.OBJ") << sheet();
  EXPECT_EQ(hash(R"([{"group": "tip"}])"),
            hash(R"([{"group": "tip"}])", R"("mesh": {"file": "SHEET.OBJ"})"));
}

TEST_F(MeshPins, AreRecorded) {
  const SceneFile file = read(R"([{"group": "tip", "keys": [[0, 0, 0, 0], [0.1, 0, 0.2, 0]]}])");
  Simulation run(file.scene, {.threads = 1});
  Recorder recorder(folder_ / "a.rec", run);
  for (int n = 0; n < 3; ++n) {
    run.advance_frame();
    recorder.frame(run);
  }
  recorder.finish();
  const Recording recording = read_recording(folder_ / "a.rec");
  Simulation again(recording.scene, {.threads = 1});
  for (int n = 0; n < 3; ++n) again.advance_frame();
  EXPECT_EQ(again.hash(), run.hash());
}

}  // namespace
}  // namespace weft
