// Bodies that are meshes and move by point caches: distances against brute force, and cloth on them against what
// is known of the same motion otherwise.
#include <cstdio>
#include <random>

#include "contact_scenes.h"
#include "folder.h"
#include "made_up_bodies.h"
#include "physics/contact/body/body_passage.h"
#include "physics/contact/body/body_surface.h"
#include "weft/read_scene.h"
#include "weft/recording.h"

namespace weft {
namespace {

using Motion = std::function<Vec3(const Vec3& p, double time)>;

// Samples every `step` seconds from zero on.
std::shared_ptr<const PointCache> cache_of(const TriangleMesh& mesh, double seconds, double step,
                                           const Motion& motion) {
  auto cache = std::make_shared<PointCache>();
  cache->points = int(mesh.vertices.size());
  for (int n = 0; n * step <= seconds + 1e-9; ++n) {
    cache->times.push_back(float(n * step));
    for (const Vec3& p : mesh.vertices) {
      const Vec3 q = motion(p, double(cache->times.back()));
      cache->places.push_back({float(q[0]), float(q[1]), float(q[2])});
    }
  }
  return cache;
}

Collider animated(const std::shared_ptr<const TriangleMesh>& mesh,
                  std::shared_ptr<const PointCache> motion, double friction = 0) {
  Collider c = tests::body_of(mesh, friction);
  MeshBody& body = std::get<MeshBody>(c.shape);
  body.file = "body.obj";
  body.motion = std::move(motion);
  body.surface = surface_of(body);
  c.animation = "motion.mdd";
  return c;
}

Vec3 turned(const Vec3& p, double angle) {
  return {std::cos(angle) * p[0] + std::sin(angle) * p[2], p[1],
          std::cos(angle) * p[2] - std::sin(angle) * p[0]};
}

// As it is at a time, linear between samples.
TriangleMesh at_time_of(const TriangleMesh& mesh, const PointCache& cache, double time) {
  TriangleMesh now = mesh;
  int n = 0;
  while (n + 2 < cache.samples() && double(cache.times[std::size_t(n + 1)]) <= time) ++n;
  const double from = double(cache.times[std::size_t(n)]),
               to = double(cache.times[std::size_t(n + 1)]);
  const double share = std::clamp((time - from) / (to - from), 0.0, 1.0);
  for (std::size_t p = 0; p < now.vertices.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k)
      now.vertices[p][k] =
          (1 - share) * double(cache.sample(n)[p][k]) + share * double(cache.sample(n + 1)[p][k]);
  return now;
}

double wobble(double a, double p) {
  return 0.4 + 0.1 * std::sin(3 * a) * std::sin(p);
}

TEST(MeshAnimation, DistanceAndSideAreThoseOfAllTrianglesAtAnyTime) {
  const auto mesh = tests::ball(31, 20, wobble);
  const auto cache = cache_of(*mesh, 1, 0.25, [](const Vec3& p, double t) {
    const Vec3 q = turned(p, 2 * t);
    return Vec3{q[0] + 0.3 * t, q[1] * (1 + t), q[2] - 0.1 * std::sin(9 * q[1] + 4 * t)};
  });
  const Collider body = animated(mesh, cache);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> within(-0.8, 0.8);
  int inside = 0;
  for (const double time : {-1.0, 0.0, 0.1, 0.25, 0.61, 1.0, 7.0}) {
    const TriangleMesh now = at_time_of(*mesh, *cache, time);
    for (int n = 0; n < 300; ++n) {
      Vec3 p{within(random), within(random), within(random)};
      if (n % 3 == 0) {  // near a corner or an edge
        const auto t = tests::triangle_of(now, random() % now.triangles.size());
        for (std::size_t k = 0; k < 3; ++k)
          p[k] = 0.02 * p[k] + t[0][k] + (n % 2) * 0.3 * (t[1][k] - t[0][k]);
      }
      const bool in = std::abs(tests::turns_about(now, p)) > 0.5;
      const double found = signed_distance(body, time, p);
      inside += in;
      ASSERT_EQ(found < 0, in) << time << ": " << p[0] << " " << p[1] << " " << p[2];
      ASSERT_NEAR(std::abs(found), tests::from_mesh(now, p), 1e-9);
    }
  }
  EXPECT_GT(inside, 100);
}

// What comes through a triangle that turns while the point goes through it.
TEST(MeshAnimation, PathsThroughMovingTrianglesAreFound) {
  const auto mesh = tests::ball(24, 12, 0.4);
  const auto cache = cache_of(*mesh, 1, 1, [](const Vec3& p, double t) {
    const Vec3 q = turned(p, 0.3 * t);
    return Vec3{q[0] * (1 + t), q[1] * (1 - 0.5 * t), q[2] + 0.5 * t};
  });
  const Collider body = animated(mesh, cache);
  const BodySurface& surface = *std::get<MeshBody>(body.shape).surface;
  const physics::BodyPassage passage{surface.at(0), surface.at(1), surface.travel(0, 1)};
  const auto nearest = [](const physics::BodyMoment& moment, const Vec3& p) {
    return moment.nearest(p);
  };
  std::mt19937 random(4);
  std::uniform_real_distribution<double> within(-1.2, 1.2);
  int entered = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 from{within(random), within(random), within(random)},
        to{within(random), within(random), within(random)};
    if (signed_distance(body, 0, from) < 0.01) continue;
    const auto m = passage.meet(from, to, nearest);
    const double truth = signed_distance(body, 1, to);
    entered += truth > 0 && m.now.distance < 0;
    ASSERT_TRUE(truth > 0 || m.now.distance < 0);
  }
  EXPECT_GT(entered, 20);  // through it, and out on the other side
}

Scene drape(const Collider& body, double height) {
  Scene scene;
  scene.cloths.push_back(flat_sheet(32, 0.8, {0, height, 0}));
  scene.cloths[0].drag = 1;
  scene.cloths[0].stiffness = {300, 100, 5};
  scene.colliders.push_back(body);
  return scene;
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t n = 0; n < a.size(); ++n) most = std::max(most, std::abs(a[n] - b[n]));
  return most;
}

// Of a sheet that lies on it from the start on; what falls and folds would amplify the rounding of the file.
TEST(MeshAnimation, ARigidMotionIsThatOfKeys) {
  const auto mesh = tests::box({0.5, 0.125, 0.5});
  const auto way = [](double t) { return Vec3{0.25 * t, 0.125 * t, -0.0625 * t}; };
  const auto cache = cache_of(*mesh, 1, 0.125, [&](const Vec3& p, double t) {
    const Vec3 by = way(t);
    return Vec3{p[0] + by[0], p[1] + by[1], p[2] + by[2]};
  });
  Scene scene = drape(animated(mesh, cache, 0.4), 0.127);
  scene.cloths[0].drag = 0;
  Scene keyed = scene;
  keyed.colliders[0] = tests::body_of(mesh, 0.4);
  keyed.colliders[0].keys = {{0, way(0)}, {1, way(1)}};
  Simulation one(scene), other(keyed);
  for (int frame = 0; frame < 45; ++frame) {
    one.advance_frame();
    other.advance_frame();
    ASSERT_LT(apart(one.positions(), other.positions()), 1e-5) << frame;
  }
  EXPECT_GT(one.positions()[1], 0.127 + 0.08);
}

// One that stands has the bits of a body without an animation.
TEST(MeshAnimation, OneThatStandsAddsNothing) {
  auto mesh = std::make_shared<TriangleMesh>(*tests::ball(40, 20, wobble));
  for (Vec3& p : mesh->vertices)
    for (double& value : p) value = double(float(value));
  const auto cache = cache_of(*mesh, 1, 0.1, [](const Vec3& p, double) { return p; });
  Simulation still(drape(tests::body_of(mesh, 0.3), 0.45)),
      moving(drape(animated(mesh, cache, 0.3), 0.45));
  advance(still, 0.8);
  advance(moving, 0.8);
  EXPECT_EQ(still.hash(), moving.hash());
  EXPECT_LT(moving.report().energy.kinetic, 1e-2);
}

// A small patch on top of a ball that turns about the vertical, ever faster to begin with, sticks to it.
TEST(MeshAnimation, FrictionSeesTheVelocityOfTheSurface) {
  constexpr double kRate = 1.5, kBegins = 0.3, kRamp = 0.5;  // rad/s, s, s
  const auto angle = [=](double t) {
    const double s = std::clamp(t - kBegins, 0.0, kRamp);
    return kRate * (s * s / (2 * kRamp) + std::max(0.0, t - kBegins - kRamp));
  };
  const auto mesh = tests::ball(64, 64, 0.5);
  const auto cache =
      cache_of(*mesh, 2, 1 / 60.0, [&](const Vec3& p, double t) { return turned(p, angle(t)); });
  Scene scene;
  scene.cloths.push_back(flat_sheet(12, 0.2, {0, 0.5005, 0}));
  scene.cloths[0].stiffness = {300, 100, 5};
  scene.cloths[0].drag = 0;
  scene.colliders.push_back(animated(mesh, cache, 0.6));
  Simulation simulation(scene);
  advance(simulation, kBegins);
  const std::vector<double> before = simulation.positions();
  advance(simulation, 1.6);
  const std::vector<double> after = simulation.positions();
  const double truth = angle(simulation.time()) - angle(kBegins);
  double most = 0, mean = 0;
  for (std::size_t n = 0; n < before.size() / 3; ++n) {
    const Vec3 p = turned(at(before, n), truth), q = at(after, n);
    const double off = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
    most = std::max(most, off);
    mean += 3 * off / double(before.size());
  }
  std::printf("turned by %.3f rad: %.2e m off at most, %.2e m in the mean\n", truth, most, mean);
  EXPECT_LT(most, 2e-3);
  EXPECT_LT(mean, 1e-3);
}

// A ball that grows below a sheet of which the corners are held. Nothing passes, by all edges and triangles.
TEST(MeshAnimation, ABodyThatGrowsPushesASheet) {
  const auto mesh = tests::ball(48, 24, 0.1);
  const auto cache = cache_of(*mesh, 1, 0.05, [](const Vec3& p, double t) {
    const double size = 1 + 2.2 * std::min(t, 0.9);
    return Vec3{size * p[0], size * p[1], size * p[2]};
  });
  Collider body = animated(mesh, cache, 0.2);
  body.offset = 0.004;
  Scene scene = drape(body, 0.12);
  scene.cloths[0].pins = {{0, 0, {}}, {31, 0, {}}, {0, 31, {}}, {31, 31, {}}};
  Simulation simulation(scene);
  for (int frame = 0; frame < 72; ++frame) {
    simulation.advance_frame();
    ASSERT_TRUE(simulation.status().ok);
    if (frame % 6 != 5) continue;
    ASSERT_LT(simulation.report().penetration.collider_max, 1e-4) << frame;
    const TriangleMesh now = at_time_of(*mesh, *cache, simulation.time());
    ASSERT_EQ(tests::crossings(tests::as_mesh(simulation.positions(), 32, 32), now), 0) << frame;
  }
  EXPECT_GT(simulation.positions()[3 * (16 * 32 + 16) + 1], 0.29);
}

Scene swinging() {
  const auto mesh = tests::ball(24, 12, wobble);
  const auto cache = cache_of(*mesh, 1, 0.03, [](const Vec3& p, double t) {
    const Vec3 q = turned(p, 3 * t);
    return Vec3{q[0] + 0.1 * std::sin(6 * t), q[1] * (1 + 0.2 * std::sin(5 * t)), q[2]};
  });
  Collider body = animated(mesh, cache, 0.4);
  body.offset = 0.003;
  Scene scene = drape(body, 0.42);
  scene.time.substeps = 40;
  return scene;
}

TEST(MeshAnimation, SameBitsForAnyThreadsAndInstructionSet) {
  const Scene scene = swinging();
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3, 4})
    for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::best}) {
      if (!simd_available(simd) || (threads > 1 && simd != Simd::best)) continue;
      Simulation simulation(scene, {threads, simd, 1, false});
      advance(simulation, 0.3);
      hashes.push_back(simulation.hash());
    }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(MeshAnimation, ASnapshotGoesOnInTheMidst) {
  Simulation simulation(swinging());
  advance(simulation, 0.2);
  const Snapshot midst = simulation.snapshot();
  advance(simulation, 0.5);
  simulation.restore(midst);
  Simulation other(swinging());
  other.restore(midst);
  for (int n = 0; n < 15; ++n) {
    simulation.advance_frame();
    other.advance_frame();
    ASSERT_EQ(simulation.hash(), other.hash()) << n;
  }
}

TEST(MeshAnimation, ARecordingCarriesIt) {
  const Folder folder;
  Simulation simulation(swinging());
  {
    Recorder recorder(folder / "run.jsonl", simulation);
    for (int n = 0; n < 12; ++n) {
      simulation.advance_frame();
      recorder.frame(simulation);
    }
    recorder.finish();
  }
  const Recording recording = read_recording(folder / "run.jsonl");
  EXPECT_EQ(difference(recording.scene, simulation.scene()), "");
  Simulation replayed(recording.scene);
  for (int n = 0; n < 12; ++n) replayed.advance_frame();
  EXPECT_EQ(replayed.hash(), simulation.hash());
}

}  // namespace
}  // namespace weft
