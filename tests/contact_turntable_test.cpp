// What turning bodies do to what lies on them, stands in their way or follows them, by closed forms.
#include <algorithm>

#include "contact_scenes.h"
#include "turning_bodies.h"

namespace weft {
namespace {

MeshBody slab(const Vec3& low, const Vec3& high) {
  MeshBody body;
  auto mesh = std::make_shared<TriangleMesh>();
  for (int n = 0; n < 8; ++n)
    mesh->vertices.push_back(
        {(n & 1 ? high : low)[0], (n & 2 ? high : low)[1], (n & 4 ? high : low)[2]});
  mesh->triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  body.shape = mesh;
  body.surface = surface_of(body);
  return body;
}

// Shapes with a level top at 0, on which a circle of 1.5 m about the axis y has room.
std::vector<Shape> tables() {
  return {Plane{{0.3, 0, 0.2}, {0, 1, 0}}, Cylinder{{0, -1, 0}, {0, 0, 0}, 2, 0},
          Box{{0, -1, 0}, {2, 1, 2}, {}, 0.1}, slab({-2, -1, -2}, {2, 0, 2})};
}

// A line of loose particles on a turntable, so far apart that none of their triangles is seen for one.
Scene turntable(const Shape& table, double rate, double friction, Method method, bool along) {
  Scene scene;
  scene.gravity = {0, -kGravity, 0};
  scene.solver.method = method;
  scene.time.substeps = 30;
  for (int n = 0; n < 5; ++n) {
    Cloth four = loose_particles({0.15 + 0.3 * n, 0, 0});
    const double r = 0.15 + 0.3 * n;
    four.spin = {0, along ? rate : 0, 0};
    four.velocity = {0, 0, along ? -rate * r : 0};
    scene.cloths.push_back(four);
  }
  scene.colliders.push_back(collider_of(table, friction));
  scene.colliders[0].rotate = {{0, 2, 0}, {0, 0, 0}, {{0, 0}, {10, 10 * rate / kDegree}}};
  return scene;
}

// Sliding on the turntable: x'' = -mu g u/|u|, u = x' - w × x; stays where nothing slides and mu g holds.
Vec3 slid(Vec3 x, Vec3 v, double rate, double friction, double seconds) {
  const int steps = 20000;
  const double dt = seconds / steps;
  for (int n = 0; n < steps; ++n) {
    x = plus(x, times(v, dt / 2));
    const Vec3 carried = cross({0, rate, 0}, x), past = minus(v, carried);
    const Vec3 inward = cross({0, rate, 0}, carried), wanted = minus(times(inward, dt), past);
    const double most = friction * kGravity * dt;
    v = plus(v, length(wanted) <= most ? wanted : times(wanted, most / length(wanted)));
    x = plus(x, times(v, dt / 2));
  }
  return x;
}

// Friction carries what is nearer to the axis than mu g / rate²; what is farther slides outward.
TEST(ContactTurntable, TurntablesCarryWhatIsWithinTheCriticalRadius) {
  constexpr double kRate = 2.5, kFriction = 0.4, kSeconds = 0.5;
  const double critical = kFriction * kGravity / (kRate * kRate);
  for (const Shape& table : tables())
    for (const Method method : {Method::spring, Method::compliant})
      for (const bool along : {true, false}) {
        Simulation simulation(turntable(table, kRate, kFriction, method, along));
        const std::vector<double> start = simulation.positions();
        advance(simulation, kSeconds);
        const std::vector<double> end = simulation.positions();
        int inside = 0, outside = 0;
        for (std::size_t p = 0; p < start.size() / 3; ++p) {
          const Vec3 x = at(start, p), now = at(end, p);
          const Vec3 v = along ? cross({0, kRate, 0}, x) : Vec3{};
          const Vec3 truth = slid(x, v, kRate, kFriction, kSeconds);
          EXPECT_LT(distance(now, truth), 4e-3) << kShapeNames[table.index()] << " " << length(x);
          if (!along) continue;
          const double radius = length(x);
          const Vec3 carried = turned_point(x, {}, {0, 1, 0}, kRate * kSeconds);
          if (radius < critical - 0.02) {
            EXPECT_LT(distance(now, carried), 2e-4) << radius;
            ++inside;
          } else if (radius > critical + 0.02) {
            EXPECT_GT(length(now), radius + 1e-3) << radius;
            ++outside;
          }
        }
        EXPECT_EQ(inside > 0 && outside > 0, along);
      }
}

// A thin blade whose tip comes 8 cm a substep pushes what floats before it; none gets behind it.
TEST(ContactTurntable, FastBladesPassThroughNothing) {
  const MeshBody mesh = slab({-0.8, -0.2, -0.005}, {0.8, 0.2, 0.005});
  for (const Shape& blade : {Shape(Box{{0, 0, 0}, {0.8, 0.2, 0.005}, {}, 0}), Shape(mesh),
                             Shape(Capsule{{-0.8, 0, 0}, {0.8, 0, 0}, 0.005}),
                             Shape(TaperedCapsule{{-0.8, 0, 0}, {0.8, 0, 0}, 0.006, 0.004})}) {
    Scene scene;
    scene.gravity = {};
    scene.solver.method = Method::compliant;
    scene.time.substeps = 10;
    for (int n = 0; n < 12; ++n) {
      const double a = (25 + 12 * n) * kDegree, r = 0.2 + 0.045 * n;
      Cloth loose = loose_particles({r * std::cos(a), 0, -r * std::sin(a)});
      loose.grid.u = {0.004, 0, 0}, loose.grid.v = {0, 0, 0.004};
      scene.cloths.push_back(loose);
    }
    scene.colliders.push_back(collider_of(blade));
    constexpr double kRate = 60;  // 0.1 rad a substep
    scene.colliders[0].rotate = {{0, 1, 0}, {}, {{0, 0}, {10, 10 * kRate / kDegree}}};
    Simulation simulation(scene);
    for (int frame = 1; frame * kRate / 60 < 165 * kDegree; ++frame) {
      simulation.advance_frame();
      const double now = kRate * simulation.time();
      const std::vector<double> x = simulation.positions();
      for (std::size_t p = 0; p < x.size() / 3; ++p) {
        const Vec3 seen = turned_point(at(x, p), {}, {0, 1, 0}, -now);
        if (length(seen) < 0.78) {
          EXPECT_LT(seen[2], 1e-3) << kShapeNames[blade.index()] << " frame " << frame;
        }
      }
    }
  }
}

// What sleeps on a table that starts to turn is carried along, and pins that follow a body turn with it.
TEST(ContactTurntable, SleepingClothWakesAndFollowersTurn) {
  for (const Shape& table : tables()) {
    Scene scene;
    scene.solver.method = Method::compliant;
    scene.solver.sleep = 0.02;
    scene.cloths.push_back(flat_sheet(10, 0.4, {0.3, 0.002, 0}));
    scene.cloths[0].drag = 2;
    scene.colliders.push_back(collider_of(table, 1));
    scene.colliders[0].rotate = {{0, 1, 0}, {}, {{2, 0}, {3, 90}}};
    Simulation simulation(scene);
    advance(simulation, 1.95);
    EXPECT_EQ(simulation.report().asleep, 100);
    const std::vector<double> before = simulation.positions();
    advance(simulation, 3.5);
    const std::vector<double> after = simulation.positions();
    for (std::size_t p = 0; p < before.size() / 3; ++p) {
      const Vec3 carried = turned_point(at(before, p), {}, {0, 1, 0}, 90 * kDegree);
      EXPECT_LT(distance(carried, at(after, p)), 0.05) << kShapeNames[table.index()];
    }
  }
  for (const Shape& shape : shapes())
    for (const Motion& motion : motions()) {
      Scene scene;
      scene.cloths.push_back(flat_sheet(6, 0.4, {3, 1, 0}));
      scene.cloths[0].pins = {{0, 0, {}}, {5, 0, {}}};
      for (Pin& pin : scene.cloths[0].pins) pin.follow = 0;
      scene.colliders.push_back(collider_of(shape));
      motion.give(scene.colliders[0], 2);
      Simulation simulation(scene);
      const std::vector<double> start = simulation.positions();
      advance(simulation, 0.4);
      for (const std::size_t p : {std::size_t(0), std::size_t(5)})
        EXPECT_LT(distance(motion.in_scene(at(start, p), simulation.time()),
                           at(simulation.positions(), p)),
                  1e-5);
    }
}

}  // namespace
}  // namespace weft
