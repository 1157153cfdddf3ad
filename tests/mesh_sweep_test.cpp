// Meshes by methods that project: sweeps beside double precision, laws of motion, symmetry, the same bits
// everywhere, rest and motion of the explicit method, beams and limits.
#include <gtest/gtest.h>

#include "mesh_oracle.h"
#include "mesh_scenes.h"
#include "weft/vec3.h"

namespace weft {
namespace {

const Way kWays[] = {{"colours", Sweep::gauss_seidel, 1, 1, 0},
                     {"colours, three times", Sweep::gauss_seidel, 1, 3, 0},
                     {"colours of the second order", Sweep::gauss_seidel, 2, 2, 0},
                     {"colours that bend", Sweep::gauss_seidel, 1, 1, 1e-4},
                     {"strands", Sweep::line, 1, 1, 0},
                     {"strands, twice, that bend", Sweep::line, 1, 2, 1e-4},
                     {"strands of the second order", Sweep::line, 2, 1, 2e-5}};

Scene projected(std::shared_ptr<const TriangleMesh> mesh, const Way& way) {
  Scene scene = scene_of(std::move(mesh));
  scene.solver.method = Method::compliant;
  scene.solver.sweep = way.sweep;
  scene.solver.order = way.order;
  scene.solver.iterations = way.iterations;
  scene.cloths[0].bending = way.bending;
  scene.time.substeps = 16;
  return scene;
}

TEST(MeshSweep, DoesWhatTheEquationsSay) {
  const auto mesh = made_up({.nx = 9, .ny = 8, .shift = 0.3, .shuffled = true});
  for (const Way& way : kWays) {
    if (way.order == 2) continue;
    Scene scene = projected(mesh, way);
    scene.time = {0.004, 4, 1};
    scene.cloths[0].drag = 0.5;
    scene.cloths[0].pins = {{5, 0, {}}, {40, 0, {}}};
    Simulation run(scene, {.threads = 1});
    const std::vector<Vec3> rounded = rumple(run, *mesh, 0.004, 7);
    EdgeOracle oracle(scene, rounded);
    run.advance_frame();
    for (int n = 0; n < 4; ++n) oracle.substep(n == 0);
    EXPECT_GT(farthest(rounded, positions_of(run)), 1e-3) << way.name;
    EXPECT_LT(farthest(oracle.positions(), positions_of(run)), 2e-6) << way.name;
  }
}

TEST(MeshSweep, KeepsMomentum) {
  const auto mesh = made_up({.nx = 15, .ny = 13, .shift = 0.3});
  for (const Way& way : kWays) {
    Scene scene = projected(mesh, way);
    scene.gravity = {};
    scene.cloths[0].velocity = {0.3, 0.1, -0.2};
    scene.cloths[0].spin = {0.5, 1, 0.2};
    Simulation run(scene, {.threads = 1});
    const std::vector<double> v = run.velocities();
    run.set_state(flat(rumpled(*mesh, 0.005, 5)), v);
    const Report before = run.report();
    for (int n = 0; n < 20; ++n) run.advance_frame();
    const Report after = run.report();
    // Strands find velocities from positions, which are rounded: 3e-8 m a substep, of each of 195 particles
    // at random, is 1e-5 N·s by then.
    const double rounding = way.sweep == Sweep::line ? 1e-4 : 5e-6;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(after.momentum[k], before.momentum[k], rounding) << way.name;
      // The second order is not central about where particles were.
      if (way.order == 2) continue;
      EXPECT_NEAR(after.angular_momentum[k], before.angular_momentum[k],
                  0.01 * std::abs(before.angular_momentum[1]))
          << way.name;
    }
    EXPECT_LT(after.energy.total, before.energy.total) << way.name;
  }
}

// What is mirrored moves as its mirror image does, to the last bit.
TEST(MeshSweep, KnowsNoLeftAndRight) {
  const auto mesh = made_up({.nx = 14, .ny = 12, .shift = 0.3, .shuffled = true});
  auto image = std::make_shared<TriangleMesh>(*mesh);
  for (Vec3& p : image->vertices) p[0] = -p[0];
  for (auto& [a, b, c] : image->triangles) std::swap(b, c);
  for (const Way& way : kWays) {
    std::vector<Vec3> x[2];
    for (const bool mirrored : {false, true}) {
      Scene scene = projected(mirrored ? image : mesh, way);
      scene.gravity = {mirrored ? -1.0 : 1.0, -9, 2};
      scene.cloths[0].pins = {{3, 0, {}}, {100, 0, {}}};
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 10; ++n) run.advance_frame();
      x[mirrored] = positions_of(run);
    }
    // A triangle's corners come in another order, and so what bending adds up.
    const double off = way.bending > 0 ? 1e-4 : 0;
    for (std::size_t n = 0; n < x[0].size(); ++n) {
      EXPECT_NEAR(x[1][n][0], -x[0][n][0], off) << way.name;
      EXPECT_NEAR(x[1][n][1], x[0][n][1], off) << way.name;
    }
  }
}

TEST(MeshSweep, IsTheSameOnAnyThreadsAndInstructionSets) {
  const auto mesh = made_up({.nx = 37, .ny = 29, .shift = 0.3, .shuffled = true});
  for (const Way& way : kWays) {
    Scene scene = projected(mesh, way);
    scene.cloths[0].strain_limit = 0.02;
    scene.cloths[0].pins = {{3, 0, {{0, mesh->vertices[3]}, {0.1, {0, 0.1, 0}}}}, {700, 0, {}}};
    scene.colliders.push_back({Sphere{{0.5, -0.26, 0.5}, 0.25}, {}, 0.01, {}, false});
    scene.wind = {{2, 1, 3}, 0.4, 0.2, 0.5};
    scene.solver.sleep = 0.001;
    // In fine ones the second order keeps what rounding leaves.
    for (const auto& [frame, frames] : {std::pair{1.0 / 60, 6}, {1.0 / 660, 3}}) {
      if (frames == 3 && way.order == 1) continue;
      scene.time.frame = frame;
      std::uint64_t hash = 0;
      for (const int threads : {1, 2, 3})
        for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512}) {
          if (!simd_available(simd) || (threads > 1 && simd != Simd::avx2)) continue;
          Simulation run(scene, {.threads = threads, .simd = simd});
          for (int n = 0; n < frames; ++n) run.advance_frame();
          ASSERT_TRUE(run.status().ok) << run.status().text;
          const std::uint64_t now = run.report().hash;
          if (hash == 0) hash = now;
          EXPECT_EQ(now, hash) << way.name << ", " << threads << ", " << simd_name(simd);
        }
    }
  }
}

// With many substeps it moves as springs do; and comes to the same rest with few.
TEST(MeshSweep, GoesOverIntoSprings) {
  const auto mesh = made_up({.nx = 9, .ny = 9, .shift = 0.3});
  for (const Way& way : kWays) {
    const auto after = [&](Method method, int substeps, double drag, int frames) {
      Scene scene = projected(mesh, way);
      scene.solver.method = method;
      if (method == Method::spring) scene.solver = {};
      scene.time.substeps = substeps;
      scene.cloths[0].stiffness.structural = 300;
      scene.cloths[0].drag = drag;
      for (int n = 0; n < 9; ++n) scene.cloths[0].pins.push_back({n, 0, {}});
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < frames; ++n) run.advance_frame();
      return positions_of(run);
    };
    EXPECT_LT(farthest(after(Method::compliant, 1000, 1, 15), after(Method::spring, 1000, 1, 15)),
              way.order == 2 ? 2e-3 : 4e-3)
        << way.name;
    EXPECT_LT(farthest(after(Method::compliant, 100, 5, 300), after(Method::spring, 100, 5, 300)),
              1e-3)
        << way.name;
  }
}

// Springs, in the longest substeps that they can take, round least. However short those of the second order are, what
// positions and velocities lack by rounding does not add up.
TEST(MeshSweep, SecondOrderDoesNotRoundAwayFineSubsteps) {
  const auto mesh = made_up({.nx = 9, .ny = 9, .shift = 0.2});
  for (const bool membrane : {false, true}) {
    const auto hang = [&](const Solver& solver, int substeps) {
      Scene scene = scene_of(mesh);
      scene.solver = solver;
      scene.time.substeps = substeps;
      if (membrane)
        scene.cloths[0].membrane = {1000, 1000, 200, 200, 0};
      else
        scene.cloths[0].stiffness.structural = 1000;
      scene.cloths[0].bending = 1e-3;
      for (int i = 0; i < 9; ++i) scene.cloths[0].pins.push_back({i, 0, {}});
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 20; ++n) run.advance_frame();
      return positions_of(run);
    };
    Solver springs;
    springs.method = Method::spring;
    const std::vector<Vec3> truth = hang(springs, 60);
    for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line}) {
      Solver solver;
      solver.method = Method::compliant;
      solver.order = 2;
      solver.sweep = sweep;
      for (const int substeps : {400, 1600})
        EXPECT_LT(farthest(hang(solver, substeps), truth), 8e-6)
            << (membrane ? "membrane" : "springs") << ", sweep " << int(sweep) << ", " << substeps;
    }
  }
}

// As strips of the explicit method (mesh_laws_test).
TEST(MeshSweep, BendsAsABeamDoes) {
  for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line}) {
    const auto mesh =
        made_up({.nx = 21, .ny = 7, .width = 0.5, .height = 0.15, .diagonals = Diagonals::crossed});
    Scene scene = projected(mesh, {"", sweep, 1, 1, 0.02});
    Cloth& cloth = scene.cloths[0];
    cloth.stiffness.structural = 300;
    cloth.drag = 7.6;
    const double gravity = 0.08;
    scene.gravity = {0, -gravity, 0};
    scene.time.substeps = 64;
    for (std::size_t n = 0; n < mesh->vertices.size(); ++n)
      if (mesh->vertices[n][0] < 1.01 * 0.025) cloth.pins.push_back({int(n), 0, {}});
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 250; ++n) run.advance_frame();
    double tip = 0;
    const auto x = positions_of(run);
    for (std::size_t n = 0; n < x.size(); ++n)
      if (mesh->vertices[n][0] > 0.5 - 1e-9) tip -= x[n][1] / 7;
    EXPECT_NEAR(tip / (0.3 * gravity * std::pow(0.5 - 0.0125, 4) / (8 * 0.02)), 1, 0.02);
  }
}

// The same triangles as a grid's: one diagonal in each square, all of one stiffness.
TEST(MeshSweep, HangsAsTheSameGridDoes) {
  constexpr int n = 11;
  for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line}) {
    Scene mesh =
        projected(made_up({.nx = n, .ny = n, .diagonals = Diagonals::alike}), {"", sweep, 1, 1, 0});
    mesh.time.substeps = 200;
    mesh.cloths[0].stiffness = {500, 500, 0};
    mesh.cloths[0].drag = 2;
    mesh.gravity = {1, -9, 2};
    Scene grid = mesh;
    Cloth& cloth = grid.cloths[0];
    cloth.mesh = {};
    // From right to left, so that the diagonals go the way of the mesh's.
    cloth.grid.nx = cloth.grid.ny = n;
    cloth.grid.origin = {1, 0, 0};
    cloth.grid.u = {-1, 0, 0};
    cloth.level = 1;
    cloth.level_diagonals = LevelDiagonals::one;
    mesh.cloths[0].stiffness = {500, Cloth{}.stiffness.shear, Cloth{}.stiffness.bend};
    for (int i = 0; i < n; ++i) {
      cloth.pins.push_back({i, 0, {}});
      mesh.cloths[0].pins.push_back({i, 0, {}});
    }
    Simulation a(mesh, {.threads = 1}), b(grid, {.threads = 1});
    for (int frame = 0; frame < 20; ++frame) {
      a.advance_frame();
      b.advance_frame();
    }
    const auto x = positions_of(a), y = positions_of(b);
    double off = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const Vec3 e = minus(x[std::size_t(j * n + i)], y[std::size_t(j * n + n - 1 - i)]);
        off = std::max(off, length(e));
      }
    EXPECT_LT(off, 0.01);
  }
}

TEST(MeshSweep, KeepsToAStrainLimit) {
  const auto mesh = made_up({.nx = 21, .ny = 21, .shift = 0.3});
  for (const Method method : {Method::spring, Method::compliant}) {
    double strain[2];
    for (const bool limited : {false, true}) {
      Scene scene = scene_of(mesh);
      scene.solver.method = method;
      scene.cloths[0].stiffness.structural = 20;
      scene.cloths[0].drag = 1;
      scene.cloths[0].strain_limit = limited ? 0.05 : 0;
      for (int n = 0; n < 21; ++n) scene.cloths[0].pins.push_back({n, 0, {}});
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 60; ++n) run.advance_frame();
      ASSERT_TRUE(run.status().ok);
      strain[limited] = run.report().strain.max;
    }
    EXPECT_GT(strain[0], 0.15);
    EXPECT_LT(strain[1], 0.07);
  }
}

TEST(MeshSweep, TethersHold) {
  const auto mesh = made_up({.nx = 21, .ny = 21, .shift = 0.3});
  for (const Way& way : kWays) {
    Scene scene = projected(mesh, way);
    scene.solver.tethers = true;
    scene.time.substeps = 8;
    scene.cloths[0].stiffness.structural = 1e5;
    scene.cloths[0].drag = 1;
    for (int n = 0; n < 21; ++n) scene.cloths[0].pins.push_back({n, 0, {}});
    Simulation run(scene, {.threads = 1});
    ASSERT_EQ(run.plan().stages[1].name, "tethers");
    EXPECT_EQ(run.plan().stages[1].items, 21 * 20);
    for (int n = 0; n < 60; ++n) run.advance_frame();
    ASSERT_TRUE(run.status().ok);
    EXPECT_FALSE(run.plan().fallback);
    const auto x = positions_of(run);
    // Sweeps come after, and may stretch an edge.
    for (int p = 21; p < 21 * 21; ++p)
      EXPECT_GT(x[std::size_t(p)][1], -mesh->vertices[std::size_t(p)][2] - 0.02) << way.name;
    EXPECT_LT(run.report().strain.max, 0.15) << way.name;
  }
}

// A ring of edges that goes round is cut where it meets itself; a fan of more edges than there are colours
// still runs.
TEST(MeshSweep, TakesTubesAndFans) {
  auto tube = std::make_shared<TriangleMesh>();
  constexpr int around = 12, along = 6;
  for (int j = 0; j < along; ++j)
    for (int i = 0; i < around; ++i)
      tube->vertices.push_back({0.2 * std::cos(i * 0.5236), 0.05 * j, 0.2 * std::sin(i * 0.5236)});
  for (int j = 0; j + 1 < along; ++j)
    for (int i = 0; i < around; ++i) {
      const int a = j * around + i, b = j * around + (i + 1) % around;
      tube->triangles.push_back({a, a + around, b});
      tube->triangles.push_back({b, a + around, b + around});
    }
  auto fan = std::make_shared<TriangleMesh>();
  fan->vertices.push_back({0, 0, 0});
  for (int i = 0; i < 100; ++i)
    fan->vertices.push_back({std::cos(i * 0.0628), 0, std::sin(i * 0.0628)});
  for (int i = 0; i < 100; ++i) fan->triangles.push_back({0, 1 + (i + 1) % 100, 1 + i});
  for (const auto& mesh : {tube, fan})
    for (const Way& way : kWays) {
      Scene scene = projected(mesh, way);
      scene.cloths[0].pins = {{0, 0, {}}};
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 30; ++n) run.advance_frame();
      ASSERT_TRUE(run.status().ok) << way.name;
      EXPECT_FALSE(run.plan().fallback) << way.name;
      EXPECT_LT(run.report().strain.max, 0.2) << way.name;
    }
}

}  // namespace
}  // namespace weft
