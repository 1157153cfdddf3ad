// Seams of meshes: their ends come together, hold as one, and keep what is to be kept.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "mesh_scenes.h"
#include "physics/model/mesh/mesh_order.h"
#include "weft/read_scene.h"
#include "weft/vec3.h"

namespace weft {
namespace {

struct Way {
  const char* name;
  Solver solver;
  Membrane membrane{};
};
Solver projected(int order, Sweep sweep, int iterations) {
  Solver s;
  s.method = Method::compliant;
  s.order = order;
  s.sweep = sweep;
  s.iterations = iterations;
  return s;
}
Solver by(Method method) {
  Solver s;
  s.method = method;
  return s;
}
const Way kWays[] = {{"spring", by(Method::spring)},
                     {"spring_friction", by(Method::spring_friction)},
                     {"compliant", projected(1, Sweep::gauss_seidel, 4)},
                     {"second order", projected(2, Sweep::gauss_seidel, 2)},
                     {"strands", projected(1, Sweep::line, 2)},
                     {"membrane", projected(1, Sweep::gauss_seidel, 2), kCanvas},
                     {"membrane by strands", projected(2, Sweep::line, 1), kCanvas}};

// A sheet, cut in two along a column of its points that both parts have.
struct CutSheet {
  std::shared_ptr<TriangleMesh> whole, parts;
  std::vector<int> original;  // of every vertex of the parts
  std::vector<Seam> seams;
};
CutSheet cut_in_two(const MadeUpMesh& made) {
  CutSheet sheet;
  sheet.whole = made_up(made);
  sheet.parts = std::make_shared<TriangleMesh>(*sheet.whole);
  const int column = made.nx / 2;
  for (std::size_t n = 0; n < sheet.whole->vertices.size(); ++n) sheet.original.push_back(int(n));
  std::map<int, int> doubles;
  for (int j = 0; j < made.ny; ++j) {
    const int point = j * made.nx + column;
    doubles[point] = int(sheet.parts->vertices.size());
    sheet.parts->vertices.push_back(sheet.whole->vertices[std::size_t(point)]);
    sheet.original.push_back(point);
    sheet.seams.push_back({point, doubles[point]});
  }
  for (auto& t : sheet.parts->triangles) {
    const auto right = [&](int v) { return v % made.nx > column; };
    if (std::none_of(t.begin(), t.end(), right)) continue;
    for (int& v : t)
      if (const auto other = doubles.find(v); other != doubles.end()) v = other->second;
  }
  return sheet;
}

double widest(const Simulation& run, const std::vector<Seam>& seams) {
  const std::vector<Vec3> x = positions_of(run);
  double most = 0;
  for (const auto& [a, b] : seams)
    most = std::max(most, distance(x[std::size_t(a)], x[std::size_t(b)]));
  return most;
}

// Two free panels, 0.2 m apart, one tilted against the other, that turn and fly.
Scene two_panels(std::vector<Seam>& seams) {
  CutSheet sheet = cut_in_two({.nx = 13, .ny = 9, .shift = 0.2});
  for (std::size_t n = 0; n < sheet.original.size(); ++n) {
    Vec3& at = sheet.parts->vertices[n];
    const bool right = sheet.original[n] % 13 > 6 || n >= sheet.whole->vertices.size();
    if (right) at = {at[0] + 0.2, 0.3 * (at[0] - 0.5) + 0.05, at[2]};
  }
  Scene scene = scene_of(sheet.parts);
  scene.gravity = {};
  scene.cloths[0].seams = seams = sheet.seams;
  scene.cloths[0].velocity = {0.3, -0.2, 0.1};
  scene.cloths[0].spin = {0.3, 0.8, 0.5};
  return scene;
}

TEST(MeshSewing, KeepsMomentumAndClosesInTime) {
  for (const Way& way : kWays) {
    std::vector<Seam> seams;
    Scene scene = two_panels(seams);
    scene.solver = way.solver;
    scene.cloths[0].membrane = way.membrane;
    scene.time.substeps =
        200;  // what is told swings with the substep, and sweeps lose some spin by it
    Simulation run(scene, {.threads = 1});
    const Report before = run.report();
    for (int n = 0; n < 30; ++n) run.advance_frame();
    const Report closed = run.report();
    EXPECT_LT(widest(run, seams), 1e-6) << way.name;
    for (int n = 0; n < 60; ++n) run.advance_frame();
    const Report after = run.report();
    EXPECT_TRUE(after.finite);
    EXPECT_LT(widest(run, seams), 1e-6) << way.name;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(after.momentum[k], before.momentum[k], 2e-6) << way.name;
      EXPECT_NEAR(after.angular_momentum[k], before.angular_momentum[k], 1e-4) << way.name;
    }
    // Closed, a seam puts nothing in.
    EXPECT_LT(after.energy.total, 1.01 * closed.energy.total) << way.name;
  }
}

// Seams draw two panels together with as much energy, and as fast, as they do with forces.
TEST(MeshSewing, SecondOrderDrawsAsSpringsDo) {
  for (const int points : {9, 25}) {
    CutSheet sheet = cut_in_two({.nx = points, .ny = points});
    for (std::size_t n = 0; n < sheet.original.size(); ++n)
      if (sheet.original[n] % points > points / 2 || n >= sheet.whole->vertices.size())
        sheet.parts->vertices[n][0] += 0.3;
    for (const Membrane& membrane : {Membrane{}, kCanvas}) {
      const auto draw = [&](const Solver& solver, int substeps) {
        Scene scene = scene_of(sheet.parts);
        scene.gravity = {};
        scene.solver = solver;
        scene.time.substeps = substeps;
        scene.cloths[0].seams = sheet.seams;
        if (!membrane.given()) scene.cloths[0].stiffness.structural = 500;
        scene.cloths[0].membrane = membrane;
        Simulation run(scene, {.threads = 1});
        double most = 0;
        for (int n = 0; n < 13; ++n) {
          run.advance_frame();
          most = std::max(most, run.report().energy.total);
        }
        return most;
      };
      const double springs = draw(by(Method::spring), kAutoSubsteps);
      for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line})
        EXPECT_NEAR(draw(projected(2, sweep, 1), 64), springs, 0.15 * springs)
            << points << " points, sweep " << int(sweep);
    }
  }
}

// What is cut and sewn again hangs and swings as the sheet in one piece does.
TEST(MeshSewing, IsAsTheSheetInOnePiece) {
  const MadeUpMesh made{.nx = 17, .ny = 17, .shift = 0.2};
  const CutSheet sheet = cut_in_two(made);
  for (const Way& way : kWays) {
    const auto hang = [&](std::shared_ptr<const TriangleMesh> mesh, bool sewn) {
      Scene scene = scene_of(std::move(mesh));
      scene.solver = way.solver;
      scene.cloths[0].membrane = way.membrane;
      // In longer ones strands may lead a sheet into another fold where they end at a seam.
      if (way.solver.method == Method::compliant) scene.time.substeps = 60;
      scene.cloths[0].drag = 3;
      scene.cloths[0].pins = {{0, 0, {}}, {16, 0, {}}};
      if (sewn) scene.cloths[0].seams = sheet.seams;
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 240; ++n) run.advance_frame();
      if (sewn) {
        EXPECT_LT(widest(run, sheet.seams), 1e-6) << way.name;
      }
      return positions_of(run);
    };
    const std::vector<Vec3> whole = hang(sheet.whole, false), sewn = hang(sheet.parts, true);
    double sum = 0;
    for (std::size_t n = 0; n < sewn.size(); ++n) {
      const double off = distance(sewn[n], whole[std::size_t(sheet.original[n])]);
      sum += off * off;
    }
    const double rms = std::sqrt(sum / double(sewn.size()));
    RecordProperty(std::string("rms ") + way.name, std::to_string(rms));
    // Strands end at a seam.
    EXPECT_LT(rms, way.solver.sweep == Sweep::line ? 1e-3 : 5e-4) << way.name;
  }
}

TEST(MeshSewing, PinsHoldSeamsAndWhatStaysOpenIsTold) {
  std::vector<Seam> seams;
  Scene scene = two_panels(seams);
  scene.cloths[0].velocity = scene.cloths[0].spin = {};
  scene.cloths[0].drag = 5;
  const auto [a, b] = seams[4];
  scene.cloths[0].pins = {{a, 0, {}}};
  {
    Simulation run(scene, {.threads = 1});
    const Vec3 held = positions_of(run)[std::size_t(a)];
    for (int n = 0; n < 60; ++n) run.advance_frame();
    const auto x = positions_of(run);
    EXPECT_EQ(x[std::size_t(a)], held);
    EXPECT_EQ(x[std::size_t(b)], held);  // one pinned end pulls the other
    EXPECT_LT(widest(run, seams), 1e-6);
    for (const std::string& note : run.plan().notes)
      EXPECT_EQ(note.find("seams are open"), std::string::npos) << note;
  }
  scene.cloths[0].pins.push_back({b, 0, {}});
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 60; ++n) run.advance_frame();
  EXPECT_NEAR(widest(run, seams), 0.2, 0.02);
  const auto told = [&] {
    return std::count_if(run.plan().notes.begin(), run.plan().notes.end(), [](const auto& note) {
      return note.find("1 of 9 seams are open") != std::string::npos;
    });
  };
  EXPECT_EQ(told(), 1);
  run.advance_frame();
  EXPECT_EQ(told(), 1);  // once, whenever it is asked
}

TEST(MeshSewing, AHandTakesBothEnds) {
  std::vector<Seam> seams;
  Scene scene = two_panels(seams);
  scene.cloths[0].drag = 3;
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 30; ++n) run.advance_frame();
  const auto [a, b] = seams[4];
  const Vec3 start = positions_of(run)[std::size_t(a)];
  run.grab(0, a, {start[0], start[1] + 0.3, start[2]}, 500);
  for (int n = 0; n < 30; ++n) run.advance_frame();
  const auto x = positions_of(run);
  EXPECT_GT(x[std::size_t(b)][1], start[1] + 0.2);
  EXPECT_LT(widest(run, seams), 1e-6);
  run.release();
  run.pin(0, b);
  const Vec3 held = positions_of(run)[std::size_t(b)];
  for (int n = 0; n < 10; ++n) run.advance_frame();
  EXPECT_EQ(positions_of(run)[std::size_t(a)], held);
}

// Where cloth lies between the ends they are drawn through it, and it comes apart again.
TEST(MeshSewing, ClosesABagAboutABall) {
  const SceneFile file = read_scene(std::string(WEFT_SOURCE_DIR) + "/scenes/bag.json");
  ASSERT_TRUE(file.faults.empty());
  Simulation run(file.scene, {.threads = 2});
  for (int n = 0; n < 75; ++n) run.advance_frame();
  const Report report = run.report();
  EXPECT_TRUE(report.finite);
  EXPECT_EQ(report.penetration.crossings, 0);
  EXPECT_LT(report.penetration.collider_max, 1e-3);
  EXPECT_LT(report.strain.max, 0.15);
  for (const std::string& note : run.plan().notes)
    EXPECT_EQ(note.find("seams are open"), std::string::npos) << note;
}

TEST(MeshSewing, HasOneHash) {
  for (const Way& way : kWays) {
    std::vector<Seam> seams;
    Scene scene = two_panels(seams);
    scene.gravity = {0, -9.81, 0};
    scene.solver = way.solver;
    scene.cloths[0].membrane = way.membrane;
    scene.wind = {{2, 1, 0}, 0.4, 0.2, 0, {}};
    scene.colliders.emplace_back().shape = Plane{{0, -0.2, 0}, {0, 1, 0}};
    scene.cloths[0].self_collision = {SelfCollisionMode::surface, 0.01};
    scene.cloths[0].strain_limit = 0.1;
    std::uint64_t hash = 0;
    for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512})
      for (const int threads : {1, 3}) {
        if (!simd_available(simd)) continue;
        Simulation run(scene, {.threads = threads, .simd = simd});
        for (int n = 0; n < 15; ++n) run.advance_frame();
        EXPECT_TRUE(run.status().ok);
        if (hash == 0) hash = run.hash();
        EXPECT_EQ(run.hash(), hash) << way.name << ", " << simd_name(simd) << ", " << threads;
      }
  }
}

TEST(MeshSewing, GoesOnFromASnapshot) {
  std::vector<Seam> seams;
  const Scene scene = two_panels(seams);
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 6; ++n) run.advance_frame();
  EXPECT_GT(widest(run, seams), 0.01);
  const Snapshot middle = run.snapshot();
  run.restore(middle);
  for (int n = 0; n < 20; ++n) run.advance_frame();
  Simulation other(scene, {.threads = 1});
  other.restore(middle);
  for (int n = 0; n < 20; ++n) other.advance_frame();
  EXPECT_EQ(other.hash(), run.hash());
  EXPECT_LT(widest(other, seams), 1e-6);
}

// The mirror image comes together as the mirror image does.
TEST(MeshSewing, KeepsMirrorImages) {
  for (const Way& way : kWays) {
    std::vector<Seam> seams;
    Scene scene = two_panels(seams);
    scene.solver = way.solver;
    scene.cloths[0].membrane = way.membrane;
    scene.cloths[0].velocity = scene.cloths[0].spin = {};
    Scene image = scene;
    auto mesh = std::make_shared<TriangleMesh>(*scene.cloths[0].mesh.shape);
    for (Vec3& at : mesh->vertices) at[1] = -at[1];
    image.cloths[0].mesh.shape = mesh;
    Simulation run(scene, {.threads = 1}), mirrored(image, {.threads = 1});
    for (int n = 0; n < 20; ++n) run.advance_frame(), mirrored.advance_frame();
    const auto x = positions_of(run), y = positions_of(mirrored);
    for (std::size_t n = 0; n < x.size(); ++n)
      EXPECT_LT(distance(x[n], {y[n][0], -y[n][1], y[n][2]}), 1e-5) << way.name;
  }
}

// A thickness of more than an edge does not push apart what lies beside a seam.
TEST(MeshSewing, ContactLeavesASeamTogether) {
  const CutSheet sheet = cut_in_two({.nx = 17, .ny = 9, .shift = 0.2});
  for (const SelfCollisionMode mode : {SelfCollisionMode::particles, SelfCollisionMode::surface})
    for (const double thickness : {0.02, 0.09}) {
      Scene scene = scene_of(std::make_shared<TriangleMesh>(*sheet.parts));
      // Far apart in the file, so that only seams tell that they are neighbours.
      auto apart = std::make_shared<TriangleMesh>(*sheet.parts);
      std::vector<double> flat;
      for (std::size_t n = 0; n < sheet.original.size(); ++n) {
        const Vec3& at = sheet.parts->vertices[n];
        flat.insert(flat.end(), at.begin(), at.end());
        const bool right = sheet.original[n] % 17 > 8 || n >= sheet.whole->vertices.size();
        if (right) apart->vertices[n][0] += 1;
      }
      scene.cloths[0].mesh.shape = apart;
      scene.cloths[0].seams = sheet.seams;
      scene.cloths[0].self_collision = {mode, thickness};
      scene.gravity = {};
      Simulation run(scene, {.threads = 1});
      run.set_state(flat, std::vector<double>(flat.size()));
      for (int n = 0; n < 10; ++n) run.advance_frame();
      const auto x = positions_of(run);
      double most = 0;
      for (std::size_t n = 0; n < x.size(); ++n)
        most = std::max(most, distance(x[n], sheet.parts->vertices[n]));
      EXPECT_LT(most, 1e-5) << int(mode) << ", " << thickness;
      const Report report = run.report();
      EXPECT_EQ(report.penetration.self_pairs, 0) << int(mode) << ", " << thickness;
      EXPECT_EQ(report.penetration.crossings, 0) << int(mode) << ", " << thickness;
    }
}

TEST(MeshSewing, Rests) {
  CutSheet sheet = cut_in_two({.nx = 13, .ny = 9});
  for (std::size_t n = sheet.whole->vertices.size(); n < sheet.original.size(); ++n)
    sheet.parts->vertices[n][1] += 0.03;
  Scene scene = scene_of(sheet.parts);
  scene.solver.method = Method::compliant;
  scene.solver.sleep = 0.02;
  scene.cloths[0].seams = sheet.seams;
  scene.cloths[0].drag = 5;
  Collider& floor = scene.colliders.emplace_back();
  floor.shape = Plane{{0, -0.01, 0}, {0, 1, 0}};
  floor.friction.statik = floor.friction.dynamic = 0.5;
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 240; ++n) run.advance_frame();
  EXPECT_EQ(run.report().asleep, std::int64_t(sheet.original.size()));
  EXPECT_LT(widest(run, sheet.seams), 1e-6);
}

TEST(MeshSewing, GroupsLieInNeighbouringRows) {
  const auto mesh = made_up({.nx = 60, .ny = 40});
  const int count = int(mesh->vertices.size());
  const std::vector<std::vector<int>> sewn{{0, count - 1}, {59, count - 60, count / 2}};
  const physics::MeshOrder order = physics::order_of(*mesh, sewn);
  EXPECT_GT(order.counts.size(), 3u);
  const auto row = [&](int v) { return order.rows[std::size_t(v)]; };
  for (const auto& group : sewn)
    for (const int a : group)
      for (const int b : group) EXPECT_LE(std::abs(row(a) - row(b)), 1);
  for (const auto& t : mesh->triangles)
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(std::abs(row(t[k]) - row(t[(k + 1) % 3])), 1);
}

}  // namespace
}  // namespace weft
