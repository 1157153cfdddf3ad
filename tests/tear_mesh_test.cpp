// Tearing and cutting of meshes: what does not tear is not changed, what is too long or in a cutter's way ends, and
// all of it comes back with a state; the same bits for any threads.
#include "cases.h"
#include "folder.h"
#include "machines.h"
#include "made_up_bodies.h"
#include "physics/kernels/kernels.h"
#include "physics/model/mesh/mesh_tearing.h"
#include "torn_meshes.h"
#include "weft/mesh.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

using physics::Joined;

TEST(TearMesh, WhatDoesNotTearMovesBitForBitAsIfItCouldNot) {
  for (const Way& way : ways()) {
    Scene scene = tug(way, 0);
    scene.gravity = {0, -9.81, 0};
    scene.cloths[0].pins = {{0, 0, {}}, {30, 0, {}}};
    scene.wind = {{3, 1, 0}, 0.5, 0.2, 0};
    scene.colliders.push_back(collider_of(Sphere{{1.5, -0.3, 0.5}, 0.1}));
    Scene tearable = scene;
    tearable.cloths[0].tear_strain = 50;
    Simulation a(scene, {.threads = 1}), b(tearable, {.threads = 2});
    advance(a, 0.5);
    advance(b, 0.5);
    EXPECT_EQ(a.hash(), b.hash()) << way.name;
    EXPECT_EQ(b.report().torn, 0);
    EXPECT_EQ(b.view().cloths[0].topology_version, 1u);
  }
}

// A vertex that two cuts leave alone between pieces goes with the one that is larger there.
// A cutter is large enough for the mean edge, which is known once the mesh has been read.
TEST(TearMesh, CuttersComeFromSceneFiles) {
  const Folder folder;
  folder.write("m.obj", write_obj(*made_up({.nx = 21, .ny = 21})));
  for (const double radius : {0.01, 1e-5}) {
    folder.write("s.json", R"({"weft": 1, "cloths": [{"mesh": {"file": "m.obj"}}], "colliders":
        [{"sphere": {"radius": )" +
                               std::to_string(radius) + R"(}, "cuts": true, "offset": 0}]})");
    const SceneFile file = read_scene(folder / "s.json");
    ASSERT_EQ(file.faults.size(), radius == 0.01 ? 0u : 1u);
    for (const Fault& fault : file.faults) EXPECT_EQ(fault.place, "/colliders/0/cuts");
  }
}

// Strands know nothing of tears.
TEST(TearMesh, AMembraneThatCanTearHasNoStrands) {
  Scene scene = tug(ways().back(), 0.02);
  EXPECT_TRUE(validate(scene).empty());
  scene.solver.sweep = Sweep::line;
  ASSERT_EQ(validate(scene).size(), 1u);
  EXPECT_EQ(validate(scene)[0].place, "/solver/sweep");
  scene.cloths[0].tear_strain = 0;
  EXPECT_TRUE(validate(scene).empty());
  Collider cutter = collider_of(Sphere{{0.5, 0, -0.5}, 0.03});
  cutter.cuts = true;
  scene.colliders.push_back(cutter);
  ASSERT_EQ(validate(scene).size(), 1u);
  scene.solver.sweep = Sweep::gauss_seidel;
  EXPECT_TRUE(validate(scene).empty());
}

// Colours run in their place, and a note says so.
TEST(TearMesh, StrandsOfAMembraneAreLeftWhenItIsCut) {
  Scene scene = tug(ways().back(), 0);
  scene.solver.sweep = Sweep::line;
  Simulation run(scene, {.threads = 1});
  draw_apart(run, *scene.cloths[0].mesh.shape, 1);
  for (int n = 0; n < 5; ++n) run.advance_frame();
  EXPECT_GT(run.cut({1.5, -1, -1}, {1.5, 1, 2}, 0.2), 0);
  for (int n = 0; n < 30; ++n) run.advance_frame();
  EXPECT_TRUE(run.status().ok);
  EXPECT_TRUE(std::ranges::any_of(
      run.plan().notes, [](const std::string& n) { return n.find("strands") != n.npos; }));
}

TEST(TearMesh, AGasKeepsItsMeshWhole) {
  Scene scene = scene_of(tests::ball(12, 8, 0.2));
  scene.cloths[0].pressure.inflate = 1.2;
  Simulation run(scene, {.threads = 1});
  run.advance_frame();
  EXPECT_EQ(run.cut({-1, 0, 0}, {1, 0, 0}, 0.5), 0);
  run.advance_frame();
  EXPECT_EQ(run.report(false).torn, 0);
  EXPECT_TRUE(std::ranges::any_of(run.plan().notes,
                                  [](const std::string& n) { return n.find("gas") != n.npos; }));
  scene.cloths[0].tear_strain = 0.1;
  EXPECT_THROW(Simulation{scene}, SceneError);
}

TEST(TearMesh, NoVertexHoldsPiecesTogetherAlone) {
  const auto mesh = made_up({.nx = 9, .ny = 9, .diagonals = Diagonals::alike});
  for (const bool membrane : {false, true}) {
    Scene scene = scene_of(mesh);
    if (membrane) scene.cloths[0].membrane = kCanvas;
    Simulation run(scene, {.threads = 1});
    run.cut({-1, 0, 0.52}, {0.48, 0, 0.52}, 1e-3);
    run.cut({0.52, 0, 0.48}, {2, 0, 0.48}, 1e-3);
    const ClothView view = run.view().cloths[0];
    // Triangles about every vertex hang together by edges.
    std::vector<std::vector<std::set<std::uint32_t>>> about(view.x.size());
    for (const auto& t : view.triangles)
      for (std::size_t k = 0; k < 3; ++k) about[t[k]].push_back({t[(k + 1) % 3], t[(k + 2) % 3]});
    for (auto& pairs : about) {
      for (std::size_t n = 1; n < pairs.size(); ++n)
        for (std::size_t m = n; m < pairs.size(); ++m)
          if (std::any_of(pairs[m].begin(), pairs[m].end(),
                          [&](std::uint32_t v) { return pairs[0].contains(v); })) {
            pairs[0].insert(pairs[m].begin(), pairs[m].end());
            std::swap(pairs[m], pairs[n]);
            break;
          }
      for (const auto& pair : pairs)
        EXPECT_TRUE(std::includes(pairs[0].begin(), pairs[0].end(), pair.begin(), pair.end()));
    }
  }
}

TEST(TearMesh, WhatIsTooLongTearsAtOnce) {
  for (const Way& way : ways()) {
    Scene scene = tug(way, 0.02);
    scene.time.frame = 2e-4;
    scene.time.substeps = way.name == std::string("springs") ? 1 : kAutoSubsteps;
    const TriangleMesh& mesh = *scene.cloths[0].mesh.shape;
    // Sweeps measure an edge in their midst, not at their end.
    const double slack = scene.solver.method == Method::compliant ? 5e-3 : 1e-4;
    Simulation run(scene, {.threads = 1});
    draw_apart(run, mesh, 3);
    std::set<Joined> before;
    for (int n = 0; n < 200; ++n) {
      run.advance_frame();
      const auto x = positions_of(run);
      const Snapshot now = run.snapshot();
      const std::set<Joined> gone(now.cloths[0].torn.begin(), now.cloths[0].torn.end());
      for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
          const double rest =
              distance(mesh.vertices[std::size_t(a)], mesh.vertices[std::size_t(b)]);
          const double length = distance(x[std::size_t(a)], x[std::size_t(b)]);
          ASSERT_TRUE(length <= (1.02 + slack) * rest || gone.contains({a, b}))
              << way.name << ", frame " << n;
        }
      ASSERT_TRUE(std::includes(gone.begin(), gone.end(), before.begin(), before.end()));
      before = gone;
    }
    EXPECT_GT(before.size(), 8u) << way.name;
  }
}

TEST(TearMesh, CutterCutsItsWay) {
  for (const Way& way : ways()) {
    Scene scene = scene_of(made_up({.nx = 21, .ny = 21, .shift = 0.2}));
    way.set(scene);
    scene.gravity = {};
    Collider cutter = collider_of(Sphere{{0.5, 0, -0.5}, 0.03});
    cutter.cuts = true;
    cutter.keys = {{0.1, {0.5, 0, -0.5}}, {0.6, {0.5, 0, 1.5}}};
    scene.colliders.push_back(cutter);
    Simulation run(scene, {.threads = 2});
    advance(run, 0.2);
    EXPECT_EQ(run.report().torn, 0);
    advance(run, 0.7);
    const std::vector<int> piece = pieces_of(*scene.cloths[0].mesh.shape, run.snapshot());
    EXPECT_NE(piece[0], piece[20]) << way.name;
    EXPECT_LT(run.report().torn, 300) << way.name;
  }
}

TEST(TearMesh, TheSameBitsForAnyThreadsAndInstructionSet) {
  Cases cases(2);
  for (const Way& way : ways()) {
    if (!cases.next()) continue;
    std::uint64_t hash = 0;
    std::vector<Joined> torn;
    for (const Options& options : machines()) {
      Scene scene = tug(way, 0.02);
      scene.cloths[0].mesh.shape =
          made_up({.nx = 81, .ny = 61, .width = 3, .shift = 0.2, .shuffled = true});
      scene.wind = {{0, 2, 1}, 0.5, 0.1, 0.3};
      Simulation run(scene, options);
      draw_apart(run, *scene.cloths[0].mesh.shape, 2);
      for (int n = 0; n < 6; ++n) run.advance_frame();
      if (hash == 0) hash = run.hash(), torn = run.snapshot().cloths[0].torn;
      EXPECT_EQ(run.hash(), hash) << way.name << ", " << options.threads;
      EXPECT_EQ(run.snapshot().cloths[0].torn, torn) << way.name;
    }
    EXPECT_GT(torn.size(), 30u) << way.name;
  }
}

// What a snapshot has torn is gone, and what it has not is whole; then both go the same way.
TEST(TearMesh, StatesComeBack) {
  for (const Way& way : ways()) {
    const Scene scene = tug(way, 0.02);
    Simulation run(scene, {.threads = 1}), fresh(scene, {.threads = 1});
    draw_apart(run, *scene.cloths[0].mesh.shape, 1.5);
    const Snapshot whole = run.snapshot();
    while (run.report(false).torn == 0 && run.frame() < 60) run.advance_frame();
    const Snapshot torn = run.snapshot();
    for (int n = 0; n < 3; ++n) run.advance_frame();
    run.restore(torn);
    fresh.restore(torn);
    EXPECT_EQ(run.snapshot().cloths[0].torn, torn.cloths[0].torn);
    EXPECT_EQ(fresh.report().energy.elastic, run.report().energy.elastic) << way.name;
    EXPECT_EQ(fresh.view().cloths[0].triangles.size(), run.view().cloths[0].triangles.size());
    run.advance_frame();
    fresh.advance_frame();
    EXPECT_EQ(run.hash(), fresh.hash()) << way.name;
    run.restore(whole);
    EXPECT_EQ(run.report().torn, 0);
    EXPECT_EQ(run.view().cloths[0].triangles.size(), scene.cloths[0].mesh.shape->triangles.size());
    fresh.restore(whole);
    Simulation other(scene, {.threads = 1});
    other.restore(whole);
    for (Simulation* s : {&run, &fresh, &other}) s->advance_frame();
    EXPECT_EQ(run.hash(), other.hash()) << way.name;
    EXPECT_EQ(fresh.hash(), other.hash()) << way.name;
  }
}

// A frame that is run again begins with all edges that it had.
TEST(TearMesh, WhatAFrameHasTornComesBackWithItsStart) {
  Scene scene = tug(ways()[3], 0.5);
  const auto model =
      physics::make_model(scene, 0, Method::spring, 1, physics::kernel_table(Simd::scalar));
  physics::MeshTearing& tearing = *model->mesh_tearing();
  tearing.end_all({{0, 1}});
  const auto before = tearing.torn_list();
  physics::Particles& p = model->particles();
  p.x.at(1, 0, 3) += 0.01f;
  const double energy = model->elastic_energy().sum();
  tearing.remember();
  for (int e = 20; e < 60; ++e) tearing.end(e);
  EXPECT_LT(model->elastic_energy().sum(), energy);
  tearing.go_back();
  EXPECT_FALSE(tearing.update());
  EXPECT_EQ(tearing.torn_list(), before);
  EXPECT_EQ(model->elastic_energy().sum(), energy);
}

// What is shown of a flat sheet that is cut still is all of it; with holes, triangles in the way are missing.
TEST(TearMesh, ATearShowsAsALineAndNotAsAHole) {
  const auto area = [](const ClothView& c) {
    double sum = 0;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& d) {
      const Vec3 n = cross(minus(b, a), minus(d, a));
      sum += 0.5 * length(n);
    };
    const auto corner = [&](std::uint32_t p) { return Vec3{c.x[p], c.y[p], c.z[p]}; };
    const auto point = [&](std::uint32_t p) {
      return Vec3{c.tear_points[p][0], c.tear_points[p][1], c.tear_points[p][2]};
    };
    for (const auto& t : c.triangles) add(corner(t[0]), corner(t[1]), corner(t[2]));
    for (const auto& t : c.tear_triangles) add(point(t[0]), point(t[1]), point(t[2]));
    return sum;
  };
  for (const Tears tears : {Tears::split, Tears::holes}) {
    Scene scene = scene_of(made_up({.nx = 20, .ny = 20, .shift = 0.2}));
    scene.cloths[0].tears = tears;
    Simulation run(scene, {.threads = 1});
    EXPECT_NEAR(area(run.view().cloths[0]), 1, 1e-5);
    run.cut({-1, 0, 0.3}, {0.6, 0, 0.7}, 1e-4);
    run.cut({0.3, 0, -1}, {0.3, 0, 2}, 1e-4);
    if (tears == Tears::split)
      EXPECT_NEAR(area(run.view().cloths[0]), 1, 0.004);
    else
      EXPECT_LT(area(run.view().cloths[0]), 0.95);
  }
}

// Seams, strain limits, contact, pins on paths and sleep beside what tears.
TEST(TearMesh, GoesWithAllElse) {
  Cases cases(3);
  for (const Way& way : ways())
    for (const SelfCollisionMode mode :
         {SelfCollisionMode::particles, SelfCollisionMode::surface}) {
      if (!cases.next()) continue;
      Scene scene = tug(way, 0.05);
      Cloth& cloth = scene.cloths[0];
      scene.gravity = {0, -9.81, 0};
      scene.solver.sleep = 0.01;
      cloth.strain_limit = 0.04;
      cloth.self_collision.mode = mode;
      cloth.self_collision.thickness = 0.03;
      for (int j = 0; j < 9; ++j)
        for (const int i : {0, 30})
          cloth.pins.push_back(
              {31 * j + i,
               0,
               {{0, {i / 10.0, 0, j / 8.0}}, {1, {i / 10.0 + (i > 0 ? 1 : -1), 0, j / 8.0}}}});
      cloth.seams = {{62 + 15, 0}};
      scene.colliders.push_back(collider_of(Sphere{{1.5, -0.2, 0.5}, 0.1}, 0.3));
      Simulation run(scene, {.threads = 2});
      for (int n = 0; n < 40; ++n) {
        run.advance_frame();
        ASSERT_TRUE(run.status().ok) << way.name << ": " << run.status().text;
      }
      EXPECT_GT(run.report().torn, 8) << way.name;
    }
}

}  // namespace
}  // namespace weft
