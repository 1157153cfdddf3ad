// Tearing and cutting of meshes: what cannot tear is not changed, what has torn obeys the laws of motion, goes as the
// equations without it say, and comes back with a state.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>

#include "contact_scenes.h"
#include "machines.h"
#include "mesh_scenes.h"
#include "physics/kernels/kernels.h"
#include "physics/model/mesh/mesh_tearing.h"
#include "physics/model/vector.h"

namespace weft {
namespace {

using physics::cross;
using physics::dot;
using physics::Joined;
using physics::minus;
using physics::plus;
using physics::times;

double distance(const Vec3& a, const Vec3& b) {
  const Vec3 e = minus(a, b);
  return std::sqrt(dot(e, e));
}

// Every way that a mesh is moved.
struct Way {
  const char* name;
  std::function<void(Scene&)> set;
};
std::vector<Way> ways() {
  std::vector<Way> all;
  for (const Material& m : kMaterials) all.push_back({m.name, m.set});
  const auto compliant = [](Scene& s) { s.solver.method = Method::compliant; };
  all.push_back({"compliant", compliant});
  all.push_back({"compliant that bends", [=](Scene& s) {
                   compliant(s);
                   s.solver.iterations = 2;
                   s.cloths[0].bending = 1e-4;
                 }});
  all.push_back({"line", [=](Scene& s) {
                   compliant(s);
                   s.solver.sweep = Sweep::line;
                   s.cloths[0].bending = 1e-4;
                 }});
  all.push_back({"second order", [=](Scene& s) {
                   compliant(s);
                   s.solver.order = 2;
                 }});
  return all;
}

std::vector<double> flat(const std::vector<Vec3>& x) {
  std::vector<double> all;
  for (const Vec3& p : x) all.insert(all.end(), p.begin(), p.end());
  return all;
}

// A strip along x, 3 m long, whose ends are drawn apart.
Scene tug(const Way& way, double strain) {
  Scene scene = scene_of(made_up({.nx = 31, .ny = 9, .width = 3, .shift = 0.2}));
  way.set(scene);
  scene.gravity = {};
  scene.cloths[0].tear_strain = strain;
  return scene;
}
void draw_apart(Simulation& run, const TriangleMesh& mesh, double speed) {
  std::vector<Vec3> v;
  for (const Vec3& p : mesh.vertices) v.push_back({speed * (p[0] - 1.5), 0, 0});
  run.set_state(run.positions(), flat(v));
}

// Pieces that edges which hold make, as a number for each vertex.
std::vector<int> pieces_of(const TriangleMesh& mesh, const Snapshot& now) {
  const std::set<Joined> torn(now.cloths[0].torn.begin(), now.cloths[0].torn.end());
  std::vector<int> piece(mesh.vertices.size());
  for (std::size_t n = 0; n < piece.size(); ++n) piece[n] = int(n);
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [a, b] = std::minmax(t[k], t[(k + 1) % 3]);
        int &p = piece[std::size_t(a)], &q = piece[std::size_t(b)];
        if (torn.contains({a, b}) || p == q) continue;
        p = q = std::min(p, q);
        changed = true;
      }
  }
  return piece;
}

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

// A strip whose ends fly apart tears in two or more, and each piece goes on by itself.
TEST(TearMesh, TornInTwoItKeepsMomentumAndGainsNoEnergy) {
  for (const Way& way : ways()) {
    const Scene scene = tug(way, 0.02);
    const TriangleMesh& mesh = *scene.cloths[0].mesh.shape;
    Simulation run(scene, {.threads = 1});
    draw_apart(run, mesh, 1);
    Report before = run.report();
    const Report first = before;
    for (int n = 0; n < 40; ++n) {
      run.advance_frame();
      ASSERT_TRUE(run.status().ok) << run.status().text;
      const Report now = run.report();
      const double total = first.energy.kinetic + first.energy.elastic;
      EXPECT_LT(now.energy.kinetic + now.energy.elastic,
                before.energy.kinetic + before.energy.elastic + 0.01 * total)
          << way.name << ", frame " << n;
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(now.momentum[k], first.momentum[k], 1e-5) << way.name << ", frame " << n;
        EXPECT_NEAR(now.angular_momentum[k], first.angular_momentum[k], 1e-5) << way.name;
      }
      before = now;
    }
    EXPECT_GT(before.torn, 8) << way.name;
    const std::vector<int> piece = pieces_of(mesh, run.snapshot());
    const int left = nearest_vertex(mesh, {0, 0, 0.5}), right = nearest_vertex(mesh, {3, 0, 0.5});
    EXPECT_NE(piece[std::size_t(left)], piece[std::size_t(right)]) << way.name;
    std::printf("%s: %lld torn\n", way.name, (long long)before.torn);
  }
}

TEST(TearMesh, MirroredItTearsAtTheSameEdges) {
  for (const Way& way : ways()) {
    Scene scene = tug(way, 0.02), mirrored = scene;
    auto mesh = std::make_shared<TriangleMesh>(*scene.cloths[0].mesh.shape);
    for (Vec3& p : mesh->vertices) p[2] = 1 - p[2];
    for (auto& t : mesh->triangles) std::swap(t[1], t[2]);
    mirrored.cloths[0].mesh.shape = mesh;
    Simulation a(scene, {.threads = 1}), b(mirrored, {.threads = 1});
    draw_apart(a, *scene.cloths[0].mesh.shape, 1);
    draw_apart(b, *mesh, 1);
    // Until the first has torn through: later, pieces shake, and rounding tells them apart.
    for (int n = 0; n < 60 && a.report(false).torn == 0; ++n) {
      a.advance_frame();
      b.advance_frame();
    }
    EXPECT_GT(a.report().torn, 0) << way.name;
    EXPECT_NEAR(double(a.report().torn), double(b.report().torn), 0.05 * double(a.report().torn))
        << way.name;
    const auto x = positions_of(a), y = positions_of(b);
    for (std::size_t p = 0; p < x.size(); ++p)
      EXPECT_LT(distance(x[p], {y[p][0], -y[p][1], 1 - y[p][2]}), 0.02) << way.name;
  }
}

// Cut along a line, a sheet goes on as the equations of what is left say: those of a mesh without the triangles in
// the way, in double precision.
TEST(TearMesh, CutItGoesAsTheEquationsOfWhatIsLeftSay) {
  const auto mesh = made_up({.nx = 23, .ny = 17, .shift = 0.3, .shuffled = true});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    scene.time = {2e-4, 8, 1};
    const Cloth& cloth = scene.cloths[0];
    std::mt19937 random(7);
    std::vector<Vec3> start = mesh->vertices;
    for (Vec3& p : start)
      for (double& value : p) value += 0.004 * (double(random()) / 2147483648.0 - 1);
    Simulation run(scene, {.threads = 1});
    EXPECT_GT(run.cut({-1, 0, 0.4}, {0.7, 0, 0.55}, 1e-3), 10);
    run.set_state(flat(start), std::vector<double>(3 * start.size()));
    const Snapshot cut = run.snapshot();
    const std::vector<Vec3> rounded = positions_of(run);
    run.advance_frame();

    const std::set<Joined> torn(cut.cloths[0].torn.begin(), cut.cloths[0].torn.end());
    const auto made_of =
        physics::material_of(cloth, scene.solver.method == Method::spring_friction);
    // Triangles that are whole, and springs of those that are not.
    TriangleMesh left{.vertices = mesh->vertices}, springs = left;
    std::vector<double> masses(start.size());
    for (const auto& r : physics::rest_triangles(*mesh, {mesh->vertices}, cloth.bending))
      for (std::size_t k = 0; k < 3; ++k)
        masses[std::size_t(r.corner[k])] += cloth.density * r.area / 3;
    for (const auto& t : mesh->triangles) {
      bool whole = true;
      for (std::size_t k = 0; k < 3; ++k)
        whole = whole &&
                !torn.contains({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
      (whole ? left : springs).triangles.push_back(t);
    }
    const auto triangles = physics::rest_triangles(left, {mesh->vertices}, cloth.bending);
    const auto accelerations = [&](const std::vector<Vec3>& x, const std::vector<Vec3>* v) {
      std::vector<Vec3> f(x.size());
      physics::add_mesh_forces(triangles, made_of, x, v, f);
      for (const auto& t : made_of.membrane ? decltype(springs.triangles){} : springs.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
          const auto a = std::size_t(t[k]), b = std::size_t(t[(k + 1) % 3]);
          if (torn.contains({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])}))
            continue;
          const Vec3 e = minus(x[b], x[a]);
          const double l = std::sqrt(dot(e, e)),
                       rest = distance(mesh->vertices[a], mesh->vertices[b]);
          const double rate = v ? dot(e, minus((*v)[b], (*v)[a])) / l : 0;
          const Vec3 pull =
              times(e, (made_of.stiffness * (l - rest) + made_of.spring_damping * rate) / l);
          f[a] = plus(f[a], pull);
          f[b] = minus(f[b], pull);
        }
      for (std::size_t p = 0; p < x.size(); ++p)
        f[p] = plus(times(f[p], 1 / masses[p]), scene.gravity);
      return f;
    };
    const double dt = run.dt();
    std::vector<Vec3> x = rounded, v(x.size());
    const std::vector<Vec3> first = accelerations(x, nullptr);
    for (std::size_t p = 0; p < x.size(); ++p) v[p] = times(first[p], -dt / 2);
    for (int n = 0; n < run.substeps(); ++n) {
      const std::vector<Vec3> a = accelerations(x, &v);
      for (std::size_t p = 0; p < x.size(); ++p) {
        v[p] = plus(v[p], times(a[p], dt));
        x[p] = plus(x[p], times(v[p], dt));
      }
    }
    const std::vector<Vec3> moved = positions_of(run);
    double greatest = 0, off = 0;
    for (std::size_t p = 0; p < x.size(); ++p) {
      greatest = std::max(greatest, distance(x[p], rounded[p]));
      off = std::max(off, distance(moved[p], x[p]));
    }
    EXPECT_GT(greatest, 1e-5) << material.name;
    EXPECT_LT(off, 5e-7 + 2e-3 * greatest) << material.name;
  }
}

// A hanging sheet cut through: the lower half falls freely, about a centre of mass that goes as g t²/2.
TEST(TearMesh, CutThroughItsHalvesFallApart) {
  for (const Way& way : ways()) {
    Scene scene = scene_of(made_up({.nx = 15, .ny = 15, .shift = 0.2}));
    way.set(scene);
    for (int i = 0; i < 15; ++i) scene.cloths[0].pins.push_back({i, 0, {}});
    scene.cloths[0].mesh.rotate = {90, 0, 0};  // along -y
    Simulation run(scene, {.threads = 2});
    for (int n = 0; n < 10; ++n) run.advance_frame();
    EXPECT_EQ(run.cut({5, 5, 5}, {6, 6, 6}, 0.01), 0);
    const int cut = run.cut({-1, -0.52, 0}, {2, -0.52, 0}, 0.02);
    EXPECT_GE(cut, 15 + 14) << way.name;
    EXPECT_EQ(run.report().torn, cut);
    const std::vector<int> piece = pieces_of(*scene.cloths[0].mesh.shape, run.snapshot());
    const auto low = [&](std::size_t p) { return piece[p] == piece.back(); };
    EXPECT_FALSE(low(7));
    const auto middle = [&] {
      const std::vector<Vec3> x = positions_of(run);
      std::vector<double> mass(x.size());
      const auto& c = scene.cloths[0];
      for (const auto& r :
           physics::rest_triangles(*c.mesh.shape, {physics::rest_places(c.mesh).x}, {}))
        for (std::size_t k = 0; k < 3; ++k) mass[std::size_t(r.corner[k])] += r.area;
      double sum = 0, all = 0;
      for (std::size_t p = 0; p < x.size(); ++p)
        if (low(p)) sum += mass[p] * x[p][1], all += mass[p];
      return sum / all;
    };
    std::vector<double> y;
    for (int n = 0; n < 30; ++n) {
      run.advance_frame();
      ASSERT_TRUE(run.status().ok) << run.status().text;
      y.push_back(middle());
    }
    const double frame = 1.0 / 60;
    for (std::size_t n = 1; n + 1 < y.size(); ++n)
      EXPECT_NEAR((y[n + 1] - 2 * y[n] + y[n - 1]) / (frame * frame), -9.81, 0.03)
          << way.name << ", " << n;
    EXPECT_GT(positions_of(run)[7][1], -0.01);
    EXPECT_LT(y.back(), -1.5) << way.name;
  }
}

// Of a triangle by itself: a membrane ends with its first edge, springs one by one.
TEST(TearMesh, ATriangleByItselfEnds) {
  auto mesh = std::make_shared<TriangleMesh>();
  mesh->vertices = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  mesh->triangles = {{0, 1, 2}};
  for (const bool membrane : {false, true}) {
    Scene scene = scene_of(mesh);
    scene.gravity = {};
    if (membrane) scene.cloths[0].membrane = kCanvas;
    Simulation run(scene, {.threads = 1});
    EXPECT_EQ(run.cut({0, 0, 0.5}, {0.01, 0, 0.5}, 1e-3), membrane ? 3 : 1);
    EXPECT_TRUE(run.view().cloths[0].triangles.empty());
    EXPECT_TRUE(run.view().cloths[0].tear_triangles.empty());  // with no whole triangle to tell
    const Report before = run.report();
    EXPECT_EQ(before.energy.elastic, 0);
    run.set_state({0, 0, 0, 0, 0, 1, 1, 0, 0}, {-1, 0, 0, 0, 2, 0, 0, 0, 0});
    for (int n = 0; n < 20; ++n) run.advance_frame();
    const std::vector<Vec3> x = positions_of(run);
    if (membrane) {
      EXPECT_NEAR(x[0][0], -1.0 / 3, 1e-5);
      EXPECT_NEAR(x[1][1], 2.0 / 3, 1e-5);
      EXPECT_NEAR(x[2][0], 1, 1e-6);
    } else {
      EXPECT_LT(x[2][0], 0.99);  // a thread to either end holds it
    }
  }
}

// A vertex that two cuts leave alone between pieces goes with the one that is larger there.
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
          if (distance(x[std::size_t(a)], x[std::size_t(b)]) > 1.0201 * rest)
            ASSERT_TRUE(gone.contains({a, b})) << way.name << ", frame " << n;
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
  for (const Way& way : ways()) {
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
  const double energy = model->elastic_energy();
  tearing.remember();
  for (int e = 20; e < 60; ++e) tearing.end(e);
  EXPECT_LT(model->elastic_energy(), energy);
  tearing.go_back();
  EXPECT_FALSE(tearing.update());
  EXPECT_EQ(tearing.torn_list(), before);
  EXPECT_EQ(model->elastic_energy(), energy);
}

// What is shown of a flat sheet that is cut still is all of it; with holes, triangles in the way are missing.
TEST(TearMesh, ATearShowsAsALineAndNotAsAHole) {
  const auto area = [](const ClothView& c) {
    double sum = 0;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& d) {
      const Vec3 n = cross(minus(b, a), minus(d, a));
      sum += 0.5 * std::sqrt(dot(n, n));
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
  for (const Way& way : ways())
    for (const SelfCollisionMode mode :
         {SelfCollisionMode::particles, SelfCollisionMode::surface}) {
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
