// Torn meshes against their truths: momentum, energy and symmetry, free fall of what is cut off, and the equations of
// what is left.
#include "torn_meshes.h"

namespace weft {
namespace {

using physics::Joined;

// By how much a strip whose ends fly apart changes its angular momentum at most, if it cannot tear: what sweeps over
// positions do by themselves.
double turned_whole(const Way& way) {
  const Scene scene = tug(way, 50);
  Simulation run(scene, {.threads = 1});
  draw_apart(run, *scene.cloths[0].mesh.shape, 5);
  const Vec3 first = run.report().angular_momentum;
  double most = 0;
  for (int n = 0; n < 40; ++n) {
    run.advance_frame();
    most = std::max(most, distance(run.report().angular_momentum, first));
  }
  return most;
}

// Torn in pieces, each goes on by itself.
TEST(TearMesh, TornInTwoItKeepsMomentumAndGainsNoEnergy) {
  for (const Way& way : ways()) {
    const Scene scene = tug(way, 0.02);
    const TriangleMesh& mesh = *scene.cloths[0].mesh.shape;
    Simulation run(scene, {.threads = 1});
    draw_apart(run, mesh, 5);
    Report before = run.report();
    const Report first = before;
    const double total = first.energy.kinetic + first.energy.elastic;
    // Lines move particles farther, and so round more.
    const double drift = scene.solver.sweep == Sweep::line ? 1e-3 : 1e-4;
    double turned = 0;
    for (int n = 0; n < 40; ++n) {
      run.advance_frame();
      ASSERT_TRUE(run.status().ok) << run.status().text;
      const Report now = run.report();
      EXPECT_LT(now.energy.kinetic + now.energy.elastic,
                before.energy.kinetic + before.energy.elastic + 0.01 * total)
          << way.name << ", frame " << n;
      EXPECT_LT(distance(now.momentum, first.momentum), drift) << way.name << ", frame " << n;
      turned = std::max(turned, distance(now.angular_momentum, first.angular_momentum));
      before = now;
    }
    const double whole = turned_whole(way);
    EXPECT_LT(turned, 3e-4 + 2 * whole) << way.name;
    EXPECT_GT(before.torn, 8) << way.name;
    const std::vector<int> piece = pieces_of(mesh, run.snapshot());
    const int left = nearest_vertex(mesh, {0, 0, 0.5}), right = nearest_vertex(mesh, {3, 0, 0.5});
    EXPECT_NE(piece[std::size_t(left)], piece[std::size_t(right)]) << way.name;
    std::printf("%s: %lld torn, angular momentum off by %.1e, whole by %.1e\n", way.name,
                (long long)before.torn, turned, whole);
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
    draw_apart(a, *scene.cloths[0].mesh.shape, 3);
    draw_apart(b, *mesh, 3);
    // Until the first has torn through: later, pieces shake, and rounding tells them apart.
    for (int n = 0; n < 60 && a.report(false).torn == 0; ++n) {
      a.advance_frame();
      b.advance_frame();
    }
    EXPECT_GT(a.report().torn, 0) << way.name;
    EXPECT_NEAR(double(a.report().torn), double(b.report().torn), 0.15 * double(a.report().torn))
        << way.name;
    const auto x = positions_of(a), y = positions_of(b);
    for (std::size_t p = 0; p < x.size(); ++p)
      EXPECT_LT(distance(x[p], {y[p][0], -y[p][1], 1 - y[p][2]}), 0.02) << way.name;
  }
}

// What is left of a cut mesh, in double precision: triangles that are whole, as a mesh of their own, and springs of
// those that are not.
class WhatIsLeft {
 public:
  WhatIsLeft(const Scene& scene, const std::vector<Joined>& torn)
      : scene_(scene), mesh_(*scene.cloths[0].mesh.shape), torn_(torn.begin(), torn.end()) {
    const Cloth& cloth = scene.cloths[0];
    material_ = physics::material_of(cloth, scene.solver.method == Method::spring_friction);
    masses_.resize(mesh_.vertices.size());
    for (const auto& r : physics::rest_triangles(mesh_, {mesh_.vertices}, cloth.bending))
      for (std::size_t k = 0; k < 3; ++k)
        masses_[std::size_t(r.corner[k])] += cloth.density * r.area / 3;
    TriangleMesh left;
    left.vertices = mesh_.vertices;
    for (const auto& t : mesh_.triangles) {
      const bool whole = holds(t, 0) && holds(t, 1) && holds(t, 2);
      (whole ? left.triangles : in_the_way_).push_back(t);
    }
    triangles_ = physics::rest_triangles(left, {mesh_.vertices}, cloth.bending);
  }

  std::vector<Vec3> accelerations(const std::vector<Vec3>& x, const std::vector<Vec3>& v) const {
    std::vector<Vec3> f(x.size());
    physics::add_mesh_forces(triangles_, material_, x, &v, f);
    for (const auto& t : in_the_way_)
      for (std::size_t k = 0; k < 3; ++k)
        if (!material_.membrane && holds(t, k))
          pull(std::size_t(t[k]), std::size_t(t[(k + 1) % 3]), x, v, f);
    for (std::size_t p = 0; p < x.size(); ++p)
      f[p] = plus(times(f[p], 1 / masses_[p]), scene_.gravity);
    return f;
  }

 private:
  bool holds(const std::array<int, 3>& t, std::size_t k) const {
    const int a = t[k], b = t[(k + 1) % 3];
    return !torn_.contains({std::min(a, b), std::max(a, b)});
  }
  void pull(std::size_t a, std::size_t b, const std::vector<Vec3>& x, const std::vector<Vec3>& v,
            std::vector<Vec3>& f) const {
    const Vec3 e = minus(x[b], x[a]);
    const double l = length(e), rest = distance(mesh_.vertices[a], mesh_.vertices[b]);
    const double rate = dot(e, minus(v[b], v[a])) / l;
    const Vec3 by =
        times(e, (material_.stiffness * (l - rest) + material_.spring_damping * rate) / l);
    f[a] = plus(f[a], by);
    f[b] = minus(f[b], by);
  }

  const Scene& scene_;
  const TriangleMesh& mesh_;
  std::set<Joined> torn_;
  physics::MeshMaterial material_{};
  std::vector<double> masses_;
  std::vector<physics::RestTriangle> triangles_;
  std::vector<std::array<int, 3>> in_the_way_;
};

// Cut along a line, a sheet goes on as the equations of what is left say.
TEST(TearMesh, CutItGoesAsTheEquationsOfWhatIsLeftSay) {
  const auto mesh = made_up({.nx = 23, .ny = 17, .shift = 0.3, .shuffled = true});
  for (const Material& material : kMaterials) {
    Scene scene = scene_of(mesh);
    material.set(scene);
    scene.time = {2e-4, 8, 1};
    std::mt19937 random(7);
    std::vector<Vec3> start = mesh->vertices;
    for (Vec3& p : start)
      for (double& value : p) value += 0.004 * (double(random()) / 2147483648.0 - 1);
    Simulation run(scene, {.threads = 1});
    EXPECT_GT(run.cut({-1, 0, 0.4}, {0.7, 0, 0.55}, 1e-3), 10);
    run.set_state(flat(start), std::vector<double>(3 * start.size()));
    const std::vector<Vec3> rounded = positions_of(run);
    const WhatIsLeft left(scene, run.snapshot().cloths[0].torn);
    run.advance_frame();

    const double dt = run.dt();
    std::vector<Vec3> x = rounded, v(x.size());
    const std::vector<Vec3> first = left.accelerations(x, v);
    for (std::size_t p = 0; p < x.size(); ++p) v[p] = times(first[p], -dt / 2);
    for (int n = 0; n < run.substeps(); ++n) {
      const std::vector<Vec3> a = left.accelerations(x, v);
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
    run.set_state(flat(mesh->vertices), flat({{-1, 0, 0}, {0, 2, 0}, {0, 0, 0}}));
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

}  // namespace
}  // namespace weft
