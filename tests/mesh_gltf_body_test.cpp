// Animations of glTF files as those of bodies: what is one vertex, what cloth sees, and what is wrong with one.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "folder.h"
#include "made_up_gltf.h"
#include "made_up_mesh.h"
#include "weft/output.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using Json = text::Json;

// Two halves of a ball, whose vertices along the cut are there twice: one body where both follow the same; two, where
// a target opens it.
TEST(MeshGltfBody, VerticesOfOnePlaceAreOneWhereTheyMoveAlike) {
  const auto whole = tests::ball(12, 8, 0.5);
  for (const bool opens : {false, true}) {
    TriangleMesh cut;
    std::vector<Vec3> moved;
    for (const double side : {1.0, -1.0}) {
      const int first = int(cut.vertices.size());
      for (const Vec3& p : whole->vertices) {
        cut.vertices.push_back(p);
        moved.push_back({0, opens ? 0.2 * side : 0.2, 0});
      }
      for (const auto& t : whole->triangles) {
        double middle = 0;
        for (const int corner : t) middle += whole->vertices[std::size_t(corner)][1];
        if (middle * side > 0) cut.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
      }
    }
    GltfMaker file;
    file.node({{"mesh", file.mesh(cut)}});
    file.primitive()["targets"].push_back(
        {{"POSITION", file.floats(GltfMaker::flat(moved), "VEC3")}});
    file.channel(0, "weights", {0, 1}, {0, 1});
    const MeshFile mesh = read_gltf(file.write(), "a.gltf", "");
    ASSERT_TRUE(mesh.faults.empty()) << told(mesh);
    const PointCacheFile motion = motion_of(file);
    ASSERT_TRUE(motion.cache) << told(motion);
    ASSERT_EQ(std::size_t(motion.cache->points), mesh.mesh.vertices.size());
    EXPECT_EQ(mesh.mesh.vertices.size(), (opens ? 2 : 1) * whole->vertices.size());
    MeshBody body;
    body.shape = std::make_shared<TriangleMesh>(mesh.mesh);
    EXPECT_EQ(open_edges(*surface_of(body)).empty(), !opens);
    const double last = double(motion.cache->sample(1)[mesh.mesh.vertices.size() - 1][1]);
    EXPECT_NEAR(last, whole->vertices.back()[1] + (opens ? -0.2 : 0.2), 1e-6);
  }
}

// What is exported of a cloth moves a body as its point cache does.
TEST(MeshGltfBody, WhatIsExportedMovesABody) {
  const Folder folder;
  Scene scene;
  scene.cloths.emplace_back().mesh.shape = made_up({.nx = 9, .ny = 7, .shift = 0.3});
  scene.cloths[0].mesh.translate = {0, 1, 0};
  Simulation run(scene, {.threads = 1});
  std::vector<std::unique_ptr<Animation>> written;
  for (const char* name : {"body.glb", "body.gltf", "body.mdd"})
    written.push_back(open_animation(folder / name, run.view(), 13));
  for (int n = 0; n < 13; ++n) {
    for (auto& one : written) one->append(run.view());
    run.advance_frame();
  }
  for (auto& one : written) one->complete(), one->commit();
  std::vector<std::vector<double>> ends;
  for (const char* name : {"body.mdd", "body.glb", "body.gltf"}) {
    const SceneFile file = read_scene(folder.write(
        "scene.json", std::string(R"({"weft": 1, "cloths": [{"grid": {"points": [12, 12],
            "u": [0.4, 0, 0], "v": [0, 0, 0.4], "origin": [0.3, 0.98, 0.3]}}],
            "colliders": [{"mesh": {"file": "body.glb"}, "offset": 0.01, "animation": ")") +
                          name + "\"}]}"));
    ASSERT_TRUE(file.faults.empty()) << file.faults[0].place << ": " << file.faults[0].what;
    const auto& body = std::get<MeshBody>(file.scene.colliders[0].shape);
    ASSERT_TRUE(body.motion);
    EXPECT_EQ(body.motion->samples(), 13);
    Simulation other(file.scene, {.threads = 1});
    for (int n = 0; n < 12; ++n) other.advance_frame();
    EXPECT_TRUE(other.status().ok);
    ends.push_back(other.positions());
  }
  for (std::size_t n = 0; n < ends[0].size(); ++n) {
    ASSERT_NEAR(ends[0][n], ends[1][n], 1e-4);
    ASSERT_EQ(ends[1][n], ends[2][n]);
  }
}

// As many vertices in another order are told of.
TEST(MeshGltfBody, AnotherOrderOfVerticesIsTold) {
  const Folder folder;
  const auto ball = tests::ball(24, 16, 0.5);
  TriangleMesh other = *ball;
  for (std::size_t v = 0; v < other.vertices.size(); ++v)
    other.vertices[v] = ball->vertices[137 * v % other.vertices.size()];
  folder.write("body.obj", write_obj(*ball));
  for (const TriangleMesh* mesh :
       {static_cast<const TriangleMesh*>(ball.get()), &std::as_const(other)}) {
    GltfMaker maker;
    maker.node({{"mesh", maker.mesh(*mesh)}});
    maker.channel(0, "translation", {0, 1}, {0, 0, 0, 1, 0, 0});
    folder.write("moves.gltf", maker.write());
    const SceneFile file = read_scene(folder.write("scene.json", R"({"weft": 1,
        "cloths": [{"grid": {"points": [4, 4], "origin": [0, 3, 0]}}],
        "colliders": [{"mesh": {"file": "body.obj"}, "animation": "moves.gltf"}]})"));
    ASSERT_TRUE(file.faults.empty()) << file.faults[0].place << ": " << file.faults[0].what;
    ASSERT_EQ(file.notes.size(), mesh == ball.get() ? 0u : 1u);
    if (file.notes.empty()) continue;
    EXPECT_NE(file.notes[0].find("its vertices may be in another order"), std::string::npos);
  }
}

// A patch on a ball that a node turns sticks to it.
TEST(MeshGltfBody, FrictionSeesTheVelocityOfTheSurface) {
  const Folder folder;
  GltfMaker maker;
  maker.node({{"mesh", maker.mesh(*tests::ball(48, 48, 0.5))}});
  const Vec3 up{0, 1, 0};
  maker.channel(0, "rotation", {0.3, 0.8, 1.8}, joined({turn(up, 0), turn(up, 15), turn(up, 75)}));
  folder.write("ball.glb", maker.write_glb());
  const SceneFile file = read_scene(folder.write("scene.json", R"({"weft": 1,
      "cloths": [{"grid": {"points": [10, 10], "u": [0.2, 0, 0], "v": [0, 0, 0.2],
                           "origin": [-0.1, 0.501, -0.1]}}],
      "colliders": [{"mesh": {"file": "ball.glb"}, "animation": "ball.glb", "friction": 0.6}]})"));
  ASSERT_TRUE(file.faults.empty()) << file.faults[0].place << ": " << file.faults[0].what;
  Simulation run(file.scene, {.threads = 1});
  while (run.time() < 0.3) run.advance_frame();
  const std::vector<double> before = run.positions();
  while (run.time() < 1.8) run.advance_frame();
  const std::vector<double> after = run.positions();
  const double angle = 75 * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  for (std::size_t n = 0; n < before.size(); n += 3) {
    const double x = c * before[n] + s * before[n + 2], z = c * before[n + 2] - s * before[n];
    EXPECT_LT(std::hypot(after[n] - x, after[n + 2] - z), 4e-3) << n;
  }
}

std::string changed(const std::function<void(GltfMaker&)>& change) {
  Arm arm(tube());
  arm.file.channel(3, "rotation", {0, 1}, joined({turn({0, 0, 1}, 0), turn({0, 0, 1}, 90)}));
  change(arm.file);
  return told(motion_of(arm.file));
}
std::string with(const char* place, const char* value) {
  return changed([&](GltfMaker& f) { f.document[Json::json_pointer(place)] = Json::parse(value); });
}

TEST(MeshGltfBody, WhatIsWrongWithSkinsAndTargetsIsNamed) {
  EXPECT_EQ(changed([](GltfMaker& f) { f.document.erase("animations"); }),
            "a.gltf: the file has no animation (one of nodes, skins or morph targets)\n");
  EXPECT_EQ(with("/skins/0/joints", "[2, 3, 9]"),
            "a.gltf:/skins/0/joints/2: the joint is no node of the scene that is shown (one)\n");
  EXPECT_EQ(with("/skins/0/joints", "[2, 3, 1]"),
            "a.gltf:/skins/0/inverseBindMatrices: there are 2 inverse bind matrices (3, as there "
            "are joints)\n");
  EXPECT_EQ(
      with("/skins/0/joints", "[2]")
          .rfind("a.gltf:/meshes/0/primitives/0/attributes/JOINTS_0: a joint is 1, that of vertex ",
                 0),
      0u);
  EXPECT_EQ(with("/nodes/0/skin", "4"), "a.gltf:/skins: there is no item 4 (0 to 0)\n");
  EXPECT_EQ(changed([](GltfMaker& f) { f.primitive()["attributes"].erase("WEIGHTS_0"); }),
            "a.gltf:/meshes/0/primitives/0/attributes: WEIGHTS_0 is missing (every key that glTF "
            "2.0 asks for)\n");
  EXPECT_EQ(with("/meshes/0/primitives/0/targets", R"([{"POSITION": 1}])"),
            "a.gltf:/meshes/0/primitives/0/targets/0/POSITION: the target moves 1080 vertices "
            "(182, as there are)\n");
  EXPECT_EQ(with("/meshes/0/weights", "[1]"),
            "a.gltf:/meshes/0/weights: there are 1 weights (0, as there are targets)\n");
}

TEST(MeshGltfBody, WhatIsWrongWithAnimationsIsNamed) {
  const std::string sampler = "a.gltf:/animations/0/samplers/0";
  EXPECT_EQ(with("/animations/0/samplers/0/interpolation", "\"SOON\""),
            sampler + "/interpolation: \"SOON\" is out of place (STEP, LINEAR, CUBICSPLINE)\n");
  EXPECT_EQ(with("/animations/0/samplers/0/interpolation", "\"CUBICSPLINE\""),
            sampler + "/output: there are 2 values (6, by the times)\n");
  EXPECT_EQ(with("/animations/0/samplers", "[]"),
            "a.gltf:/animations/0/samplers: there is no item 0 (the list is empty)\n");
  const auto input = [&](const std::vector<double>& times) {
    return changed([&](GltfMaker& f) {
      f.document["animations"][0]["samplers"][0]["input"] = f.floats(times, "SCALAR");
    });
  };
  EXPECT_EQ(input({1, 1}), sampler +
                               "/input: time 1 is 1, and the one before it is no earlier "
                               "(times that increase)\n");
  EXPECT_EQ(input({-1, 1}), sampler + "/input: time 0 is -1 (0 to 1e6)\n");
  EXPECT_EQ(input({}), sampler + "/input: there are no times (one at least)\n");
  EXPECT_NE(input({0, std::nan("")}).find("element 1 is not finite (finite numbers)"),
            std::string::npos);
  EXPECT_EQ(changed([](GltfMaker& f) {
              f.document["animations"][0]["samplers"][0]["output"] =
                  f.floats({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
            }),
            sampler + "/output: the quaternion of key 1 is no rotation (unit quaternions)\n");
  EXPECT_EQ(changed([](GltfMaker& f) {
              f.channel(3, "rotation", {0}, {0, 0, 0, 1});
            }),
            "a.gltf:/animations/0/channels/1/target: the node's rotation has a channel already "
            "(one)\n");
  EXPECT_EQ(with("/nodes/3/matrix", "[1,0,0,0, 0,1,0,0, 0,0,1,0, 1,0,0,1]"),
            "a.gltf:/animations/0/channels/0/target/node: the node has a matrix (translation, "
            "rotation and scale)\n");
  EXPECT_EQ(told(read_gltf_motion(Arm(tube()).file.write(), "a.gltf", "", 5)),
            "a.gltf: the file has 182 points (5, the vertices of the mesh)\n");
}

TEST(MeshGltfBody, WhatIsOddIsTold) {
  const auto mesh = tube();
  Arm arm(mesh);
  arm.file.channel(3, "rotation", {0, 1}, joined({turn({0, 0, 1}, 0), turn({0, 0, 1}, 90)}));
  arm.file.channel(0, "translation", {0, 1}, {0, 0, 0, 1, 1, 1}, "LINEAR", 1);
  arm.file.document["animations"][1]["name"] = "run";
  EXPECT_EQ(told(motion_of(arm.file)),
            "a.gltf: of 2 animations the first, \"0\", is played; the others: \"run\"\n");
  std::swap(arm.file.document["animations"][0], arm.file.document["animations"][1]);
  arm.file.document["animations"].erase(1);  // only moves the node of the mesh, which has a skin
  EXPECT_EQ(told(motion_of(arm.file)), "a.gltf: the animation \"run\" moves no vertex\n");
  // Weights: twice as much as they should be, and none.
  std::vector<double> weights;
  for (std::size_t v = 0; v < mesh->vertices.size(); ++v)
    weights.insert(weights.end(), {v == 3 ? 0.0 : 2.0, 0, 0, 0});
  arm.file.primitive()["attributes"]["WEIGHTS_0"] = arm.file.floats(weights, "VEC4");
  const MeshFile rest = read_gltf(arm.file.write(), "a.gltf", "");
  EXPECT_EQ(told(rest),
            "a.gltf: 1 vertex has no weights, as if bound to the first joint of the skin\n"
            "a.gltf: the weights of 181 vertices sum to other than 1 (2), and are divided by "
            "their sum\n");
  for (std::size_t v = 0; v < mesh->vertices.size(); ++v)
    EXPECT_NEAR(rest.mesh.vertices[v][0], Arm::kShoulder[0] + mesh->vertices[v][0], 1e-6);
}

}  // namespace
}  // namespace weft
