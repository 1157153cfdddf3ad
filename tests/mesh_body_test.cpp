// Bodies that are meshes: distances and sides against brute force, and cloth on them against the same bodies
// as shapes, whose kernels are others.
#include <array>
#include <cstdio>
#include <limits>
#include <random>

#include "contact_scenes.h"
#include "made_up_bodies.h"
#include "physics/contact/body/body_surface.h"

namespace weft {
namespace {

using tests::body_of;

double bumpy(double a, double p) {
  return 0.4 + 0.1 * std::sin(3 * a) * std::sin(p) + 0.05 * std::cos(5 * p);
}
double spiky(double a, double p) {
  return 0.15 + 0.35 * std::pow(std::abs(std::sin(4 * a) * std::sin(p) * std::sin(4 * p)), 4);
}

std::shared_ptr<TriangleMesh> turned_over(const TriangleMesh& mesh) {
  auto other = std::make_shared<TriangleMesh>(mesh);
  for (auto& t : other->triangles) std::swap(t[1], t[2]);
  return other;
}

TEST(MeshBody, DistanceAndSideAreThoseOfAllTriangles) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> within(-0.7, 0.7);
  const auto twins =
      tests::together(*tests::ball(17, 12, 0.3), *tests::box({0.2, 0.1, 0.3}), {0.25, 0.05, 0});
  for (const auto& mesh :
       {tests::ball(31, 20, bumpy), tests::ball(32, 24, spiky), tests::torus(30, 16, 0.4, 0.12),
        tests::box({0.3, 0.2, 0.4}), turned_over(*tests::ball(12, 9, 0.4)), twins}) {
    const Collider body = body_of(mesh);
    const bool overlaps = mesh == twins,
               inward = tests::turns_about(*mesh, {0.41, 0.001, 0.02}) < -0.5 ||
                        tests::turns_about(*mesh, {0.001, 0.02, 0.01}) < -0.5;
    int inside = 0;
    for (int n = 0; n < 1500; ++n) {
      Vec3 p{within(random), within(random), within(random)};
      if (n % 3 == 0) {  // at a corner, an edge or a face
        const auto t = tests::triangle_of(*mesh, random() % mesh->triangles.size());
        for (std::size_t k = 0; k < 3; ++k)
          p[k] = 0.02 * p[k] + t[0][k] + (n % 2) * 0.3 * (t[1][k] - t[0][k]) +
                 (n % 4 > 1) * 0.2 * (t[2][k] - t[0][k]);
      }
      const double turns = tests::turns_about(*mesh, p) * (inward ? -1 : 1);
      const double found = signed_distance(body, 0, p), truth = tests::from_mesh(*mesh, p);
      inside += turns > 0.5;
      ASSERT_EQ(found<0, turns> 0.5) << p[0] << " " << p[1] << " " << p[2];
      // Inside of what overlaps the way out is at least as long as to the nearest triangle.
      if (overlaps && turns > 0.5)
        ASSERT_GE(-found, truth - 1e-9);
      else
        ASSERT_NEAR(std::abs(found), truth, 1e-9);
    }
    EXPECT_GT(inside, 50);
  }
}

TEST(MeshBody, HintsChangeNothing) {
  const auto mesh =
      tests::together(*tests::ball(31, 20, bumpy), *tests::ball(32, 24, spiky), {0.2, 0, 0});
  const BodySurface body(*mesh, mesh->vertices);
  const physics::BodyMoment surface = body.at();
  std::mt19937 random(5);
  std::uniform_real_distribution<double> within(-0.6, 0.6);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p{within(random), within(random), within(random)};
    const BodySurface::Point a = surface.nearest(p);
    const BodySurface::Point b = surface.nearest(p, int(random() % mesh->triangles.size()));
    ASSERT_EQ(a.distance, b.distance);
    ASSERT_EQ(a.normal, b.normal);
    ASSERT_EQ(a.triangle, b.triangle);
  }
}

// A particle may lie anywhere, or nowhere, in a frame that is run again later.
TEST(MeshBody, AnswersWhateverThePlace) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  const auto mesh =
      tests::together(*tests::ball(31, 20, bumpy), *tests::ball(32, 24, spiky), {2, 0, 0});
  const BodySurface body(*mesh, mesh->vertices);
  const physics::BodyMoment surface = body.at();
  const int triangles = int(mesh->triangles.size());
  const std::array<int, 3> some{0, 7, triangles - 1};
  for (const double strange : {nan, infinite, -infinite, 1e30, 1e200})
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 p{0.1, 0.2, 0.3};
      p[k] = strange;
      for (const BodySurface::Point& found : {surface.nearest(p), surface.nearest(p, triangles - 1),
                                              surface.nearest_among(some, p)}) {
        ASSERT_GE(found.triangle, 0) << strange;
        ASSERT_LT(found.triangle, triangles) << strange;
      }
    }
}

TEST(MeshBody, NormalIsTheGradientOfTheDistance) {
  const Collider body = body_of(tests::ball(40, 30, bumpy));
  const physics::BodyMoment surface = std::get<MeshBody>(body.shape).surface->at();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> within(-0.6, 0.6);
  int smooth = 0;
  for (int n = 0; n < 1000; ++n) {
    const Vec3 p{within(random), within(random), within(random)};
    const BodySurface::Point point = surface.nearest(p);
    EXPECT_NEAR(tests::length(point.normal), 1, 1e-12);
    double off = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 up = p, down = p;
      up[k] += 1e-6, down[k] -= 1e-6;
      off = std::max(
          off, std::abs((signed_distance(body, 0, up) - signed_distance(body, 0, down)) / 2e-6 -
                        point.normal[k]));
    }
    smooth += off < 1e-4;  // but where two sides are equally near
  }
  EXPECT_GT(smooth, 980);
}

Scene drape(const Collider& body, int points = 40) {
  Scene scene;
  scene.cloths.push_back(flat_sheet(points, 1, {0, 0.32, 0}));
  scene.cloths[0].drag = 1;
  scene.colliders.push_back(body);
  return scene;
}

std::vector<double> after(const Scene& scene, double seconds) {
  Simulation simulation(scene);
  advance(simulation, seconds);
  return simulation.positions();
}

Vec3 middle_of(const std::vector<double>& x) {
  Vec3 sum{};
  for (std::size_t n = 0; n < x.size(); ++n) sum[n % 3] += 3 * x[n] / double(x.size());
  return sum;
}

// A small sheet slides down from the top. 20,000 triangles lie 0.1 mm inside of the sphere at most.
TEST(MeshBody, BallOfTrianglesIsASphere) {
  const auto mesh = tests::ball(142, 71, 0.3);
  EXPECT_NEAR(double(mesh->triangles.size()), 20000, 200);
  for (const double friction : {0.0, 0.2}) {
    Scene triangles = drape(body_of(mesh, friction), 8), sphere = triangles;
    triangles.gravity[0] = 5;
    triangles.cloths[0] = flat_sheet(8, 0.06, {0, 0.3005, 0});
    sphere = triangles;
    sphere.colliders[0].shape = Sphere{{0, 0, 0}, 0.3};
    const Vec3 a = middle_of(after(triangles, 0.25)), b = middle_of(after(sphere, 0.25));
    std::printf("friction %.1f: %.4f m down, %.2g mm apart\n", friction, b[0],
                1e3 * tests::length(tests::difference(a, b)));
    EXPECT_GT(b[0], 0.02);
    EXPECT_LT(tests::length(tests::difference(a, b)), 1e-3);
  }
}

// How the sheet folds hangs on the last bits; that nothing of it is in the box does not.
TEST(MeshBody, BoxOfTrianglesIsABox) {
  for (const double friction : {0.0, 0.5}) {
    Collider triangles = body_of(tests::box({0.25, 0.2, 0.25}), friction);
    triangles.offset = 0.005;
    Collider box = triangles;
    box.shape = Box{{0, 0, 0}, {0.25, 0.2, 0.25}, {}, 0};
    const std::vector<double> a = after(drape(triangles, 30), 0.3), b = after(drape(box, 30), 0.3);
    const double deep = tests::deepest_triangle(a, 30, 30, box);
    const double apart = tests::length(tests::difference(middle_of(a), middle_of(b)));
    std::printf("friction %.1f: %.2g mm apart, %.2g mm above the box\n", friction, 1e3 * apart,
                -1e3 * deep);
    EXPECT_LT(deep, -0.004);
    EXPECT_LT(apart, 2e-3);
  }
}

int crossings_of(const Simulation& simulation, int points, const TriangleMesh& body,
                 const Vec3& by = {}) {
  TriangleMesh there = body;
  for (Vec3& p : there.vertices)
    for (std::size_t k = 0; k < 3; ++k) p[k] += by[k];
  return tests::crossings(tests::as_mesh(simulation.positions(), points, points), there);
}

TEST(MeshBody, NothingPassesThroughATorus) {
  for (const auto& [around, along] : {std::pair{60, 30}, {10, 5}})
    for (const Method method : {Method::spring, Method::compliant}) {
      const auto mesh = tests::torus(around, along, 0.3, 0.1);
      Scene scene = drape(body_of(mesh, 0.3), 30);
      scene.cloths[0].grid.origin[1] = 0.15;
      scene.colliders[0].offset = 0.004;
      scene.solver.method = method;
      Simulation simulation(scene);
      int crossed = 0;
      for (int n = 0; n < 36; ++n) {
        simulation.advance_frame();
        ASSERT_TRUE(simulation.status().ok);
        if (n % 6 == 5) crossed += crossings_of(simulation, 30, *mesh);
      }
      EXPECT_EQ(crossed, 0) << around << " " << int(method);
    }
}

// No frame shows the body, put somewhat elsewhere, through the cloth.
void expect_it_holds(const Scene& scene, const TriangleMesh& body, int frames,
                     const Vec3& by = {}) {
  Simulation simulation(scene);
  for (int n = 0; n < frames; ++n) {
    simulation.advance_frame();
    ASSERT_TRUE(simulation.status().ok);
    EXPECT_EQ(crossings_of(simulation, scene.cloths[0].grid.nx, body, by), 0) << n;
  }
}

// A cone of a few sides under cloth whose triangles are as wide as it.
TEST(MeshBody, ASpikeDoesNotPokeThroughCoarseCloth) {
  const auto mesh = tests::ball(6, 3, [](double, double p) { return p < 0.1 ? 0.4 : 0.1; });
  Scene scene = drape(body_of(mesh, 0.3), 12);
  scene.cloths[0].grid.origin = {-0.48, 0.42, -0.47};
  scene.colliders[0].offset = 0.005;
  expect_it_holds(scene, *mesh, 60);
}

// As steep as the cloth never is; 2 mm below their surface nothing of it has come.
TEST(MeshBody, NeedlesAndSpikesHoldCloth) {
  for (const auto& [radius, sides] : {std::pair{0.005, 3}, {0.02, 4}})
    for (const Method method : {Method::spring, Method::compliant}) {
      auto mesh = std::make_shared<TriangleMesh>();
      for (int n = 0; n < sides; ++n) {
        const double a = 2 * std::numbers::pi * n / sides;
        const int next = (n + 1) % sides;
        mesh->vertices.push_back({radius * std::cos(a), 0, radius * std::sin(a)});
        mesh->triangles.push_back({n, sides, next});
        mesh->triangles.push_back({next, sides + 1, n});
      }
      mesh->vertices.push_back({0, 0.4, 0});
      mesh->vertices.push_back({0, 0, 0});
      Scene scene = drape(body_of(mesh, 0.3), 25);
      scene.cloths[0].grid.origin = {-0.47, 0.5, -0.48};
      scene.cloths[0].drag = 0;
      scene.solver.method = method;
      SCOPED_TRACE(std::to_string(radius) + " " + name_of(method));
      expect_it_holds(scene, *mesh, 18, {0, -0.002, 0});
    }
}

// Two corners of it come to one triangle at once, and its faces are nearer to each other than cloth falls in a substep.
TEST(MeshBody, ThinPlatesHoldCloth) {
  const auto mesh = tests::box({0.3, 0.2, 0.002});
  for (const Method method : {Method::spring, Method::compliant})
    for (const int points : {17, 25})
      for (const double speed : {1.0, 3.0}) {
        Scene scene = drape(body_of(mesh, 0.3), points);
        Cloth& cloth = scene.cloths[0];
        cloth.grid.origin = {-0.47, 0.55, -0.48};
        cloth.stiffness = {2000, 500, 0};
        cloth.drag = 1;
        cloth.velocity = {0, -speed, 0};
        scene.colliders[0].offset = 0.004;
        scene.solver.method = method;
        SCOPED_TRACE(name_of(method) + (' ' + std::to_string(points)) + " " +
                     std::to_string(speed));
        expect_it_holds(scene, *mesh, 30);
      }
}

// It slides back by v²/2μg as the body starts, and on by as much as it stops.
TEST(MeshBody, ABodyThatMovesCarriesItsCloth) {
  Scene scene = drape(body_of(tests::box({0.7, 0.05, 0.7}), 0.8), 20);
  scene.cloths[0].grid.origin[1] = 0.051;
  scene.cloths[0].drag = 0;
  scene.colliders[0].keys = {{0.2, {0, 0, 0}}, {0.7, {0.25, 0, 0}}};
  Simulation simulation(scene);
  advance(simulation, 0.2);
  const std::vector<double> before = simulation.positions();
  const auto moved = [&] {
    const std::vector<double> x = simulation.positions();
    double sum = 0;
    for (std::size_t n = 0; n < x.size(); n += 3) sum += x[n] - before[n];
    return 3 * sum / double(x.size());
  };
  advance(simulation, 0.7);
  EXPECT_NEAR(moved(), 0.25 - 0.25 / (2 * 0.8 * 9.81), 1e-3);
  advance(simulation, 1.0);
  EXPECT_NEAR(moved(), 0.25, 1e-3);
}

TEST(MeshBody, WhatIsInABowlStaysInIt) {
  const auto mesh = tests::bowl(48, 12, 0.4);
  Scene scene;
  scene.cloths.push_back(flat_sheet(24, 0.5, {0, -0.05, 0}));
  scene.colliders.push_back(body_of(mesh, 0.2));
  scene.colliders[0].offset = 0.004;
  Simulation simulation(scene);
  advance(simulation, 1.5);
  EXPECT_EQ(crossings_of(simulation, 24, *mesh), 0);
  const std::vector<double> x = simulation.positions();
  for (std::size_t n = 0; n < x.size(); n += 3) {
    EXPECT_LT(std::hypot(x[n], x[n + 1], x[n + 2]), 0.4 - 0.003);
    EXPECT_LT(x[n + 1], 0);
  }
}

// Particles shot at a bowl and at a thin plate from both sides, in one substep farther than either is wide; where
// they touch they stick.
TEST(MeshBody, FastParticlesStayOnTheirSide) {
  const auto shell = tests::bowl(24, 6, 0.4);
  const auto plate = tests::box({0.6, 0.002, 0.6});
  for (const bool open : {true, false})
    for (const double speed : {1.0, 20.0, 200.0}) {
      Scene scene;
      scene.gravity = {0, 0, 0};
      scene.time.substeps = 8;
      scene.cloths.push_back(loose_particles({0, 0, 0}));
      scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = 20;
      scene.cloths[0].grid.origin = {0, 5, 0};
      scene.colliders.push_back(body_of(open ? shell : plate, 5));
      scene.colliders[0].offset = 0.003;
      Simulation simulation(scene);
      std::mt19937 random(11);
      std::uniform_real_distribution<double> within(-1, 1);
      std::vector<double> x, v;
      for (int n = 0; n < 400; ++n) {
        // Within the bowl and below it, above and below the plate; all towards the surface.
        const double a = 3.14 * within(random), tilt = 0.2 + 0.5 * std::abs(within(random));
        const Vec3 way{std::sin(tilt) * std::cos(a), -std::cos(tilt), std::sin(tilt) * std::sin(a)};
        const bool in = n % 2 == 0;
        const double from = open ? (in ? 0.2 : 0.7) : (in ? 0.3 : -0.3);
        for (std::size_t k = 0; k < 3; ++k) {
          x.push_back(open ? from * way[k] : k == 1 ? from : 0.4 * within(random));
          v.push_back(open ? (in ? speed : -speed) * way[k] : k == 1 ? (in ? -speed : speed) : 0);
        }
      }
      simulation.set_state(x, v);
      for (int frame = 0; frame < 3; ++frame) simulation.advance_frame();
      const std::vector<double> now = simulation.positions();
      for (int n = 0; n < 400; ++n) {
        const Vec3 p = at(now, std::size_t(n));
        if (open)
          EXPECT_EQ(tests::length(p) < 0.398, n % 2 == 0) << speed << " " << tests::length(p);
        else
          EXPECT_EQ(p[1] > 0, n % 2 == 0) << speed << " " << p[1];
      }
    }
}

TEST(MeshBody, ClothThatStartsInsideComesOut) {
  Scene scene = drape(body_of(tests::ball(48, 24, 0.3)));
  scene.cloths[0].grid.origin[1] = 0.2;
  Simulation simulation(scene);
  EXPECT_NE(simulation.plan().notes.size(), 0u);
  advance(simulation, 0.5);
  EXPECT_LT(simulation.report().penetration.collider_max, 1e-4);
  double fastest = 0;
  for (const double v : simulation.velocities()) fastest = std::max(fastest, std::abs(v));
  EXPECT_LT(fastest, 5);
}

TEST(MeshBody, SameBitsForAnyThreadsAndInstructionSet) {
  Collider open = body_of(tests::bowl(32, 8, 0.3), 0.3);
  open.offset = 0.005;
  for (const Collider& body : {body_of(tests::ball(24, 12, bumpy), 0.3),
                               body_of(tests::torus(10, 5, 0.3, 0.1), 0.3), open}) {
    Scene scene = drape(body, 40);
    scene.time.substeps = 60;
    scene.cloths[0].stiffness = {200, 50, 10};
    scene.cloths[0].grid.origin[1] = 0.25;
    scene.colliders[0].keys = {{0, {0, 0, 0}}, {0.1, {0.05, 0.1, 0}}};
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 3})
      for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::best}) {
        if (!simd_available(simd) || (threads > 1 && simd != Simd::best)) continue;
        Simulation simulation(scene, {threads, simd, 1, false});
        advance(simulation, 0.1);
        hashes.push_back(simulation.hash());
      }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
  }
}

}  // namespace
}  // namespace weft
