// Scenes with meshes of all formats, and files that are broken: any bytes are read or refused.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "folder.h"
#include "made_up_gltf.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using Json = text::Json;

// Scenes take them for cloth, for shapes at rest and for bodies.
TEST(MeshFormats, ScenesNameThem) {
  const Folder folder;
  folder.write("sheet.ply", Ply(Order::little, "float", "int").write(false, false));
  Json document = triangle(nullptr);
  folder.write("leaf.gltf", document.dump());
  const SceneFile file = read_scene(folder.write("scene.json", R"({"weft": 1,
      "cloths": [{"mesh": {"file": "sheet.ply", "rest": "sheet.ply", "translate": [0, 1, 0]}},
                 {"mesh": {"file": "leaf.gltf"}, "pins": [{"group": "leaf"}]}],
      "colliders": [{"mesh": {"file": "leaf.gltf"}, "offset": 0.01}]})"));
  ASSERT_TRUE(file.faults.empty()) << file.faults[0].place << ": " << file.faults[0].what;
  Simulation run(file.scene, {.threads = 1});
  run.advance_frame();
  EXPECT_TRUE(run.status().ok);
  const SceneFile wrong = read_scene(folder.write("wrong.json", R"({"weft": 1,
      "cloths": [{"mesh": {"file": "none.ply"}}]})"));
  ASSERT_EQ(wrong.faults.size(), 1u);
  EXPECT_EQ(wrong.faults[0].place, "/cloths/0/mesh/file");
  EXPECT_EQ(wrong.faults[0].what, (folder / "none.ply") + ": there is no such mesh file");
}

std::string broken(std::string bytes, std::mt19937& random) {
  const std::vector<std::string> words = {"0",    "-1",    "1e9",    "nan",   "4294967295",
                                          "list", "uint",  "double", "1e400", "[0,0]",
                                          "null", "\"a\"", "{}",     "5126",  "3"};
  for (auto k = random() % 4; k > 0 && !bytes.empty(); --k) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 5) {
      case 0:
        bytes[at] = char(random() % 256);
        break;
      case 1:
        bytes.erase(at, 1 + random() % 20);
        break;
      case 2:
        bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 30));
        break;
      case 3:
        bytes.resize(at);
        break;
      default: {
        const std::size_t end = std::min(bytes.find_first_of(" ,}]\n", at), bytes.size());
        bytes.replace(at, end - at, words[random() % words.size()]);
      }
    }
  }
  return bytes;
}

TEST(MeshFormats, AnyBytesAreReadOrRefused) {
  std::mt19937 random(1);
  std::string data;
  Json document = triangle(&data);
  Json inside = document;
  inside["buffers"][0].erase("uri");
  const std::vector<std::string> plys = {Ply(Order::text, "float", "int").write(true, true),
                                         Ply(Order::little, "double", "ushort").write(true, true),
                                         Ply(Order::big, "float", "uint").write(false, true)};
  const std::vector<std::string> gltfs = {document.dump(), glb(inside, data)};
  int read = 0, refused = 0;
  for (int n = 0; n < 24000; ++n) {
    const bool ply = n % 2 == 0;
    const auto& originals = ply ? plys : gltfs;
    const std::string bytes = broken(originals[random() % originals.size()], random);
    const std::string name = ply ? "m.ply" : "m.glb";
    const MeshFile file = ply ? read_ply(bytes, name) : read_gltf(bytes, name, "/nowhere");
    for (const Fault& fault : file.faults) {
      ASSERT_EQ(fault.place.rfind(name, 0), 0u) << bytes;
      ASSERT_FALSE(fault.what.empty() || fault.allowed.empty()) << bytes;
    }
    (file.faults.empty() ? read : refused) += 1;
    if (!file.faults.empty()) continue;
    ASSERT_FALSE(file.mesh.triangles.empty());
    ASSERT_TRUE(file.mesh.uv.empty() || file.mesh.uv.size() == file.mesh.triangles.size());
    for (const auto& t : file.mesh.triangles)
      for (const int corner : t)
        ASSERT_TRUE(corner >= 0 && std::size_t(corner) < file.mesh.vertices.size());
    for (const Vec3& p : file.mesh.vertices)
      for (const double value : p) ASSERT_TRUE(std::abs(value) <= 1e9);
  }
  EXPECT_GT(read, 3000);
  EXPECT_GT(refused, 8000);
}

// Of an arm whose forearm bends, and which a target makes thicker.
TEST(MeshFormats, AnyBytesMoveABodyOrAreRefused) {
  std::mt19937 random(2);
  Arm arm(tests::box({1, 0.2, 0.2}), 2);
  std::vector<double> thicker;
  for (const Vec3& p : arm.mesh->vertices) thicker.insert(thicker.end(), {0, p[1], p[2]});
  arm.file.primitive()["targets"].push_back({{"POSITION", arm.file.floats(thicker, "VEC3")}});
  arm.file.channel(3, "rotation", {0, 1}, joined({turn({0, 0, 1}, 0), turn({0, 0, 1}, 20)}));
  arm.file.channel(0, "weights", {0, 1}, {0, 0, 1, 0, 0, 0}, "CUBICSPLINE");
  arm.file.channel(1, "translation", {0, 0.5, 1}, {0, 0, 0, 1, 0, 0, 0, 1, 0}, "STEP");
  const std::vector<std::string> originals = {arm.file.write(), arm.file.write_glb()};
  int read = 0, refused = 0;
  for (int n = 0; n < 4000; ++n) {
    const std::string bytes = broken(originals[random() % 2], random);
    const PointCacheFile file = read_gltf_motion(bytes, "m.glb", "/nowhere", kAnyPoints);
    const MeshFile mesh = read_gltf(bytes, "m.glb", "/nowhere");
    for (const Fault& fault : file.faults) {
      ASSERT_EQ(fault.place.rfind("m.glb", 0), 0u) << bytes;
      ASSERT_FALSE(fault.what.empty() || fault.allowed.empty()) << bytes;
    }
    ASSERT_EQ(file.faults.empty(), file.cache != nullptr);
    (file.cache ? read : refused) += 1;
    if (!file.cache) continue;
    const PointCache& cache = *file.cache;
    ASSERT_TRUE(mesh.faults.empty());
    ASSERT_EQ(std::size_t(cache.points), mesh.mesh.vertices.size());
    ASSERT_EQ(cache.places.size(), std::size_t(cache.points) * cache.times.size());
    for (std::size_t k = 1; k < cache.times.size(); ++k)
      ASSERT_GT(cache.times[k], cache.times[k - 1]);
    for (const PointCache::Place& place : cache.places)
      for (const float value : place) ASSERT_TRUE(std::abs(value) <= 1e9F);
  }
  EXPECT_GT(read, 500);
  EXPECT_GT(refused, 1500);
}

}  // namespace
}  // namespace weft
