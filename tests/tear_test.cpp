// Tearing: by strain, by cutters, by a caller; triangles follow; the same bits for any threads.
#include <cstdio>

#include "contact_scenes.h"

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

TEST(Tear, SameBitsForAnyThreadsAndInstructionSet) {
  for (const Method method : {Method::spring, Method::compliant}) {
    Scene scene = hung(70, method);
    scene.cloths[0].tear_strain = 0.2;
    for (int n = 0; n < 70; ++n)
      scene.cloths[0].pins.push_back(
          {n, 69, {{0, {n / 69.0 - 0.5, -1, 0}}, {0.5, {n / 69.0 - 0.5, -2, 0.3}}}});
    std::vector<std::uint64_t> hashes;
    for (const Options& o : {Options{1, Simd::best, 1, false},
                             {3, Simd::best, 1, false},
                             {1, Simd::scalar, 1, false},
                             {2, Simd::avx2, 1, false}}) {
      if (!simd_available(o.simd)) continue;
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
