// What meshes are like at rest: curved as their file, flat, as their texture coordinates, or as a second file.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "folder.h"
#include "mesh_scenes.h"
#include "physics/model/mesh/rest_triangles.h"
#include "weft/read_scene.h"
#include "weft/vec3.h"

namespace weft {
namespace {

constexpr double kRadius = 0.2;  // m, of the roll

const MadeUpMesh kSheet{.nx = 15, .ny = 13, .width = 0.5, .height = 0.4, .shift = 0.3};

// A sheet rolled about the z axis, without stretch but for the chords.
std::shared_ptr<TriangleMesh> rolled(const TriangleMesh& flat) {
  auto mesh = std::make_shared<TriangleMesh>(flat);
  for (Vec3& p : mesh->vertices) {
    const double turn = p[0] / kRadius;
    p = {kRadius * std::sin(turn), kRadius * std::cos(turn), p[2]};
  }
  return mesh;
}

// Texture coordinates that are the sheet's x and z.
void map_flat(TriangleMesh& mesh, const TriangleMesh& flat) {
  for (const auto& t : flat.triangles) {
    auto& uv = mesh.uv.emplace_back();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = flat.vertices[std::size_t(t[k])];
      uv[k] = {p[0], p[2]};
    }
  }
}

Scene shell_scene(std::shared_ptr<const TriangleMesh> mesh) {
  Scene scene = scene_of(std::move(mesh));
  scene.gravity = {};
  scene.cloths[0].bending = 1e-3;
  return scene;
}

double largest_move(const Simulation& run, const std::vector<Vec3>& from) {
  double most = 0;
  const std::vector<Vec3> x = positions_of(run);
  for (std::size_t p = 0; p < x.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(x[p][k] - from[p][k]));
  return most;
}

// The greatest difference of distances between vertices [m].
double misfit(const std::vector<Vec3>& x, const std::vector<Vec3>& shape) {
  double most = 0;
  const auto apart = [](const Vec3& a, const Vec3& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  };
  for (std::size_t p = 0; p < x.size(); p += 3)
    for (std::size_t q = 0; q < p; q += 5)
      most = std::max(most, std::abs(apart(x[p], x[q]) - apart(shape[p], shape[q])));
  return most;
}

struct Method_ {
  const char* name;
  void (*set)(Scene&);
};
const Method_ kMethods[] = {
    {"springs", [](Scene&) {}},
    {"membrane", [](Scene& s) { s.cloths[0].membrane = kCanvas; }},
    {"compliant",
     [](Scene& s) {
       s.solver.method = Method::compliant;
       s.time.substeps = 16;
     }},
    {"strands",
     [](Scene& s) {
       s.solver = {.method = Method::compliant, .sweep = Sweep::line, .order = 2};
       s.time.substeps = 16;
     }},
};

TEST(MeshRest, ForcesAreTheSlopeOfTheEnergy) {
  const auto mesh = rolled(*made_up({.nx = 6, .ny = 5, .width = 0.5, .height = 0.4, .shift = 0.3}));
  Scene scene = shell_scene(mesh);
  scene.cloths[0].bending.warp = 2e-3;
  scene.cloths[0].stiffness.structural = 0;
  const auto triangles = physics::rest_triangles(*mesh, {mesh->vertices}, scene.cloths[0].bending);
  ASSERT_TRUE(physics::is_curved(triangles));
  const auto made_of = physics::material_of(scene.cloths[0], false);
  EXPECT_LT(physics::mesh_energy(triangles, made_of, mesh->vertices), 1e-25);
  std::mt19937 random(5);
  std::vector<Vec3> x = mesh->vertices, force(x.size());
  for (Vec3& p : x)
    for (double& value : p) value += 0.02 * (double(random()) / 2147483648.0 - 1);
  physics::add_mesh_forces(triangles, made_of, x, nullptr, force);
  double greatest = 0;
  for (const Vec3& f : force) greatest = std::max(greatest, length(f));
  for (std::size_t p = 0; p < x.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(force[p][k], energy_slope(triangles, made_of, x, p, k), 1e-6 * greatest);
}

TEST(MeshRest, ForcesAddUpToNothingAndTurnNothing) {
  const auto mesh = rolled(*made_up(kSheet));
  const Scene scene = shell_scene(mesh);
  const auto triangles = physics::rest_triangles(*mesh, {mesh->vertices}, scene.cloths[0].bending);
  std::mt19937 random(5);
  std::vector<Vec3> x = mesh->vertices, force(x.size());
  for (Vec3& p : x)
    for (double& value : p) value += 0.02 * (double(random()) / 2147483648.0 - 1);
  physics::add_mesh_forces(triangles, physics::material_of(scene.cloths[0], false), x, nullptr,
                           force);
  Vec3 sum{}, turn{};
  double all = 0;
  for (std::size_t p = 0; p < x.size(); ++p) {
    sum = plus(sum, force[p]);
    turn = plus(turn, cross(x[p], force[p]));
    all += length(force[p]);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(sum[k], 0, 1e-12 * all);
    EXPECT_NEAR(turn[k], 0, 1e-12 * all);
  }
}

TEST(MeshRest, AShellStaysStill) {
  const auto mesh = rolled(*made_up(kSheet));
  for (const Method_& method : kMethods) {
    Scene scene = shell_scene(mesh);
    method.set(scene);
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 30; ++n) run.advance_frame();
    EXPECT_LT(largest_move(run, mesh->vertices), 2e-5) << method.name;
    scene.cloths[0].mesh.rest = MeshRest::flat;
    Simulation flattens(scene, {.threads = 1});
    const double held = flattens.report().energy.elastic;
    EXPECT_LT(run.report().energy.elastic, 2e-5 * held) << method.name;  // by rounded positions
    for (int n = 0; n < 30; ++n) flattens.advance_frame();
    EXPECT_GT(largest_move(flattens, mesh->vertices), 5e-3) << method.name;
  }
}

TEST(MeshRest, EnergyDoesNotCareHowAShellIsTurned) {
  const auto mesh = rolled(*made_up(kSheet));
  Scene scene = shell_scene(mesh);
  scene.cloths[0].mesh.rotate = {30, 50, -70};
  scene.cloths[0].mesh.translate = {1, -2, 0.5};
  const double turned = Simulation(scene, {.threads = 1}).report().energy.elastic;
  scene.cloths[0].mesh.rest = MeshRest::flat;
  EXPECT_LT(turned, 2e-5 * Simulation(scene, {.threads = 1}).report().energy.elastic);
}

// A flat sheet whose second file is a roll becomes that roll.
TEST(MeshRest, RollsUp) {
  const auto flat = made_up(kSheet);
  const auto roll = rolled(*flat);
  for (const Method_& method : kMethods) {
    Scene scene = shell_scene(flat);
    scene.cloths[0].drag = 4;
    scene.cloths[0].mesh.rest = MeshRest::file;
    scene.cloths[0].mesh.at_rest.shape = roll;
    method.set(scene);
    Simulation run(scene, {.threads = 1});
    const double before = misfit(positions_of(run), roll->vertices);
    for (int n = 0; n < 240; ++n) run.advance_frame();
    EXPECT_LT(misfit(positions_of(run), roll->vertices), 0.02 * before) << method.name;
  }
}

// A roll that rests as its texture coordinates becomes the flat pattern.
TEST(MeshRest, UnrollsToThePattern) {
  const auto flat = made_up(kSheet);
  const auto roll = rolled(*flat);
  map_flat(*roll, *flat);
  for (const Method_& method : kMethods) {
    Scene scene = shell_scene(roll);
    scene.cloths[0].drag = 4;
    scene.cloths[0].mesh.rest = MeshRest::uv;
    method.set(scene);
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 240; ++n) run.advance_frame();
    EXPECT_LT(misfit(positions_of(run), flat->vertices), 2e-3) << method.name;
  }
}

TEST(MeshRest, ThePatternHasItsOwnScaleAndMass) {
  const auto flat = made_up(kSheet);
  auto mapped = std::make_shared<TriangleMesh>(*flat);
  map_flat(*mapped, *flat);
  for (auto& corners : mapped->uv)
    for (auto& at : corners) at[0] *= -50, at[1] *= 50;  // mirrored, too
  Scene scene = shell_scene(mapped);
  scene.cloths[0].mesh.rest = MeshRest::uv;
  scene.cloths[0].mesh.uv_scale = 0.02;
  const Report as_it_is = Simulation(scene, {.threads = 1}).report();
  EXPECT_LT(as_it_is.energy.elastic, 1e-10);  // of positions that are rounded
  EXPECT_NEAR(as_it_is.strain.max, 0, 1e-6);
  scene.cloths[0].mesh.uv_scale = 0.016;
  scene.cloths[0].velocity = {1, 0, 0};
  const Simulation smaller(scene, {.threads = 1});
  EXPECT_NEAR(smaller.report().strain.max, 0.25, 1e-5);
  EXPECT_NEAR(smaller.report().momentum[0], 0.3 * 0.5 * 0.4 * 0.64, 1e-6);
  const auto& notes = smaller.plan().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.find("longer or shorter than at rest") != std::string::npos;
  }));
}

TEST(MeshRest, TheSameBitsFromEveryMachine) {
  const auto mesh =
      rolled(*made_up({.nx = 40, .ny = 35, .width = 0.5, .height = 0.4, .shift = 0.3}));
  for (const Method_& method : kMethods) {
    Scene scene = shell_scene(mesh);
    method.set(scene);
    scene.gravity = {0, -9.81, 0};
    scene.cloths[0].pins = {{0, 0, {}}, {39, 0, {}}};
    std::uint64_t expected = 0;
    for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512})
      for (const int threads : {1, 2, 3}) {
        if (!simd_available(simd)) continue;
        Simulation run(scene, {.threads = threads, .simd = simd});
        for (int n = 0; n < 3; ++n) run.advance_frame();
        if (expected == 0) expected = run.hash();
        EXPECT_EQ(run.hash(), expected) << method.name << " " << simd_name(simd) << " " << threads;
      }
  }
}

TEST(MeshRest, FilesAndTheirFaults) {
  const Folder folder;
  const auto flat = made_up({.nx = 4, .ny = 4, .width = 0.5, .height = 0.4});
  std::ofstream(folder / "flat.obj") << write_obj(*flat);
  std::ofstream(folder / "roll.obj") << write_obj(*rolled(*flat));
  std::ofstream(folder / "other.obj") << write_obj(*made_up({.nx = 5, .ny = 4}));
  auto crossed = std::make_shared<TriangleMesh>(*flat);
  std::swap(crossed->triangles[0], crossed->triangles[5]);
  std::ofstream(folder / "crossed.obj") << write_obj(*crossed);
  auto thin = std::make_shared<TriangleMesh>(*flat);
  map_flat(*thin, *flat);
  thin->uv[3] = {};
  std::ofstream(folder / "thin.obj") << write_obj(*thin);
  const auto read = [&](const std::string& mesh, const std::string& solver = "{}") {
    std::ofstream(folder / "s.json") << R"({"weft": 1, "solver": )" + solver +
                                            R"(, "cloths": [{"bending": 1e-3, "mesh": {)" + mesh +
                                            "}}]}";
    return read_scene(folder / "s.json");
  };
  const auto fault = [&](const std::string& mesh, const std::string& solver = "{}") {
    std::string all;
    for (const Fault& f : read(mesh, solver).faults) all += f.place + ": " + f.what + "\n";
    return all;
  };
  const SceneFile file = read(R"("file": "flat.obj", "rest": "roll.obj")");
  ASSERT_TRUE(file.faults.empty()) << file.faults[0].what;
  EXPECT_GT(Simulation(file.scene, {.threads = 1}).report().energy.elastic, 1e-3);
  EXPECT_EQ(read_scene_text(write_scene_text(file.scene)).scene, file.scene);
  EXPECT_NE(fault(R"("file": "flat.obj", "rest": "none.obj")").find("/cloths/0/mesh/rest: "),
            std::string::npos);
  EXPECT_EQ(fault(R"("file": "flat.obj", "rest": "other.obj")"),
            "/cloths/0/mesh/rest: the shape at rest has 20 vertices and 24 triangles\n");
  EXPECT_EQ(fault(R"("file": "flat.obj", "rest": "crossed.obj")")
                .find("/cloths/0/mesh/rest: the triangle of vertices "),
            0u);
  EXPECT_EQ(fault(R"("file": "flat.obj", "rest": "uv")"),
            "/cloths/0/mesh/rest: the mesh has no texture coordinates\n");
  EXPECT_NE(fault(R"("file": "thin.obj", "rest": "uv")").find("has no area on the pattern"),
            std::string::npos);
  EXPECT_NE(
      fault(R"("file": "thin.obj", "rest": "uv")", R"({"method": "compliant", "tethers": true})"),
      "");
}

}  // namespace
}  // namespace weft
