// Tearing: by strain, by cutters, by a caller; triangles follow; the same bits for any threads.
#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

#include "contact_scenes.h"
#include "machines.h"

namespace weft {
namespace {

// A sheet hung by its first row.
Scene hung(int n, Method method) {
  Scene scene;
  scene.solver.method = method;
  scene.cloths.push_back(flat_sheet(n, 1, {0, 0, 0}));
  Cloth& c = scene.cloths[0];
  c.grid.origin = {-0.5, 0, 0};
  c.grid.v = {0, -1, 0};
  c.drag = 1;
  for (int i = 0; i < n; ++i) c.pins.push_back({i, 0, {}});
  return scene;
}

double lowest(const Simulation& s) {
  double y = 1e9;
  const std::vector<double> x = s.positions();
  for (std::size_t k = 1; k < x.size(); k += 3) y = std::min(y, x[k]);
  return y;
}

TEST(Tear, WholeClothMovesAsIfItCouldNotTear) {
  for (const Method method :
       {Method::spring, Method::spring_friction, Method::positional, Method::compliant}) {
    Scene plain = hung(24, method), tearable = plain;
    tearable.cloths[0].tear_strain = 100;
    Simulation a(plain), b(tearable);
    advance(a, 0.3);
    advance(b, 0.3);
    EXPECT_EQ(b.report().torn, 0);
    EXPECT_EQ(b.view().cloths[0].topology_version, 0u);
    double most = 0;
    for (std::size_t k = 0; k < a.positions().size(); ++k)
      most = std::max(most, std::abs(a.positions()[k] - b.positions()[k]));
    EXPECT_LT(most, 1e-4) << int(method);  // springs are added up in another order
  }
}

TEST(Tear, OverloadedClothTearsAndFallsApart) {
  for (const Method method : {Method::spring, Method::compliant}) {
    Scene scene = hung(20, method);
    scene.cloths[0].tear_strain = 0.3;
    for (int n = 0; n < 20; ++n)  // the last row is carried away
      scene.cloths[0].pins.push_back(
          {n, 19, {{0, {n / 19.0 - 0.5, -1, 0}}, {1, {n / 19.0 - 0.5, -2, 0}}}});
    Simulation simulation(scene);
    advance(simulation, 1);
    const Report r = simulation.report();
    std::printf("tug: %lld torn\n", (long long)r.torn);
    EXPECT_GT(r.torn, 19);
    EXPECT_LT(r.strain.max, 0.31);  // of what is left
    const ClothView view = simulation.view().cloths[0];
    EXPECT_GT(view.topology_version, 0u);
    EXPECT_LT(view.triangles.size(), 2u * 19 * 19);
    for (const auto& t : view.triangles)  // no triangle is drawn across the gap
      for (int k = 0; k < 3; ++k) {
        const auto a = t[std::size_t(k)], b = t[std::size_t((k + 1) % 3)];
        EXPECT_LT(std::hypot(view.x[a] - view.x[b], view.y[a] - view.y[b], view.z[a] - view.z[b]),
                  0.1);
      }
  }
}

// A constraint too long at the end of two substeps in a row is gone after the second, and every other
// one is there.
TEST(Tear, WhatIsTooLongTearsAtOnce) {
  for (const Method method : {Method::spring, Method::spring_friction, Method::compliant}) {
    Scene scene = hung(20, method);
    Cloth& cloth = scene.cloths[0];
    cloth.tear_strain = 0.1;
    scene.time.frame = 2e-4;
    scene.time.substeps = 1;
    for (int n = 0; n < 20; ++n)
      cloth.pins.push_back({n, 19, {{0, {n / 19.0 - 0.5, -1, 0}}, {1, {n / 19.0 - 0.5, -9, 0}}}});
    // Sweeps measure a constraint in their midst, not at their end.
    const double slack = method == Method::compliant ? 5e-3 : 1e-4;
    Simulation simulation(scene);
    const auto too_long = [&](const ClothView& view) {
      std::vector<std::array<int, 2>> list;
      const int offsets[6][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}, {2, 0}, {0, 2}};
      for (const auto& [di, dj] : offsets)
        for (int j = 0; j + dj < 20; ++j)
          for (int i = std::max(0, -di); i + std::max(0, di) < 20; ++i) {
            const int a = j * view.stride + i, b = a + dj * view.stride + di;
            const double length =
                std::hypot(view.x[a] - view.x[b], view.y[a] - view.y[b], view.z[a] - view.z[b]);
            if (length > (1.1 + slack) * std::hypot(di, dj) / 19)
              list.push_back({j * 20 + i, (j + dj) * 20 + i + di});
          }
      return list;
    };
    std::vector<std::array<int, 2>> before;
    std::size_t torn = 0;
    for (int n = 0; n < 400; ++n) {
      simulation.advance_frame();
      const auto now = too_long(simulation.view().cloths[0]);
      const Snapshot snapshot = simulation.snapshot();
      const std::set<std::array<int, 2>> gone(snapshot.cloths[0].torn.begin(),
                                              snapshot.cloths[0].torn.end());
      for (const auto& c : now) {
        const bool twice = std::find(before.begin(), before.end(), c) != before.end();
        ASSERT_TRUE(!twice || gone.count(c)) << n << ": " << c[0] << " to " << c[1];
      }
      before = now;
      torn = gone.size();
    }
    std::printf("%d: %zu torn\n", int(method), torn);
    EXPECT_GT(torn, 19u);
    EXPECT_LT(torn, 1500u);
  }
}

TEST(Tear, CallerCutsAlongASegment) {
  for (const Method method : {Method::spring, Method::positional, Method::compliant}) {
    Simulation simulation(hung(20, method));
    advance(simulation, 0.2);
    EXPECT_EQ(simulation.cut({5, 5, 5}, {6, 6, 6}, 0.01), 0);
    const int cut = simulation.cut({-1, -0.5, 0}, {1, -0.5, 0}, 0.02);
    EXPECT_GE(cut, 20 + 2 * 19);
    EXPECT_EQ(simulation.report().torn, cut);
    advance(simulation, 1.2);
    EXPECT_LT(lowest(simulation), -4);                            // the lower half falls
    EXPECT_GT(at(simulation.positions(), 5 * 20 + 10)[1], -0.6);  // the upper half hangs
  }
}

// The first cut gives a cloth its masks and chooses its stages anew; a hand keeps what it holds.
TEST(Tear, AHandHoldsOnThroughACut) {
  for (const Method method : {Method::spring, Method::compliant}) {
    Simulation simulation(hung(20, method));
    const Vec3 held = at(simulation.positions(), 18 * 20 + 10);
    simulation.grab(0, 18 * 20 + 10, held, 1000);
    EXPECT_GE(simulation.cut({-1, -0.5, 0}, {1, -0.5, 0}, 0.02), 20 + 2 * 19);
    advance(simulation, 1.2);
    EXPECT_NEAR(at(simulation.positions(), 18 * 20 + 10)[1], held[1], 0.1);
    simulation.release();
    advance(simulation, 2.4);
    EXPECT_LT(lowest(simulation), -4);
  }
}

TEST(Tear, CutterCutsItsWay) {
  Scene scene = hung(30, Method::spring);
  Collider cutter = collider_of(Sphere{{0, -0.5, -0.5}, 0.1});
  cutter.cuts = true;
  cutter.keys = {{0.1, {0, -0.5, -0.5}}, {0.6, {0, -0.5, 0.5}}};
  scene.colliders.push_back(cutter);
  Simulation simulation(scene);
  advance(simulation, 0.2);
  EXPECT_EQ(simulation.report().torn, 0);
  advance(simulation, 1);
  const Report r = simulation.report();
  std::printf("cutter: %lld torn\n", (long long)r.torn);
  EXPECT_GT(r.torn, 50);
  EXPECT_LT(lowest(simulation), -1.5);  // the round that it cut out falls
}

// The area of everything that a view shows of a cloth.
double shown_area(const ClothView& c) {
  double sum = 0;
  const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& d) {
    const Vec3 e{b[0] - a[0], b[1] - a[1], b[2] - a[2]}, f{d[0] - a[0], d[1] - a[1], d[2] - a[2]};
    sum += 0.5 * std::hypot(e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2],
                            e[0] * f[1] - e[1] * f[0]);
  };
  const auto particle = [&](std::uint32_t p) { return Vec3{c.x[p], c.y[p], c.z[p]}; };
  const auto point = [&](std::uint32_t p) {
    const auto& at = c.tear_points[p];
    return Vec3{at[0], at[1], at[2]};
  };
  for (const auto& t : c.triangles) add(particle(t[0]), particle(t[1]), particle(t[2]));
  for (const auto& t : c.tear_triangles) add(point(t[0]), point(t[1]), point(t[2]));
  return sum;
}

// Cuts of every direction through a flat sheet: what is shown still is the whole sheet, to where both
// sides meet; with holes the triangles in the way are missing.
TEST(Tear, ATearShowsAsALineAndNotAsAHole) {
  for (const Tears tears : {Tears::split, Tears::holes}) {
    Scene scene = hung(20, Method::spring);
    scene.cloths[0].tears = tears;
    Simulation simulation(scene);
    simulation.cut({-0.9, -0.5, 0}, {0.9, -0.5, 0}, 0.001);
    simulation.cut({0.01, -1.3, 0}, {0.01, -0.3, 0}, 0.001);
    simulation.cut({-0.4, -0.02, 0}, {0.1, -0.9, 0}, 0.001);
    const ClothView view = simulation.view().cloths[0];
    std::printf("shown: %.4f of 1 m2, %zu triangles along seams\n", shown_area(view),
                view.tear_triangles.size());
    if (tears == Tears::split) {
      EXPECT_NEAR(shown_area(view), 1, 0.004);
      EXPECT_EQ(view.tear_points.size(), view.tear_particles.size());
    } else {
      EXPECT_LT(shown_area(view), 0.9);
      EXPECT_TRUE(view.tear_triangles.empty());
    }
    // However far the pieces fall apart, each draws no more than its own.
    advance(simulation, 1.5);
    EXPECT_LT(lowest(simulation), -4);
    const ClothView after = simulation.view().cloths[0];
    EXPECT_LT(shown_area(after), 1.1);
    for (std::size_t n = 0; n < after.tear_points.size(); ++n) {
      const auto& at = after.tear_points[n];
      const std::uint32_t p = after.tear_particles[n];
      EXPECT_LT(std::hypot(at[0] - after.x[p], at[1] - after.y[p], at[2] - after.z[p]), 0.1);
    }
  }
}

// The middle line of the sheet is cut: what falls, falls freely, whatever else joined the halves.
TEST(Tear, NothingHoldsAcrossACut) {
  struct Way {
    Method method;
    Sweep sweep;
    bool tethers;
  };
  for (const Way& way : {Way{Method::spring, Sweep::gauss_seidel, false},
                         {Method::positional, Sweep::gauss_seidel, true},
                         {Method::positional, Sweep::line, true},
                         {Method::compliant, Sweep::jacobi, false},
                         {Method::compliant, Sweep::gauss_seidel, false},
                         {Method::compliant, Sweep::line, false}})
    for (const bool upright : {false, true}) {
      Scene scene = hung(40, way.method);
      Cloth& c = scene.cloths[0];
      if (upright) std::swap(c.grid.u, c.grid.v);
      if (upright)
        for (Pin& pin : c.pins) std::swap(pin.i, pin.j);
      if (upright) c.grid.origin = {-0.5, 0, 0};
      c.drag = 0;
      c.bending = 1e-3;
      scene.solver.sweep = way.sweep;
      scene.solver.tethers = way.tethers;
      Simulation simulation(scene);
      simulation.cut({-0.9, -0.5, 0}, {0.9, -0.5, 0}, 0.001);
      const auto falls = [&] {
        double y = 0;
        const std::vector<double> x = simulation.positions();
        for (int a = 20; a < 40; ++a)
          for (int b = 0; b < 40; ++b)
            y += at(x, std::size_t(upright ? b * 40 + a : a * 40 + b))[1];
        return y / 800;
      };
      const double start = falls();
      advance(simulation, 1);
      EXPECT_NEAR(falls() - start, -0.5 * 9.81, 0.1)
          << int(way.method) << " " << int(way.sweep) << " " << upright;
    }
}

TEST(Tear, WholeLinesAreSweptAsIfTheyCouldNotTear) {
  for (const Method method : {Method::positional, Method::compliant}) {
    Scene plain = hung(40, method);
    plain.solver.sweep = Sweep::line;
    plain.solver.iterations = 2;
    plain.cloths[0].bending = 1e-4;
    Scene tearable = plain;
    tearable.cloths[0].tear_strain = 100;
    Simulation a(plain), b(tearable);
    advance(a, 0.3);
    advance(b, 0.3);
    EXPECT_EQ(a.hash(), b.hash());
  }
}

TEST(Tear, SameBitsForAnyThreadsAndInstructionSet) {
  for (const auto& [method, sweep] : {std::pair{Method::spring, Sweep::gauss_seidel},
                                      {Method::compliant, Sweep::gauss_seidel},
                                      {Method::compliant, Sweep::line}}) {
    Scene scene = hung(70, method);
    scene.solver.sweep = sweep;
    if (sweep == Sweep::line) scene.cloths[0].bending = 1e-4;
    scene.cloths[0].tear_strain = 0.2;
    for (int n = 0; n < 70; ++n)
      scene.cloths[0].pins.push_back(
          {n, 69, {{0, {n / 69.0 - 0.5, -1, 0}}, {0.5, {n / 69.0 - 0.5, -2, 0.3}}}});
    std::vector<std::uint64_t> hashes;
    for (const Options& o : machines()) {
      Simulation simulation(scene, o);
      advance(simulation, 0.35);
      simulation.cut({-1, -0.2, 0}, {1, -0.3, 0}, 0.02);
      advance(simulation, 0.5);
      EXPECT_GT(simulation.report().torn, 0);
      hashes.push_back(simulation.hash());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
  }
}

TEST(Tear, ShredsGoOn) {
  Scene scene = hung(100, Method::spring);
  scene.cloths[0].tear_strain = 10;
  Simulation shreds(scene, {1, Simd::best, 1, false});
  for (int n = 0; n < 12; ++n) {
    const double y = -0.08 * n - 0.04;
    shreds.cut({-1, y, 0}, {1, y, 0}, 0.012);
    shreds.cut({y + 0.5, 1, 0}, {y + 0.5, -2, 0}, 0.012);
  }
  const double highest = shreds.positions()[1];
  for (int n = 0; n < 60; ++n) shreds.advance_frame();
  const Report r = shreds.report();
  EXPECT_TRUE(r.finite) << r.status.text;
  EXPECT_GT(r.torn, 10000);
  // What hangs on nothing falls: the middle of the sheet is metres below the pins.
  EXPECT_LT(shreds.positions()[3 * (50 * 100 + 50) + 1], highest - 2);
}

}  // namespace
}  // namespace weft
