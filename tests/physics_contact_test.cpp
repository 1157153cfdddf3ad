// Contact with spheres and planes: nothing below the surface, no velocity into it, Coulomb friction
// to the percent, and the course's own rules.
#include <gtest/gtest.h>

#include <functional>

#include "oracle.h"
#include "sheets.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

constexpr double kDegrees = 3.14159265358979323846 / 180;
using oracle::dot;
using oracle::length;
using oracle::operator-, oracle::operator+, oracle::operator*;

Collider with_friction(Shape shape, double statik, double dynamic) {
  Collider c;
  c.shape = std::move(shape);
  c.friction = {FrictionModel::coulomb, statik, dynamic};
  return c;
}

std::vector<Vec3> triples(const std::vector<double>& all) {
  std::vector<Vec3> v;
  for (std::size_t n = 0; n < all.size(); n += 3) v.push_back({all[n], all[n + 1], all[n + 2]});
  return v;
}

TEST(Contact, NothingBelowNorMovingInto) {
  for (const Method method : {Method::spring, Method::positional, Method::compliant}) {
    Scene scene;
    scene.cloths.emplace_back();
    Cloth& cloth = scene.cloths[0];
    cloth.grid = {30, 30, {-0.5, 0.45, -0.5}, {1, 0, 0}, {0, 0, 1}, 0};
    cloth.stiffness = {200, 100, 10};
    const Sphere ball{{0.05, 0.2, 0}, 0.2};
    const Plane floor{{0, 0, 0}, {0.1, 1, 0}};
    scene.colliders = {with_friction(floor, 0.4, 0.3), with_friction(ball, 0.3, 0.2)};
    scene.solver.method = method;
    scene.time = {1.0 / 60, method == Method::spring ? kAutoSubsteps : 20, 5};
    Simulation simulation(scene);
    const Vec3 up = (1 / std::sqrt(1.01)) * floor.normal;
    // A particle that rounding leaves just clear of the surface keeps what weight and springs
    // give it in one substep.
    const auto fall = [&] { return 3 * 9.81 * simulation.dt(); };
    for (int frame = 0; frame < 60; ++frame) {
      simulation.advance_frame();
      const View view = simulation.view();
      const ClothView& c = view.cloths[0];
      for (int j = 0; j < c.rows; ++j)
        for (int i = 0; i < c.columns; ++i) {
          const auto at = std::size_t(j * c.stride + i);
          const Vec3 x{c.x[at], c.y[at], c.z[at]}, v{c.vx[at], c.vy[at], c.vz[at]};
          const Vec3 n = (1 / length(x - ball.center)) * (x - ball.center);
          // Stages run floor, sphere: only the last is exact where both touch.
          ASSERT_GT(length(x - ball.center), ball.radius - 1e-6);
          const bool on_ball = length(x - ball.center) < ball.radius + 1.2e-7;  // to rounding
          if (on_ball) {
            ASSERT_GT(dot(v, n), -fall());
          } else {
            ASSERT_GT(dot(x, up), -1e-6);
            if (dot(x, up) < 6e-8) {
              ASSERT_GT(dot(v, up), -fall()) << i << ' ' << j;
            }
          }
        }
    }
    EXPECT_LT(simulation.report().penetration.collider_max, 1e-4);
  }
}

struct Slide {
  double way, speed;
};

// A sheet lies on a slope of `angle` degrees: how far and fast it goes along it in a second.
Slide slide_on_slope(double angle, double statik, double dynamic) {
  const double a = angle * kDegrees;
  Scene scene;
  scene.cloths.emplace_back();
  scene.cloths[0].grid = {4, 4, {0, 0, 0}, {std::cos(a), -std::sin(a), 0}, {0, 0, 1}, 0};
  scene.cloths[0].stiffness = {10, 10, 0};
  scene.colliders = {
      with_friction(Plane{{0, 0, 0}, {std::sin(a), std::cos(a), 0}}, statik, dynamic)};
  scene.time = {0.01, 10, 5};
  Simulation simulation(scene);
  advance(simulation, 1);
  const auto along = [&](const std::vector<double>& all) {
    double mean = 0;
    for (const Vec3& v : triples(all)) mean += (v[0] * std::cos(a) - v[1] * std::sin(a)) / 16;
    return mean;
  };
  return {along(simulation.positions()) - 0.5, along(simulation.velocities())};
}

TEST(Friction, SticksBelowTheAngleOfFrictionAndSlidesAbove) {
  for (const double mu : {0.3, 0.5}) {
    const double limit = std::atan(mu) / kDegrees;  // 16.70°, 26.57°
    EXPECT_NEAR(limit, mu == 0.3 ? 16.70 : 26.57, 0.005);
    EXPECT_LT(std::abs(slide_on_slope(0.99 * limit, mu, mu).way), 1e-5) << mu;
    EXPECT_GT(slide_on_slope(1.01 * limit, mu, mu).way, 0.01) << mu;
  }
}

TEST(Friction, SlidesAtTheRateOfTheDynamicCoefficient) {
  for (const auto& [angle, statik, dynamic] :
       {std::tuple{30.0, 0.3, 0.3}, {40.0, 0.5, 0.3}, {30.0, 0.5, 0.2}, {20.0, 0.0, 0.0}}) {
    const double a = angle * kDegrees;
    const double truth = 9.81 * (std::sin(a) - dynamic * std::cos(a));
    const double speed = slide_on_slope(angle, statik, dynamic).speed;
    EXPECT_NEAR(speed / truth, 1, 0.01) << angle << ' ' << statik << ' ' << dynamic;
  }
}

// Springs tell of velocities at the time of the positions, half a substep on from their own: what lies
// still on a ball and a floor is still, however much it is pulled down in a substep.
TEST(Contact, WhatRestsHasNoVelocity) {
  for (const int substeps : {1, 4}) {
    Scene scene = read_scene("pbr100").scene;
    scene.time.substeps = substeps;
    scene.cloths[0].drag = 1;
    Simulation simulation(scene);
    advance(simulation, 30);
    const auto velocities = simulation.velocities();
    double square = 0, fastest = 0;
    for (const double v : velocities) {
      square += v * v;
      fastest = std::max(fastest, std::abs(v));
    }
    EXPECT_LT(std::sqrt(square / 10000), 1e-3) << substeps;
    EXPECT_LT(fastest, 0.01) << substeps;
  }
}

// Where a particle set loose near the top of a smooth ball leaves it [degrees].
double leaving_angle(int substeps) {
  Scene scene;
  scene.cloths.emplace_back();
  // Four free particles close together: triangles too small for the ball to reach between them.
  scene.cloths[0].grid = {2, 2, {0.01, 1, 0}, {0.001, 0, 0}, {0, 0, 0.001}, 0};
  scene.cloths[0].stiffness = {0, 0, 0};
  scene.colliders = {with_friction(Sphere{{0, 0, 0}, 1}, 0, 0)};
  scene.time = {0.001, substeps, 5};
  Simulation simulation(scene);
  double angle = 0;
  for (int frame = 0; frame < 3000; ++frame) {
    simulation.advance_frame();
    const Vec3 d = position(simulation, 0, 0);
    if (length(d) < 1 + 1e-6) angle = std::acos(d[1] / length(d)) / kDegrees;
  }
  return angle;
}

TEST(Sphere, IsLeftAtTheRightAngle) {
  // The contact lets go when the particle clears the surface by rounding: late, by ever less.
  for (const auto& [substeps, tolerance] : {std::pair{1, 2.0}, {4, 1.3}, {16, 0.6}}) {
    const double angle = leaving_angle(substeps);
    std::printf("smooth ball, substep %g s: left at %.2f degrees, truth 48.19\n", 0.001 / substeps,
                angle);
    EXPECT_NEAR(angle, 48.19, tolerance);
  }
}

TEST(Sphere, CarriesWhatLiesOnIt) {
  Scene scene;
  scene.cloths.emplace_back();
  Cloth& cloth = scene.cloths[0];
  cloth.grid = {16, 16, {-0.15, 0.301, -0.15}, {0.3, 0, 0}, {0, 0, 0.3}, 0};
  cloth.drag = 1;
  scene.colliders = {with_friction(Sphere{{0, 0, 0}, 0.3}, 0.8, 0.8)};
  scene.colliders[0].keys = {{0.5, {0, 0, 0}}, {2.5, {1, 0, 0}}};
  scene.time = {1.0 / 60, kAutoSubsteps, 5};
  Simulation simulation(scene);
  advance(simulation, 2);
  const Vec3 x = position(simulation, 8, 8);
  const Vec3 center{0.75, 0, 0};
  EXPECT_NEAR(x[0], 0.75, 0.05);
  EXPECT_NEAR(length(x - center), 0.3, 1e-3);
  const auto v = triples(simulation.velocities())[8 * 16 + 8];
  EXPECT_NEAR(v[0], 0.5, 0.05);
}

// Free particles against the course's rules, one substep at a time, in double precision.
struct Flight {
  Vec3 before, x;
};

Vec3 course_sphere(const Flight& f, const Sphere& s, double friction) {
  const Vec3 d = f.x - s.center;
  if (length(d) > s.radius) return f.x;
  const Vec3 tangent = s.center + (s.radius / length(d)) * d;
  return f.before + (1 - friction) * (tangent - f.before);
}

Vec3 course_plane(const Flight& f, const Plane& p, double friction, double offset) {
  const Vec3 path = f.x - f.before, direction = (1 / length(path)) * path;
  const double t = dot(p.point - f.before, p.normal) / dot(p.normal, direction);
  if (t < 0 || t > length(path)) return f.x;
  const Vec3 target = f.before + (t - offset) * direction;
  return f.before + (1 - friction) * (target - f.before);
}

// One substep of loose particles thrown at a collider.
void expect_course_rule(const Collider& collider, const std::function<Vec3(const Flight&)>& rule) {
  Scene scene;
  scene.cloths.emplace_back();
  scene.cloths[0].grid = {21, 7, {-1, 0.02, -0.6}, {2, 0.03, 0}, {0, 0.1, 1.2}, 0};
  scene.cloths[0].stiffness = {0, 0, 0};
  scene.colliders = {collider};
  scene.time = {0.01, 1, 5};
  Simulation simulation(scene);
  const std::vector<Vec3> start = triples(simulation.positions());
  const Vec3 v{3, -20, 1};
  set_velocity(simulation, v);
  simulation.advance_frame();
  const std::vector<Vec3> end = triples(simulation.positions());
  int touched = 0;
  for (std::size_t p = 0; p < end.size(); ++p) {
    const Vec3 half = v - Vec3{0, 0.5 * 0.01 * 9.81, 0};
    const Flight flight{start[p], start[p] + 0.01 * half};
    const Vec3 truth = rule(flight);
    touched += length(truth - flight.x) > 1e-6;
    EXPECT_LT(length(end[p] - truth), 1e-6) << p;
  }
  EXPECT_GT(touched, 15);
  EXPECT_LT(touched, 140);
}

TEST(Course, RulesOfSphereAndPlaneAreTheCoursesOwn) {
  Collider c;
  c.friction = {FrictionModel::course, 0.3, 0.3};
  const Sphere sphere{{0.1, -0.35, 0}, 0.4};
  c.shape = sphere;
  expect_course_rule(c, [&](const Flight& f) { return course_sphere(f, sphere, 0.3); });
  const Plane plane{{0, -0.1, 0}, {0, 1, 0}};
  c.shape = plane;
  c.offset = 1e-4;
  c.friction = {FrictionModel::course, 0.5, 0.5};
  expect_course_rule(c, [&](const Flight& f) { return course_plane(f, plane, 0.5, 1e-4); });
}

}  // namespace
}  // namespace weft
