// A mesh as a cloth of a scene: the same bits everywhere, hands, sleep, bodies and cuts, and from its file to
// exports.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "mesh_scenes.h"
#include "weft/output.h"
#include "weft/read_scene.h"
#include "weft/recording.h"
#include "weft/vec3.h"

namespace weft {
namespace {

TEST(MeshCloth, IsTheSameOnAnyThreadsAndInstructionSets) {
  const auto mesh = made_up({.nx = 37, .ny = 29, .shift = 0.3, .shuffled = true});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    scene.cloths[0].pins = {{3, 0, {{0, mesh->vertices[3]}, {0.1, {0, 0.1, 0}}}}, {700, 0, {}}};
    scene.colliders.push_back({Sphere{{0.5, -0.26, 0.5}, 0.25}, {}, 0.01, {}, false});
    scene.colliders.push_back({Sphere{{0.3, -0.005, 0.3}, 0.003}, {}, 0.001, {}, false});
    scene.wind = {{2, 1, 3}, 0.4, 0.2, 0.5};
    std::uint64_t hash = 0;
    for (const int threads : {1, 2, 3})
      for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512}) {
        if (!simd_available(simd) || (threads > 1 && simd != Simd::avx2)) continue;
        Simulation run(scene, {.threads = threads, .simd = simd});
        for (int n = 0; n < 2; ++n) run.advance_frame();
        ASSERT_TRUE(run.status().ok) << run.status().text;
        const std::uint64_t now = run.report().hash;
        if (hash == 0) hash = now;
        EXPECT_EQ(now, hash) << material.name << ", " << threads << ", " << simd_name(simd);
      }
  }
}

TEST(MeshCloth, TakesAHandASnapshotAndSleep) {
  const auto mesh = made_up({.nx = 15, .ny = 15, .shift = 0.3, .shuffled = true});
  Scene scene = scene_of(mesh);
  scene.cloths[0].membrane = {300, 300, 30, 60, 1e-3};
  scene.cloths[0].drag = 2;
  scene.solver.sleep = 0.02;
  scene.colliders.push_back(
      {Plane{{0, -0.2, 0}, {0, 1, 0}}, {FrictionModel::coulomb, 0.8, 0.8}, 0, {}, false});
  Simulation run(scene, {.threads = 1});
  run.advance_frame();
  const Snapshot start = run.snapshot();
  run.grab(0, 77, {0.5, 0.4, 0.5}, 20);
  for (int n = 0; n < 30; ++n) run.advance_frame();
  EXPECT_GT(positions_of(run)[77][1], 0.05);
  run.release();
  for (int n = 0; n < 400; ++n) run.advance_frame();
  const Report rest = run.report();
  EXPECT_LT(rest.penetration.collider_max, 1e-4);
  EXPECT_EQ(rest.asleep, 225);
  run.restore(start);
  EXPECT_EQ(run.snapshot().cloths[0].positions, start.cloths[0].positions);
}

// The least height of a mesh above a place, seen along y.
double height_over(const TriangleMesh& mesh, const std::vector<Vec3>& x, double px, double pz) {
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 &p = x[std::size_t(a)], &q = x[std::size_t(b)], &r = x[std::size_t(c)];
    const double d = (q[0] - p[0]) * (r[2] - p[2]) - (r[0] - p[0]) * (q[2] - p[2]);
    const double u = ((px - p[0]) * (r[2] - p[2]) - (r[0] - p[0]) * (pz - p[2])) / d;
    const double v = ((q[0] - p[0]) * (pz - p[2]) - (px - p[0]) * (q[2] - p[2])) / d;
    if (u >= 0 && v >= 0 && u + v <= 1) return p[1] + u * (q[1] - p[1]) + v * (r[1] - p[1]);
  }
  return -1e9;
}

// A sheet that hangs by its corners comes down on balls that its vertices would pass by.
// The same follows a snapshot in the run that it is of and in a new one, by every method, drag and pins on
// paths or not: nothing is worked out in the middle of a substep.
TEST(MeshCloth, GoesOnFromASnapshotAsANewOneDoes) {
  const auto mesh = made_up({.nx = 11, .ny = 13, .shift = 0.3, .shuffled = true});
  for (const Material& material : kMaterials)
    for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line})
      for (const int order : {0, 1, 2})  // 0: by forces
        for (const double drag : {0.0, 1.7}) {
          Scene scene = scene_of(mesh);
          material.set(scene);
          if (order > 0 && scene.cloths[0].membrane.given()) continue;
          if (order > 0) scene.solver.method = Method::compliant, scene.solver.order = order;
          if (order > 0) scene.solver.sweep = sweep;
          scene.cloths[0].drag = drag;
          scene.cloths[0].pins = {{3, 0, {{0, mesh->vertices[3]}, {0.3, {0, 0.4, 0}}}},
                                  {90, 0, {}}};
          Simulation first(scene, {.threads = 1}), second(scene, {.threads = 2});
          for (int n = 0; n < 4; ++n) first.advance_frame();
          const Snapshot snapshot = first.snapshot();
          first.restore(snapshot), second.restore(snapshot);
          for (int n = 0; n < 4; ++n) first.advance_frame(), second.advance_frame();
          EXPECT_EQ(first.hash(), second.hash())
              << material.name << ", sweep " << int(sweep) << ", order " << order << ", " << drag;
        }
}

TEST(MeshCloth, IsHeldByBodiesSmallerThanItsTriangles) {
  const auto mesh = made_up({.nx = 9, .ny = 9, .shift = 0.3, .shuffled = true});
  for (const double radius : {0.01, 0.03})
    for (const double speed : {0.0, 4.0}) {
      Scene scene = scene_of(mesh);
      Cloth& cloth = scene.cloths[0];
      cloth.membrane = {600, 600, 60, 200, 1e-3};
      cloth.drag = 2;
      cloth.velocity = {0, -speed, 0};
      for (const Vec3& corner : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 0, 1}, Vec3{1, 0, 1}})
        cloth.pins.push_back({nearest_vertex(*mesh, corner), 0, {}});
      const auto& [a, b, c] = mesh->triangles[60];
      const auto at = [&](int n) { return mesh->vertices[std::size_t(n)]; };
      const Vec3 middle = times(plus(at(a), plus(at(b), at(c))), 1.0 / 3);
      const Vec3 center{middle[0], -0.02 - radius, middle[2]};
      scene.colliders.push_back({Sphere{center, radius}, {}, 0, {}, false});
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 120; ++n) {
        run.advance_frame();
        ASSERT_TRUE(run.status().ok) << run.status().text;
        const auto x = positions_of(run);
        ASSERT_GT(height_over(*mesh, x, center[0], center[2]), center[1])
            << "radius " << radius << ", speed " << speed << ", frame " << n;
      }
      EXPECT_LT(run.report().penetration.collider_max, 0.3 * radius) << radius << ", " << speed;
    }
}

TEST(MeshCloth, ReportsHowDeepTrianglesLie) {
  const auto mesh = made_up({.nx = 5, .ny = 5});
  Scene scene = scene_of(mesh);
  scene.gravity = {};
  const auto& [a, b, c] = mesh->triangles[9];
  const auto at = [&](int n) { return mesh->vertices[std::size_t(n)]; };
  const Vec3 middle = times(plus(at(a), plus(at(b), at(c))), 1.0 / 3);
  scene.colliders.push_back({Sphere{{middle[0], 0.01, middle[2]}, 0.05}, {}, 0, {}, false});
  const Simulation run(scene, {.threads = 1});
  EXPECT_NEAR(run.report().penetration.collider_max, 0.04, 1e-6);
}

class MeshScene : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("weft_mesh_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
    write("square.obj",
          "o sheet\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 0.5 0 0.5\n"
          "f 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
  }
  SceneFile read(const std::string& cloth) {
    write("s.json", R"({"weft": 1, "cloths": [)" + cloth + "]}");
    return read_scene((folder_ / "s.json").string());
  }
  std::string told(const std::string& cloth) {
    std::string text;
    for (const Fault& f : read(cloth).faults)
      text += f.place + ": " + f.what + " (" + f.allowed + ")\n";
    for (auto at = text.find(folder_.string()); at != std::string::npos;
         at = text.find(folder_.string()))
      text.erase(at, folder_.string().size() + 1);
    return text;
  }
  std::filesystem::path folder_;
};

TEST_F(MeshScene, IsReadBesideTheSceneAndPlaced) {
  const SceneFile file = read(
      R"({"mesh": {"file": "square.obj", "scale": 2, "rotate": [90, 0, 0], "translate": [0, 3, 0]},
          "pins": [0, {"at": 3, "keys": [[0, 0, 1, 0]]}]})");
  ASSERT_TRUE(file.faults.empty()) << file.faults[0].what;
  const Simulation run(file.scene, {.threads = 1});
  const auto x = positions_of(run);
  ASSERT_EQ(x.size(), 5u);
  EXPECT_NEAR(x[2][0], 2, 1e-6);
  EXPECT_NEAR(x[2][1], 1, 1e-6);  // z turned to -y
  EXPECT_EQ(x[3], (Vec3{0, 1, 0}));
  EXPECT_EQ(read_scene_text(write_scene_text(file.scene)).faults.size(), 0u);
}

TEST_F(MeshScene, NamesWhatIsWrong) {
  EXPECT_EQ(told(R"({"mesh": {"file": "none.obj"}})"),
            "/cloths/0/mesh/file: none.obj: there is no such mesh file (a readable file)\n");
  write("bad.obj", "v 0 0 0\nv 1 0 0\nv x 0 0\nf 1 2 3\n");
  EXPECT_EQ(told(R"({"mesh": {"file": "bad.obj"}})"),
            "/cloths/0/mesh/file: bad.obj:3: \"x\" is no coordinate (numbers, -1e9 to 1e9)\n");
  EXPECT_EQ(told(R"({"mesh": {"file": "square.obj"}, "pins": [5]})"),
            "/cloths/0/pins/0: the pin 5 is no vertex of the mesh (0 to 4)\n");
  EXPECT_EQ(told(R"({"mesh": {"file": "square.obj", "scale": 1e5}})"),
            "/cloths/0/mesh/scale: the mesh reaches 100000 m away, at vertex 1 (counted from 0) "
            "(-10000 to 10000 m along each axis)\n");
  EXPECT_EQ(
      told(R"({"mesh": {"file": "square.obj"}, "tears": "particles", "level": 2,
                     "self_collision": {"mode": "surface", "response": "course"}})"),
      "/cloths/0/level: a mesh has a level (0, with a mesh)\n"
      "/cloths/0/tears: a tear is to take whole vertices of a mesh (split or holes, with a mesh)\n"
      "/cloths/0/self_collision/response: neighbours that push are those of a grid (stiff, with a "
      "mesh)\n");
}

TEST_F(MeshScene, ExportsTheVerticesInTheFilesOrder) {
  const SceneFile file = read(R"({"mesh": {"file": "square.obj"}})");
  ASSERT_TRUE(file.faults.empty());
  const Simulation run(file.scene, {.threads = 1});
  const auto animation = open_animation((folder_ / "out.obj").string(), run.view(), 1);
  animation->append(run.view());
  animation->finish();
  const MeshFile again = read_mesh((folder_ / "out_0000.obj").string());
  EXPECT_TRUE(again.faults.empty());
  EXPECT_EQ(again.mesh.vertices, file.scene.cloths[0].mesh.shape->vertices);
  EXPECT_EQ(again.mesh.triangles, file.scene.cloths[0].mesh.shape->triangles);
}

// With a second mesh, of texture coordinates and a loose edge, that comes in later: the recording alone gives
// the same frames, wherever the files are by then.
TEST_F(MeshScene, IsRecordedWithItsMeshes) {
  write("late.obj",
        "v 0.1 0 0.3\nv 1 0.7 0\nv 0 1 0\nv 0 0 5\nvt 0.1 0.3\nvt 1 0\nvt 0 1\n"
        "f 1/1 2/2 3/3\nl 1 4\n");
  const SceneFile first = read(R"({"mesh": {"file": "square.obj"}})");
  const SceneFile second =
      read(R"({"mesh": {"file": "square.obj"}}, {"mesh": {"file": "late.obj"}})");
  ASSERT_TRUE(first.faults.empty() && second.faults.empty());
  const std::string path = (folder_ / "r.weft").string();
  Simulation run(first.scene, {.threads = 1});
  Recorder recorder(path, run);
  const Input input{.kind = Input::Kind::set_scene,
                    .scene = std::make_shared<const Scene>(second.scene)};
  std::vector<std::uint64_t> hashes;
  for (int n = 0; n < 6; ++n) {
    if (n == 2 || n == 4) {
      recorder.input(run.frame(), input);
      apply(input, run);
    }
    run.advance_frame();
    recorder.frame(run);
    hashes.push_back(run.hash());
  }
  recorder.finish();
  std::filesystem::remove(folder_ / "square.obj");
  std::filesystem::remove(folder_ / "late.obj");

  const Recording recording = read_recording(path);
  EXPECT_EQ(difference(recording.scene, first.scene), "");
  const TriangleMesh& late = *recording.events[2].input->scene->cloths[1].mesh.shape;
  EXPECT_EQ(late.uv, second.scene.cloths[1].mesh.shape->uv);
  EXPECT_EQ(late.edges, second.scene.cloths[1].mesh.shape->edges);
  Simulation again(recording.scene, {.threads = 1});
  std::size_t next = 0;
  for (const std::uint64_t hash : hashes) {
    while (const Input* told = next_input(recording, next, again)) apply(*told, again);
    again.advance_frame();
    EXPECT_NO_THROW(compare_hash(recording, next, again));
    EXPECT_EQ(again.hash(), hash);
  }
}

TEST_F(MeshScene, OfARecordingIsTrustedNoMoreThanAFile) {
  const SceneFile file = read(R"({"mesh": {"file": "square.obj"}})");
  const std::string path = (folder_ / "r.weft").string();
  Simulation run(file.scene, {.threads = 1});
  {
    Recorder recorder(path, run);
    recorder.finish();
  }
  std::ifstream in(path);
  const std::string good{std::istreambuf_iterator<char>(in), {}};
  const auto refused_with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    std::ofstream(path) << text;
    try {
      read_recording(path);
    } catch (const RecordingError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  EXPECT_NE(refused_with("\"meshes\"", "\"other\"").find("the mesh is missing"), std::string::npos);
  EXPECT_NE(refused_with("\"v ", "\"v x ").find("no coordinate"), std::string::npos);
  EXPECT_NE(refused_with("{\"square.obj\":", "{\"square.obj\":5,\"b\":").find("is out of place"),
            std::string::npos);
}

TEST_F(MeshScene, OfAProgramIsRefusedByRecordings) {
  SceneFile file = read(R"({"mesh": {"file": "square.obj"}})");
  file.scene.cloths[0].mesh.file.clear();
  const Simulation run(file.scene, {.threads = 1});
  const std::string path = (folder_ / "r.weft").string();
  EXPECT_THROW(Recorder(path, run), WriteError);
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace weft
