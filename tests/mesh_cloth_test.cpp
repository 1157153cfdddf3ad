// Cloth of triangle meshes: forces against the energy, kernels against double precision, laws of motion,
// beams against their closed form, a lattice beside its mesh, and the same bits everywhere.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "made_up_mesh.h"
#include "physics/frame/measure.h"
#include "physics/frame/state.h"
#include "physics/model/mesh/rest_triangles.h"
#include "physics/model/vector.h"
#include "weft/output.h"
#include "weft/read_scene.h"
#include "weft/recording.h"

namespace weft {
namespace {

using physics::dot;
using physics::minus;
using physics::plus;
using physics::times;

Scene scene_of(std::shared_ptr<const TriangleMesh> mesh) {
  Scene scene;
  scene.time.frame = 1.0 / 60;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.mesh.shape = std::move(mesh);
  cloth.density = 0.3;
  return scene;
}

const Membrane kCanvas{3000, 2000, 200, 80, 0};

struct Material {
  const char* name;
  void (*set)(Scene&);
};
const Material kMaterials[] = {
    {"springs", [](Scene&) {}},
    {"damped springs",
     [](Scene& s) {
       s.solver.method = Method::spring_friction;
       s.cloths[0].spring_damping.structural = 0.05;
     }},
    {"membrane", [](Scene& s) { s.cloths[0].membrane = kCanvas; }},
    {"damped membrane that bends",
     [](Scene& s) {
       s.cloths[0].membrane = kCanvas;
       s.cloths[0].membrane.damping = 2e-4;
       s.cloths[0].bending.warp = 2e-4, s.cloths[0].bending.weft = 1e-4;
       s.cloths[0].bending.twist = 3e-5, s.cloths[0].bending.damping = 1e-3;
     }},
    {"springs that bend", [](Scene& s) { s.cloths[0].bending = 1e-4; }},
};

std::vector<Vec3> positions_of(const Simulation& run) {
  const std::vector<double> all = run.positions();
  std::vector<Vec3> x(all.size() / 3);
  for (std::size_t n = 0; n < all.size(); ++n) x[n / 3][n % 3] = all[n];
  return x;
}

std::vector<Vec3> rumpled(const TriangleMesh& mesh, double by, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Vec3> x = mesh.vertices;
  for (Vec3& p : x)
    for (double& value : p) value += by * (double(random()) / 2147483648.0 - 1);
  return x;
}

TEST(MeshCloth, ForcesAreTheSlopeOfTheEnergy) {
  const auto mesh = made_up({.nx = 5, .ny = 4, .shift = 0.3});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    const auto triangles = physics::rest_triangles(*mesh, mesh->vertices, scene.cloths[0].bending);
    const auto made_of = physics::material_of(scene.cloths[0], false);
    std::vector<Vec3> x = rumpled(*mesh, 0.05, 3), force(x.size());
    physics::add_mesh_forces(triangles, made_of, x, nullptr, force);
    for (std::size_t p = 0; p < x.size(); ++p)
      for (std::size_t k = 0; k < 3; ++k) {
        const double h = 1e-6, at = x[p][k];
        x[p][k] = at + h;
        const double more = physics::mesh_energy(triangles, made_of, x);
        x[p][k] = at - h;
        const double less = physics::mesh_energy(triangles, made_of, x);
        x[p][k] = at;
        EXPECT_NEAR(force[p][k], (less - more) / (2 * h), 1e-5 * (1 + std::abs(force[p][k])))
            << material.name << ", particle " << p;
      }
  }
}

// One frame of few substeps by kernels, beside plain leapfrog in double precision.
TEST(MeshCloth, KernelsDoWhatTheEquationsSay) {
  const auto mesh = made_up({.nx = 23, .ny = 17, .shift = 0.3, .shuffled = true});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    scene.time = {2e-4, 8, 1};
    scene.cloths[0].drag = 0.5;
    scene.cloths[0].pins = {{5, 0, {}}, {100, 0, {}}};
    const Cloth& cloth = scene.cloths[0];
    const std::vector<Vec3> start = rumpled(*mesh, 0.004, 7);
    std::vector<double> flat;
    for (const Vec3& p : start) flat.insert(flat.end(), p.begin(), p.end());
    Simulation run(scene, {.threads = 1});
    run.set_state(flat, std::vector<double>(flat.size()));
    const auto rounded = positions_of(run);
    run.advance_frame();

    const auto triangles = physics::rest_triangles(*mesh, mesh->vertices, cloth.bending);
    const auto made_of =
        physics::material_of(cloth, scene.solver.method == Method::spring_friction);
    std::vector<double> masses(start.size());
    for (const auto& r : triangles)
      for (std::size_t k = 0; k < 3; ++k)
        masses[std::size_t(r.corner[k])] += cloth.density * r.area / 3;
    std::vector<Vec3> x = rounded, v(x.size());
    const double dt = run.dt();
    const auto accelerations = [&](const std::vector<Vec3>* velocities) {
      std::vector<Vec3> a(x.size());
      physics::add_mesh_forces(triangles, made_of, x, velocities, a);
      for (std::size_t p = 0; p < x.size(); ++p)
        a[p] = p == 5 || p == 100 ? Vec3{} : plus(times(a[p], 1 / masses[p]), scene.gravity);
      return a;
    };
    // From half a substep before the start.
    const std::vector<Vec3> first = accelerations(nullptr);
    for (std::size_t p = 0; p < x.size(); ++p) v[p] = times(first[p], -dt / 2);
    for (int n = 0; n < run.substeps(); ++n) {
      const std::vector<Vec3> a = accelerations(&v);
      for (std::size_t p = 0; p < x.size(); ++p) {
        v[p] = plus(times(v[p], 1 - dt * cloth.drag), times(a[p], dt));
        x[p] = plus(x[p], times(v[p], dt));
      }
    }
    const auto moved = positions_of(run);
    double greatest = 0, off = 0;
    for (std::size_t p = 0; p < x.size(); ++p) {
      const Vec3 way = minus(x[p], rounded[p]), error = minus(moved[p], x[p]);
      greatest = std::max(greatest, dot(way, way));
      off = std::max(off, dot(error, error));
    }
    EXPECT_GT(std::sqrt(greatest), 1e-5) << material.name;
    EXPECT_LT(std::sqrt(off), 5e-7 + 2e-3 * std::sqrt(greatest)) << material.name;
  }
}

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

// Without gravity a rumpled sheet keeps momentum, angular momentum and energy.
TEST(MeshCloth, KeepsMomentumAndEnergy) {
  const auto mesh = made_up({.nx = 15, .ny = 13, .shift = 0.3});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    scene.gravity = {};
    scene.time.substeps = 600;  // far within the limit: what is told swings with its square
    scene.cloths[0].velocity = {0.3, 0.1, -0.2};
    scene.cloths[0].spin = {0.5, 1, 0.2};
    Simulation run(scene, {.threads = 1});
    std::vector<double> flat;
    for (const Vec3& p : rumpled(*mesh, 0.005, 5)) flat.insert(flat.end(), p.begin(), p.end());
    const std::vector<double> v = run.velocities();
    run.set_state(flat, v);
    const Report before = run.report();
    for (int n = 0; n < 10; ++n) run.advance_frame();
    const Report after = run.report();
    const bool damped = std::string(material.name).find("damped") == 0;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(after.momentum[k], before.momentum[k], 2e-5) << material.name;
      EXPECT_NEAR(after.angular_momentum[k], before.angular_momentum[k], 2e-5) << material.name;
    }
    if (damped)
      EXPECT_LT(after.energy.total, before.energy.total) << material.name;
    else
      EXPECT_NEAR(after.energy.total, before.energy.total, 0.02 * before.energy.total)
          << material.name;
  }
}

TEST(MeshCloth, FallsAndWeighsWhatItsAreaDoes) {
  Scene scene = scene_of(made_up({.nx = 12, .ny = 9, .width = 2, .height = 0.5, .shift = 0.3}));
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 30; ++n) run.advance_frame();
  const Report report = run.report();
  EXPECT_NEAR(report.momentum[1], -0.3 * 9.81 * 0.5, 1e-4);
  EXPECT_NEAR(report.energy.kinetic, 0.5 * 0.3 * std::pow(9.81 * 0.5, 2), 1e-3);
  EXPECT_LT(report.strain.max, 1e-4);
}

// A strip clamped at one end bends by q L⁴/8D. The clamp is two rows of vertices; it ends half way from the
// second to where slopes are free.
double tip_of_beam(const MadeUpMesh& like) {
  const auto mesh = made_up(like);
  Scene scene = scene_of(mesh);
  Cloth& cloth = scene.cloths[0];
  const double rigidity = 0.02, spacing = like.width / (like.nx - 1);
  cloth.membrane = {300, 300, 0, 150, 0};
  cloth.bending = rigidity;
  cloth.drag = 7.6;             // twice the slowest mode
  const double gravity = 0.08;  // a small bend
  scene.gravity = {0, -gravity, 0};
  for (std::size_t n = 0; n < mesh->vertices.size(); ++n)
    if (mesh->vertices[n][0] < 1.01 * spacing) cloth.pins.push_back({int(n), 0, {}});
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 250; ++n) run.advance_frame();
  EXPECT_TRUE(run.status().ok) << run.status().text;
  double tip = 0;
  const auto x = positions_of(run);
  for (std::size_t n = 0; n < x.size(); ++n)
    if (mesh->vertices[n][0] > like.width - 1e-9) tip -= x[n][1] / like.ny;
  const double length = like.width - spacing / 2;
  return tip / (0.3 * gravity * std::pow(length, 4) / (8 * rigidity));
}

TEST(MeshCloth, BendsAsABeamDoes) {
  const MadeUpMesh strip{.nx = 21, .ny = 7, .width = 0.5, .height = 0.15};
  for (const Diagonals diagonals : {Diagonals::alike, Diagonals::crossed}) {
    MadeUpMesh regular = strip;
    regular.diagonals = diagonals;
    EXPECT_NEAR(tip_of_beam(regular), 1, 0.01);
  }
  MadeUpMesh shifted = strip;
  shifted.shift = 0.1;
  EXPECT_NEAR(tip_of_beam(shifted), 1, 0.06);
  shifted.shift = 0.3;
  EXPECT_NEAR(tip_of_beam(shifted), 1, 0.15);
}

// A strip that hangs by its side is stretched by what is below, whatever its triangles.
TEST(MeshCloth, StretchesAsTheContinuumDoes) {
  for (const double shift : {0.0, 0.3}) {
    const auto mesh = made_up({.nx = 9, .ny = 25, .width = 0.3, .height = 1, .shift = shift});
    Scene scene = scene_of(mesh);
    Cloth& cloth = scene.cloths[0];
    cloth.membrane = {400, 250, 0, 100, 2e-3};
    cloth.drag = 3;
    scene.gravity = {0, 0, 9.81};
    for (std::size_t n = 0; n < mesh->vertices.size(); ++n)
      if (mesh->vertices[n][2] == 0) cloth.pins.push_back({int(n), 0, {}});
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 300; ++n) run.advance_frame();
    double end = 0;
    const auto x = positions_of(run);
    for (std::size_t n = 0; n < x.size(); ++n)
      if (mesh->vertices[n][2] == 1) end += x[n][2] / 9;
    // Along z (weft): ∫ s, s with weft (s² - 1)/2 s = weight below.
    double expected = 0;
    for (int k = 0; k < 1000; ++k) {
      const double pull = 0.3 * 9.81 * (1 - (k + 0.5) / 1000);
      double s = 1;
      for (int i = 0; i < 50; ++i) s -= (125 * (s * s - 1) * s - pull) / (125 * (3 * s * s - 1));
      expected += s / 1000;
    }
    EXPECT_NEAR(end, expected, 2e-4) << shift;
  }
}

// Turned round and mirrored, it moves the same way to rounding: no order of vertices or triangles shows.
TEST(MeshCloth, DoesNotSeeTheOrderOfItsVertices) {
  const MadeUpMesh plain{.nx = 13, .ny = 13, .shift = 0.2};
  std::vector<Vec3> at[2];
  for (const bool shuffled : {false, true}) {
    MadeUpMesh like = plain;
    // Shuffling draws from the same source: shifts are drawn anew, so a plain mesh is renumbered here.
    const auto mesh = made_up(like);
    const auto count = int(mesh->vertices.size());
    const auto renamed = [&](int n) { return shuffled ? (n * 29 + 11) % count : n; };
    auto other = std::make_shared<TriangleMesh>(*mesh);
    for (int n = 0; n < count; ++n)
      other->vertices[std::size_t(renamed(n))] = mesh->vertices[std::size_t(n)];
    for (auto& t : other->triangles)
      for (int& corner : t) corner = renamed(corner);
    Scene scene = scene_of(other);
    scene.cloths[0].membrane = kCanvas;
    scene.cloths[0].bending = 1e-4;
    scene.cloths[0].drag = 1;
    for (int n = 0; n < 13; ++n) scene.cloths[0].pins.push_back({renamed(13 * n), 0, {}});
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 15; ++n) run.advance_frame();
    const auto x = positions_of(run);
    for (int n = 0; n < count; ++n) at[shuffled].push_back(x[std::size_t(renamed(n))]);
  }
  for (std::size_t n = 0; n < at[0].size(); ++n)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(at[0][n][k], at[1][n][k], 2e-5);
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

// What a flat mesh in a wind at an angle gains is what a flat plate does, whatever its triangles.
TEST(MeshCloth, IsPushedByWindAsAFlatPlate) {
  Scene scene = scene_of(made_up({.nx = 14, .ny = 11, .shift = 0.3, .shuffled = true}));
  scene.gravity = {};
  scene.time = {1e-3, 1, 1};
  scene.cloths[0].membrane = {10, 10, 0, 5, 0};
  scene.wind = {{3, 4, 0}, 0.6, 0.3, 0};
  Simulation run(scene, {.threads = 1});
  run.advance_frame();
  const Report report = run.report();
  // n = y: drag 0.6 · 4² along n; lift 0.3 · 4 · 5 (n - û 4/5). The cloth, 0.3 kg/m², gives way within the
  // substep: the impulse is dt F / (1 + a + b²), a = dt 0.6 · 4 / 0.3, b = dt 0.3 · 5 / 0.3.
  const double impulse = 1e-3 / (1 + 8e-3 + 25e-6);
  EXPECT_NEAR(report.momentum[0], impulse * 6 * -0.6 * 0.8, 1e-6);
  EXPECT_NEAR(report.momentum[1], impulse * (9.6 + 6 * (1 - 0.64)), 1e-6);
  EXPECT_NEAR(report.momentum[2], 0, 1e-6);
}

TEST(MeshCloth, SaysThatItCannotBeCut) {
  Scene scene = scene_of(made_up({.nx = 9, .ny = 9}));
  Simulation run(scene, {.threads = 1}), other(scene, {.threads = 1});
  EXPECT_EQ(run.cut({2, 0, 0.5}, {3, 0, 0.5}, 0.01), 0);
  EXPECT_EQ(run.plan().notes, other.plan().notes);  // nothing is there
  EXPECT_EQ(run.cut({-1, 0, 0.5}, {2, 0, 0.5}, 0.01), 0);
  EXPECT_EQ(run.cut({-1, 0, 0.5}, {2, 0, 0.5}, 0.01), 0);
  std::vector<std::string> notes = other.plan().notes;
  notes.push_back("what is cut is a mesh, which does not tear: nothing of it was cut");
  EXPECT_EQ(run.plan().notes, notes);
  run.advance_frame();
  other.advance_frame();
  EXPECT_EQ(run.hash(), other.hash());
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
          "pins": [0, {"at": [3, 0], "keys": [[0, 0, 1, 0]]}]})");
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
            "/cloths/0/mesh/file: none.obj: there is no such mesh file (a readable .obj file)\n");
  write("bad.obj", "v 0 0 0\nv 1 0 0\nv x 0 0\nf 1 2 3\n");
  EXPECT_EQ(told(R"({"mesh": {"file": "bad.obj"}})"),
            "/cloths/0/mesh/file: bad.obj:3: \"x\" is no coordinate (numbers, -1e9 to 1e9)\n");
  EXPECT_EQ(told(R"({"mesh": {"file": "square.obj"}, "pins": [5]})"),
            "/cloths/0/pins/0: the pin 5 is no vertex of the mesh (0 to 4)\n");
  EXPECT_EQ(told(R"({"mesh": {"file": "square.obj", "scale": 1e5}})"),
            "/cloths/0/mesh/scale: the mesh reaches 100000.000000 m away (up to 10000 m)\n");
  EXPECT_EQ(told(R"({"mesh": {"file": "square.obj"}, "tear_strain": 0.5, "level": 2,
                     "self_collision": {"mode": "surface"}})"),
            "/cloths/0/level: a mesh has a level (0, with a mesh)\n"
            "/cloths/0/tear_strain: a mesh is to tear (0, with a mesh)\n"
            "/cloths/0/self_collision/mode: a mesh is to meet itself (off, with a mesh)\n");
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

TEST_F(MeshScene, IsRefusedByRecordingsWhichHoldNoMeshes) {
  const SceneFile file = read(R"({"mesh": {"file": "square.obj"}})");
  ASSERT_TRUE(file.faults.empty());
  const Simulation run(file.scene, {.threads = 1});
  const std::string path = (folder_ / "r.weft").string();
  EXPECT_THROW(Recorder(path, run), WriteError);
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_THROW(open_animation((folder_ / "r.glb").string(), run.view(), 1), WriteError);
}

}  // namespace
}  // namespace weft
