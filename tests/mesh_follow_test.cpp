// Pins that follow a body with an animation: they go with the nearest point of its surface.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "cases.h"
#include "contact_scenes.h"
#include "made_up_bodies.h"
#include "made_up_mesh.h"
#include "weft/point_cache.h"

namespace weft {
namespace {

using Motion = std::function<Vec3(const Vec3& p, double time)>;

Collider animated(const std::shared_ptr<const TriangleMesh>& mesh, const Motion& motion) {
  auto cache = std::make_shared<PointCache>();
  cache->points = int(mesh->vertices.size());
  for (int n = 0; n <= 240; ++n) {
    cache->times.push_back(float(n / 240.0));
    for (const Vec3& p : mesh->vertices) {
      const Vec3 q = motion(p, double(cache->times.back()));
      cache->places.push_back({float(q[0]), float(q[1]), float(q[2])});
    }
  }
  Collider c = tests::body_of(mesh);
  MeshBody& body = std::get<MeshBody>(c.shape);
  body.file = "body.obj";
  body.motion = std::move(cache);
  c.animation = "motion.mdd";
  return c;
}

// Turned about an axis askew, once a second, and moved.
Vec3 rigid(const Vec3& p, double time) {
  const double a = 6 * time, c = std::cos(a), s = std::sin(a);
  const Vec3 q{c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
  const double tilt = 0.5 * time, d = std::cos(tilt), e = std::sin(tilt);
  return {q[0] + 0.5 * time, d * q[1] - e * q[2], e * q[1] + d * q[2]};
}

// As much as a body that is put elsewhere and moves along keys besides.
struct Elsewhere {
  Vec3 by{};
  Vec3 speed{};
  Vec3 operator()(const Vec3& p, double time) const {
    Vec3 q;
    for (std::size_t k = 0; k < 3; ++k) q[k] = p[k] + by[k] + time * speed[k];
    return q;
  }
  void put(Collider& c) const {
    MeshBody& body = std::get<MeshBody>(c.shape);
    body.translate = by;
    if (speed != Vec3{}) c.keys = {{0, by}, {10, (*this)({}, 10)}};
    body.surface = surface_of(body);
  }
};

// A sheet of which some particles start at, inside and off the surface of a body about zero.
Scene hung(bool mesh, const Elsewhere& at) {
  Scene scene;
  scene.gravity = {0, -1, 0};
  if (mesh) {
    Cloth& cloth = scene.cloths.emplace_back();
    cloth.mesh.shape = made_up({.nx = 8, .ny = 8, .width = 0.8, .height = 0.8, .shift = 0.2});
    cloth.mesh.translate = at({-0.4, 0.25, -0.4}, 0);
    for (const int p : {0, 7, 27, 63}) cloth.pins.push_back({p, 0, {}, {}, 0});
  } else {
    scene.cloths.push_back(flat_sheet(8, 0.8, at({0, 0.25, 0}, 0)));
    for (const int p : {0, 7, 27, 63}) scene.cloths[0].pins.push_back({p % 8, p / 8, {}, {}, 0});
  }
  if (!mesh) scene.cloths[0].stiffness = {30, 10, 1};
  return scene;
}

double off(const Simulation& run, const std::vector<double>& start, const Elsewhere& at,
           const Motion& motion) {
  const std::vector<double> now = run.positions();
  double most = 0;
  for (const std::size_t p : {0, 7, 27, 63}) {
    Vec3 from{start[3 * p], start[3 * p + 1], start[3 * p + 2]};
    for (std::size_t k = 0; k < 3; ++k) from[k] -= at.by[k];
    const Vec3 q = at(motion(from, run.time()), run.time());
    most =
        std::max(most, std::hypot(now[3 * p] - q[0], now[3 * p + 1] - q[1], now[3 * p + 2] - q[2]));
  }
  return most;
}

// Of a body that moves as it is, wherever it stands, pins are as if they were part of it.
TEST(MeshFollow, PinsTurnWithABodyThatTurns) {
  const auto ball = tests::ball(17, 11, 0.25);
  for (const bool mesh : {false, true})
    for (const Method method : {Method::spring, Method::compliant})
      for (const Elsewhere& at : {Elsewhere{}, Elsewhere{{300, 2, -5}, {0.1, 0.3, -0.2}}}) {
        Scene scene = hung(mesh, at);
        scene.solver.method = method;
        scene.colliders.push_back(animated(ball, rigid));
        at.put(scene.colliders[0]);
        scene.colliders[0].cuts = false;
        ASSERT_TRUE(validate(scene).empty()) << validate(scene)[0].what;
        Simulation run(scene, {.threads = 2});
        const std::vector<double> start = run.positions();
        for (int n = 0; n < 30; ++n) {
          run.advance_frame();
          ASSERT_TRUE(run.status().ok);
          // Between samples, 0.025 rad apart, points come up to 8e-5 of their distance inwards.
          ASSERT_LT(off(run, start, at, rigid), 1.5e-4) << n;
        }
      }
}

// On the face of a box that grows, a point goes outwards along the face with it, and keeps its distance from it.
TEST(MeshFollow, DistancesFromTheSurfaceAreKept) {
  const auto box = tests::box({0.5, 0.25, 0.5});
  const auto grows = [](const Vec3& p, double time) {
    Vec3 q;
    for (std::size_t k = 0; k < 3; ++k) q[k] = (1 + time) * p[k];
    return q;
  };
  Scene scene;
  scene.cloths.push_back(flat_sheet(8, 0.6, {0.05, 0.3, 0.02}));
  scene.cloths[0].pins = {{1, 2, {}, {}, 0}, {5, 6, {{0, {0, 0.3, 0}}, {1, {0, 0.4, 0}}}, {}, 0}};
  scene.colliders.push_back(animated(box, grows));
  Elsewhere{}.put(scene.colliders[0]);
  Simulation run(scene, {.threads = 1});
  const std::vector<double> start = run.positions();
  for (int n = 0; n < 30; ++n) run.advance_frame();
  const std::vector<double> now = run.positions();
  const double t = run.time();
  const std::size_t p = 3 * (2 * 8 + 1), q = 3 * (6 * 8 + 5);
  EXPECT_NEAR(now[p], (1 + t) * start[p], 1e-5);
  EXPECT_NEAR(now[p + 1], start[p + 1] + 0.25 * t, 1e-5);
  EXPECT_NEAR(now[p + 2], (1 + t) * start[p + 2], 1e-5);
  // One with a path of its own, from the middle of the face.
  EXPECT_NEAR(now[q], 0, 1e-5);
  EXPECT_NEAR(now[q + 1], 0.3 + 0.1 * t + 0.25 * t, 1e-5);
}

// A pin far off a body that turns goes faster than any vertex of it: that is what it drives the sheet by.
TEST(MeshFollow, FarOffABodyThatTurnsNoEnergyComesFromNowhere) {
  const auto turns = [](const Vec3& p, double time) {
    const double a = 6 * time, c = std::cos(a), s = std::sin(a);
    return Vec3{c * p[0] - s * p[2], p[1], s * p[0] + c * p[2]};
  };
  for (const bool lines : {false, true})
    for (const bool follows : {false, true}) {
      Scene scene;
      scene.cloths.push_back(flat_sheet(8, 0.5, {2.3, 0, 0}));
      scene.solver.method = Method::compliant;
      scene.solver.sweep = lines ? Sweep::line : Sweep::gauss_seidel;
      scene.colliders.push_back(animated(tests::ball(17, 11, 0.05), turns));
      Elsewhere{}.put(scene.colliders[0]);
      for (int i = 0; i < 8; ++i) {
        Pin pin{i, 0, {}, {}, follows ? 0 : -1};
        if (!follows) pin.rotate = {{0, -1, 0}, {}, {{0, 0}, {1, 6 * 180 / 3.14159265358979}}};
        scene.cloths[0].pins.push_back(pin);
      }
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 40; ++n) {
        run.advance_frame();
        ASSERT_EQ(run.status().text, "ok") << n << ' ' << lines << follows;
      }
      for (const std::string& note : run.plan().notes)
        EXPECT_EQ(note.find("energy"), std::string::npos) << note << lines << follows;
    }
}

// Between two samples a body may be turned inside out.
TEST(MeshFollow, ABodyWithoutExtentHasAPlaceForItsPins) {
  const auto flips = [](const Vec3& p, double time) {
    const double share = std::clamp(1 - 4 * time, -1.0, 1.0);
    return Vec3{share * p[0], share * p[1], share * p[2]};
  };
  auto cache = std::make_shared<PointCache>();
  const auto ball = tests::ball(17, 11, 0.25);
  cache->points = int(ball->vertices.size());
  for (const double time : {0.0, 0.5}) {
    cache->times.push_back(float(time));
    for (const Vec3& p : ball->vertices) {
      const Vec3 q = flips(p, time);
      cache->places.push_back({float(q[0]), float(q[1]), float(q[2])});
    }
  }
  Collider c = animated(ball, flips);
  std::get<MeshBody>(c.shape).motion = cache;
  Scene scene = hung(false, {});
  scene.time.substeps = 10;
  scene.colliders.push_back(c);
  Elsewhere{}.put(scene.colliders[0]);
  Simulation run(scene, {.threads = 1});
  const int frames = whole_sweeps() ? 40 : 20;  // it is a point after fifteen
  for (int n = 0; n < frames; ++n) run.advance_frame();
  EXPECT_TRUE(run.status().ok) << run.status().text;
}

// Vertices of a mesh lie in rows, of which its pins know nothing.
TEST(MeshFollow, APinThatBeginsToMoveWakesTheSheet) {
  const auto late = [](const Vec3& p, double time) {
    return Vec3{p[0] + std::max(0.0, time - 0.5), p[1], p[2]};
  };
  for (const bool keys : {false, true})
    for (const int corner : {0, 119}) {
      Scene scene;
      scene.gravity = {};
      Cloth& cloth = scene.cloths.emplace_back();
      cloth.mesh.shape = made_up({.nx = 120, .ny = 5, .width = 6, .height = 0.2});
      cloth.drag = 1;
      scene.solver.sleep = 1e-3;
      scene.colliders.push_back(animated(tests::ball(17, 11, 0.05), late));
      Elsewhere{{0, -1, 0}}.put(scene.colliders[0]);
      const Vec3 at = placed_vertices(cloth.mesh)[std::size_t(corner)];
      Pin pin{corner, 0, {}, {}, keys ? -1 : 0};
      if (keys) pin.keys = {{0, at}, {0.5, at}, {1, {at[0] + 0.5, at[1], at[2]}}};
      cloth.pins = {pin};
      Simulation run(scene, {.threads = 2});
      while (run.time() < 1) run.advance_frame();
      EXPECT_NEAR(run.positions()[3 * std::size_t(corner)], at[0] + 0.5, 0.02) << keys << corner;
    }
}

TEST(MeshFollow, SameBitsForAnyThreads) {
  Scene scene = hung(true, {});
  scene.colliders.push_back(animated(tests::ball(17, 11, 0.2), rigid));
  Elsewhere{}.put(scene.colliders[0]);
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 3}) {
    Simulation run(scene, {.threads = threads});
    for (int n = 0; n < 12; ++n) run.advance_frame();
    hashes.push_back(run.hash());
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace
}  // namespace weft
