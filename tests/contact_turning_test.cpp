// Bodies that turn, of all shapes: against particles moved in double precision by the definitions alone, and against the
// same scenes turned as a whole.
#include <algorithm>

#include "body_distance.h"
#include "contact_scenes.h"
#include "turning_bodies.h"

namespace weft {
namespace {

// By the definition of the shape; of the mesh, that of the ball it approximates to 1e-4 m.
double distance_by_definition(const Shape& shape, const Vec3& p) {
  return std::visit(
      [&](const auto& s) {
        if constexpr (std::is_same_v<decltype(s), const MeshBody&>)
          return length(minus(p, s.translate)) - 0.3;
        else
          return tests::distance_from(s, p);
      },
      shape);
}

TEST(ContactTurning, DistanceIsThatFromTheShapeTurnedBack) {
  for (const Shape& shape : shapes())
    for (const Motion& motion : motions()) {
      Collider turning = collider_of(shape);
      const Collider still = turning;
      motion.give(turning, 3);
      for (const double time : {0.0, 0.7, 2.9})
        for (int n = 0; n < 60; ++n) {
          const Vec3 p{std::sin(3.0 * n), 0.8 * std::cos(5.0 * n), 0.6 * std::sin(7.0 * n + 1)};
          const double truth = signed_distance(still, 0, motion.seen(p, time));
          EXPECT_NEAR(signed_distance(turning, time, p), truth, 1e-12) << shape.index();
          const Collider as_shape = collider_of(shape_at(turning, time));
          EXPECT_NEAR(signed_distance(as_shape, 0, p), truth, 1e-12) << shape.index();
        }
    }
}

TEST(ContactTurning, AnglesAreThoseOfTheTurnWhereverItStands) {
  for (int n = 0; n < 400; ++n) {
    const double tilt = n % 4 == 0 ? 90 : n % 4 == 1 ? 90 - std::pow(10, -n / 30.0) : 37 * n;
    const Matrix m = matrix_of({53.0 * n, tilt, 17.0 * n}), back = matrix_of(angles_of(m));
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(m[r][c], back[r][c], 4e-12) << n;
  }
}

// One particle in double precision: leapfrog, and at the end of each step out along the normal, with the loss of its
// speed into the surface, and Coulomb's friction against the surface's own velocity.
Vec3 moved_by_definition(const Shape& shape, const Motion& motion, double friction, double offset,
                         Vec3 x, double seconds) {
  constexpr double dt = 4e-5, h = 1e-6;
  Vec3 v{0, kGravity * dt / 2, 0};
  const int steps = int(std::lround(seconds / dt));
  for (int n = 1; n <= steps; ++n) {
    const double t = n * dt;
    v[1] -= kGravity * dt;
    x = plus(x, times(v, dt));
    const Vec3 p = motion.seen(x, t);
    const double left = distance_by_definition(shape, p) - offset;
    if (left >= 0) continue;
    Vec3 slope;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3 up = p, down = p;
      up[k] += h, down[k] -= h;
      slope[k] =
          (distance_by_definition(shape, up) - distance_by_definition(shape, down)) / (2 * h);
    }
    const Motion turn_alone{motion.axis, {}, {}, motion.rate};
    const Vec3 normal = turn_alone.in_scene(times(slope, 1 / length(slope)), t);
    const Vec3 carried = times(minus(x, motion.in_scene(motion.seen(x, t), t - dt)), 1 / dt);
    const Vec3 past = minus(v, carried);
    const double into = dot(past, normal);
    x = minus(x, times(normal, left));
    if (into >= 0) continue;
    const Vec3 along = minus(past, times(normal, into));
    const double lost = std::min(1.0, friction * -into / std::max(length(along), 1e-300));
    const Vec3 change = plus(times(normal, -into), times(along, -lost));
    v = plus(v, change);
    x = plus(x, times(times(along, -lost), dt));
  }
  return x;
}

// Loose particles in fours, small enough for all features to be resolved.
Scene rain(const Shape& shape, const Motion& motion, double friction, double seconds) {
  Scene scene;
  scene.gravity = {0, -kGravity, 0};
  scene.solver.method = Method::compliant;
  scene.time.frame = 0.02;
  scene.time.substeps = 60;
  for (const Vec3& at : {Vec3{0.05, 0, 0.1}, Vec3{0.15, 0, 0.02}, Vec3{-0.08, 0, 0.12}}) {
    double height = 1;  // until it touches
    while (distance_by_definition(shape, {at[0], height, at[2]}) > 0.03) height -= 0.005;
    scene.cloths.push_back(loose_particles({at[0], height, at[2]}));
  }
  scene.colliders.push_back(collider_of(shape, friction));
  scene.colliders[0].offset = 0.004;
  motion.give(scene.colliders[0], seconds);
  return scene;
}

TEST(ContactTurning, ParticlesGoAsInDoublePrecision) {
  constexpr double kSeconds = 0.36;
  for (const Shape& shape : shapes())
    for (const Motion& motion : motions())
      for (const double friction : {0.0, 0.3, 1.5}) {
        const Scene scene = rain(shape, motion, friction, kSeconds);
        Simulation simulation(scene);
        const std::vector<double> start = simulation.positions();
        advance(simulation, kSeconds);
        const std::vector<double> end = simulation.positions();
        double off = 0, moved = 0;
        for (std::size_t p = 0; p < start.size() / 3; p += 4) {
          const Vec3 truth =
              moved_by_definition(shape, motion, friction, 0.004, at(start, p), kSeconds);
          off = std::max(off, distance(truth, at(end, p)));
          moved = std::max(moved, distance(truth, at(start, p)));
        }
        const double allowed = std::holds_alternative<MeshBody>(shape) ? 8e-3 : 3e-3;
        EXPECT_LT(off, allowed) << kShapeNames[shape.index()] << ", rate " << motion.rate
                                << ", friction " << friction << ", moved " << moved;
        EXPECT_GT(moved, 0.05);
      }
}

// The line about which a body is the same however it is turned.
Motion about_its_axis(const Shape& shape, double rate) {
  return std::visit(
      [&](const auto& s) -> Motion {
        if constexpr (requires { s.normal; })
          return {s.normal, plus(s.point, {0.7, 3, 0.1}), {}, rate};
        else if constexpr (requires { s.a; })
          return {minus(s.b, s.a), s.a, {}, rate};
        else if constexpr (requires { s.center; })
          return {{0.3, 1, -0.5}, s.center, {}, rate};
        else
          return {{}, {}, {}, 0};
      },
      shape);
}

// Without friction nobody can tell whether a body of revolution turns about its axis: not from cloth that falls on
// it, slides down and off, in few substeps or many.
TEST(ContactTurning, AboutItsAxisWithoutFrictionIsLikeStandingStill) {
  for (const Shape& shape : shapes())
    for (const Method method : {Method::spring, Method::positional, Method::compliant})
      for (const double rate : {2.0, -9.0}) {
        const Motion motion = about_its_axis(shape, rate);
        if (motion.rate == 0 || std::holds_alternative<Box>(shape)) continue;
        Scene scene;
        scene.gravity = {0, -kGravity, 0};
        scene.solver.method = method;
        scene.time.substeps = rate > 0 ? 10 : 40;
        for (const double x : {-0.1, 0.0, 0.1, 0.2})
          scene.cloths.push_back(flat_sheet(2, 0.02, {x, 0.42, 0.06 + 0.4 * x}));
        for (Cloth& cloth : scene.cloths) cloth.stiffness = {300, 150, 0}, cloth.drag = 1;
        scene.colliders.push_back(collider_of(shape, 0));
        scene.colliders[0].offset = 0.005;
        Scene turning = scene;
        motion.give(turning.colliders[0], 1);
        Simulation still(scene), turned(turning);
        for (Simulation* s : {&still, &turned}) advance(*s, 0.34);
        const std::vector<double> x = still.positions(), y = turned.positions();
        double off = 0;
        for (std::size_t p = 0; p < x.size() / 3; ++p)
          off = std::max(off, distance(at(x, p), at(y, p)));
        EXPECT_LT(off, 2e-5) << kShapeNames[shape.index()] << " " << name_of(method) << ", rate "
                             << rate;
      }
}

Vec3 twist(const Vec3& p) {
  return turned_point(p, {0.2, 0.1, -0.3}, {1, 2, -0.5}, 1.1);
}

// The scene as a whole turned about some axis, the body by its rotation: as with the body turned by its own values, and
// as the other scene, but for how sheets that buckle grow what is rounded.
TEST(ContactTurning, ATurnedSceneEndsAsTheOtherTurned) {
  const Vec3 about{0.2, 0.1, -0.3}, axis{1, 2, -0.5}, origin = twist({0, 0, 0});
  for (const Shape& shape : shapes())
    for (const Method method : {Method::spring, Method::positional}) {
      Scene scene;
      scene.gravity = {0, -kGravity, 0};
      scene.solver.method = method;
      scene.time.substeps = 40;
      scene.cloths.push_back(flat_sheet(12, 0.5, {0.05, 0.5, 0.1}));
      scene.cloths[0].stiffness = {200, 100, 5};
      scene.colliders.push_back(collider_of(shape, 0.3));
      scene.colliders[0].offset = 0.01;
      Scene by_key = scene;
      by_key.gravity = minus(twist(scene.gravity), origin);
      Grid& grid = by_key.cloths[0].grid;
      grid.origin = twist(grid.origin);
      grid.u = minus(twist(grid.u), origin);
      grid.v = minus(twist(grid.v), origin);
      Scene by_value = by_key;
      by_key.colliders[0].rotate = {axis, about, {{0, 1.1 / kDegree}}};
      Shape& other = by_value.colliders[0].shape;
      other = turned(other, rotation(axis, 1.1), about);
      if (MeshBody* body = std::get_if<MeshBody>(&other)) body->surface = surface_of(*body);
      Scene near = by_value;  // what rounding of the body comes to
      near.colliders[0].offset += 1e-7;
      Simulation one(scene), two(by_key), three(by_value), four(near);
      for (Simulation* s : {&one, &two, &three, &four}) advance(*s, 0.28);
      const std::vector<double> x = one.positions(), y = two.positions(), z = three.positions();
      const std::vector<double> u = four.positions();
      double off = 0, apart = 0, rounding = 0;
      for (std::size_t p = 0; p < x.size() / 3; ++p) {
        off = std::max(off, distance(twist(at(x, p)), at(y, p)));
        apart = std::max(apart, distance(at(y, p), at(z, p)));
        rounding = std::max(rounding, distance(at(u, p), at(z, p)));
      }
      EXPECT_LT(apart, 3 * rounding + 1e-5) << kShapeNames[shape.index()] << " " << name_of(method);
      EXPECT_LT(off, 2e-2) << kShapeNames[shape.index()] << " " << name_of(method);
    }
}

Scene draped(const Shape& shape, const Motion& motion) {
  Scene scene;
  scene.gravity = {0, -kGravity, 0};
  scene.solver.method = Method::compliant;
  scene.cloths.push_back(flat_sheet(20, 0.9, {0.05, 0.5, 0.1}));
  scene.cloths[0].stiffness = {300, 100, 5};
  scene.colliders.push_back(collider_of(shape, 0.5));
  scene.colliders[0].offset = 0.01;
  motion.give(scene.colliders[0], 2);
  return scene;
}

// Cloth over bodies that turn does not sink in, and comes to the same bits by any threads and instructions; far away
// to the same place, but for how its start is rounded there.
TEST(ContactTurning, ClothStaysOutsideWithTheSameBits) {
  for (const Shape& shape : shapes()) {
    const Motion motion = motions()[1];
    const Scene scene = draped(shape, motion);
    Simulation one(scene, {.threads = 1}), two(scene, {.threads = 2, .simd = Simd::scalar});
    Simulation far(moved(scene, {1000, 0, -2000}), {.threads = 1});
    Simulation farther(moved(scene, {-3000, 64, 500}), {.threads = 2});
    double deepest = 0;
    for (int frame = 1; frame <= 20; ++frame) {
      for (Simulation* s : {&one, &two, &far, &farther}) s->advance_frame();
      if (frame % 5 == 0) deepest = std::max(deepest, one.report().penetration.collider_max);
    }
    EXPECT_EQ(one.positions(), two.positions()) << kShapeNames[shape.index()];
    EXPECT_LT(deepest, 1e-3) << kShapeNames[shape.index()];
    const std::vector<double> x = far.positions(), y = farther.positions();
    for (std::size_t p = 0; p < x.size() / 3; ++p)
      EXPECT_LT(distance(plus(at(x, p), {-4000, 64, 2500}), at(y, p)), 1e-3)
          << kShapeNames[shape.index()];
  }
}

}  // namespace
}  // namespace weft
