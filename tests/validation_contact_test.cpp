// Contact and friction against closed forms, and what no contact may do: let through, add energy.
#include <algorithm>
#include <array>

#include "contact_scenes.h"
#include "truth.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

std::string friction_text(double mu) {
  char text[16];
  std::snprintf(text, sizeof text, "μ = %.1f", mu);
  return text;
}

// How far the particles come down the incline in a second [m].
double moved(double degrees, double mu, Method method) {
  Simulation simulation(incline(degrees, mu, mu / 2, method));
  const double start = at(simulation.positions(), 0)[0];
  advance(simulation, 1);
  return at(simulation.positions(), 0)[0] - start;
}

TEST(ValidationContact, InclineSticksBelowTheAngleOfFriction) {
  for (const Method method : {Method::spring, Method::compliant})
    for (const double mu : {0.3, 0.5}) {
      double low = 0, high = 60;
      for (int n = 0; n < 14; ++n) {
        const double middle = (low + high) / 2;
        (moved(middle, mu, method) > 0.1 ? high : low) = middle;
      }
      const std::string what = friction_text(mu) + ", " + name_of(method) + ": ";
      expect({"patch on an incline", what + "slides from", std::atan(mu) * 180 / M_PI, 2e-3, "°"},
             high);
      expect({"patch on an incline", what + "creeps in a second, 0.1° below", 0, 1e-6, "m"},
             moved(std::atan(mu) * 180 / M_PI - 0.1, mu, method));
    }
}

TEST(ValidationContact, InclineSlidesAtTheClosedFormsRate) {
  for (const Method method : {Method::spring, Method::compliant}) {
    const double degrees = 30, mu = 0.3, a = degrees * M_PI / 180;
    Simulation simulation(incline(degrees, mu, mu, method));
    advance(simulation, 0.2);
    const double early = at(simulation.velocities(), 0)[0], from = simulation.time();
    advance(simulation, 1);
    const double rate = (at(simulation.velocities(), 0)[0] - early) / (simulation.time() - from);
    const std::string what = std::string("30°, μ = 0.3, ") + name_of(method) + ": ";
    expect({"patch on an incline", what + "acceleration", 9.81 * (std::sin(a) - mu * std::cos(a)),
            0.01, "m/s²"},
           rate);
    expect({"patch on an incline", what + "velocity off the surface", 0, 0.02, "m/s"},
           at(simulation.velocities(), 0)[1]);
  }
}

// Rounding of the springs at a particle may push it too far once; others must not follow it.
TEST(ValidationContact, AnElasticPatchSticksBelowTheAngleOfStaticFriction) {
  const double mu = 0.4, degrees = std::atan(0.9 * mu) * 180 / M_PI, a = degrees * M_PI / 180;
  for (const Method method : {Method::spring, Method::compliant})
    for (const double turn : {0.0, 0.5, 1.1})
      for (const double dynamic : {0.1, 0.28, 0.4}) {
        const Vec3 place{0.3 * turn, 0.1, 0}, down{std::cos(a), -std::sin(a), 0};
        const Vec3 u = plus(times(down, std::cos(turn)), Vec3{0, 0, std::sin(turn)});
        const Vec3 v = plus(times(down, -std::sin(turn)), Vec3{0, 0, std::cos(turn)});
        Scene scene;
        scene.time.substeps = 64;
        scene.solver.method = method;
        scene.cloths.emplace_back();
        scene.cloths[0].grid = {10, 10, place, times(u, 0.36), times(v, 0.36), 0};
        scene.cloths[0].stiffness = {1000, 1000, 200};
        scene.colliders.push_back(collider_of(Plane{place, {std::sin(a), std::cos(a), 0}}));
        scene.colliders[0].friction = {FrictionModel::coulomb, mu, dynamic};
        Simulation simulation(scene);
        const std::vector<double> start = simulation.positions();
        advance(simulation, 1);
        double creep = 0;
        for (std::size_t p = 0; p < 100; ++p)
          creep = std::max(creep,
                           std::abs(dot(minus(at(simulation.positions(), p), at(start, p)), down)));
        char what[96];
        std::snprintf(what, sizeof what,
                      "μ = 0.4 and %.2f, at 0.9 of the angle, turned by %.1f rad, %s: way in 1 s",
                      dynamic, turn, name_of(method));
        expect({"elastic patch on an incline", what, 0, 1e-4, "m"}, creep);
      }
}

// Substeps so short that a particle at rest moves by less than its position is rounded to.
TEST(ValidationContact, FrictionIsTheSameInShortSubsteps) {
  const double a = 30 * M_PI / 180, mu = 0.3;
  for (const Method method : {Method::spring, Method::compliant}) {
    Scene scene;
    scene.time.substeps = 2000;
    scene.solver.method = method;
    const Vec3 place{0.41, 0.73, 0.3};
    scene.cloths.emplace_back();
    scene.cloths[0].grid = {4,           4, place, {0.1 * std::cos(a), -0.1 * std::sin(a), 0},
                            {0, 0, 0.1}, 0};
    scene.cloths[0].stiffness = {50, 20, 0};
    scene.colliders.push_back(collider_of(Plane{place, {std::sin(a), std::cos(a), 0}}, mu));
    Simulation simulation(scene);
    advance(simulation, 0.5);
    double speed = 0;
    for (std::size_t p = 0; p < 16; ++p) {
      const Vec3 v = at(simulation.velocities(), p);
      speed += (v[0] * std::cos(a) - v[1] * std::sin(a)) / 16;
    }
    expect({"patch on an incline",
            std::string("30°, μ = 0.3, substeps of 8.3 µs, ") + name_of(method) + ": acceleration",
            9.81 * (std::sin(a) - mu * std::cos(a)), 0.01, "m/s²"},
           speed / simulation.time());
  }
}

TEST(ValidationContact, MovingSurfaceDragsClothAlong) {
  Scene scene = incline(0, 0.5, 0.5, Method::spring);
  scene.colliders[0].keys = {{0, {0, 0, 0}}, {2, {1, 0, 0}}};
  Simulation simulation(scene);
  const double start = at(simulation.positions(), 0)[0];
  advance(simulation, 1);
  expect({"patch on a moving plane", "μ = 0.5: speed", 0.5, 2e-4, "m/s"},
         at(simulation.velocities(), 0)[0]);
  // It lags by what it takes to reach the speed: u²/(2 μ g).
  expect(
      {"patch on a moving plane", "μ = 0.5: way in 1 s", 0.5 - 0.25 / (2 * 0.5 * 9.81), 4e-3, "m"},
      at(simulation.positions(), 0)[0] - start);
}

TEST(ValidationContact, LeavesAFrictionlessSphereAtTwoThirds) {
  Scene scene;
  scene.time.substeps = 200;
  scene.cloths.push_back(loose_particles({0, 0, 0}));
  scene.colliders.push_back(collider_of(Sphere{{0, 0, 0}, 1}));
  Simulation simulation(scene);
  // All four start near the top, at different angles from it.
  const std::array starts = {0.02, 0.03, 0.05, 0.1};
  std::vector<double> x, v(12);
  for (const double angle : starts) x.insert(x.end(), {std::sin(angle), std::cos(angle), 0});
  simulation.set_state(x, v);
  advance(simulation, 2.5);
  // In free flight the speed along x stays what it was when the particle left: there v² = g r cos
  // θ, so that vx² = g r cos³ θ.
  const std::vector<double> speed = simulation.velocities();
  for (std::size_t p = 0; p < 4; ++p) {
    ASSERT_LT(at(simulation.positions(), p)[1], 0.5);
    char what[48];
    std::snprintf(what, sizeof what, "from rest %.3g rad off the top: left at", starts[p]);
    expect({"particle on a frictionless sphere", what,
            std::acos(2 / 3. * std::cos(starts[p])) * 180 / M_PI, 3e-3, "°"},
           std::acos(std::cbrt(speed[3 * p] * speed[3 * p] / 9.81)) * 180 / M_PI);
  }
}

// The angle from the top at which a particle is after sliding down a frictionless sphere of 1 m from
// rest for this time [rad], by the midpoint rule with Richardson's extrapolation.
double slid_to(double angle, double seconds) {
  const auto midpoint = [&](int steps) {
    double theta = angle, omega = 0;
    const double dt = seconds / steps;
    for (int n = 0; n < steps; ++n) {
      const double half = theta + dt / 2 * omega;
      const double faster = omega + dt / 2 * 9.81 * std::sin(theta);
      omega += dt * 9.81 * std::sin(half);
      theta += dt * faster;
    }
    return theta;
  };
  return (4 * midpoint(20000) - midpoint(10000)) / 3;
}

TEST(ValidationContact, SlidingIsOfSecondOrder) {
  constexpr double kStart = 0.3, kSeconds = 0.4;
  const double truth = slid_to(kStart, kSeconds);
  double angle = 0, off = 0, error[3];
  for (int n = 0; n < 3; ++n) {
    Scene scene;
    scene.time.frame = 0.04;
    scene.time.substeps = 1 << n;
    scene.cloths.push_back(loose_particles({0, 2, 0}));
    scene.colliders.push_back(collider_of(Sphere{{0, 0, 0}, 0.99}));
    scene.colliders[0].offset = 0.01;
    Simulation simulation(scene);
    std::vector<double> x, v(12);
    for (int p = 0; p < 4; ++p) x.insert(x.end(), {std::sin(kStart), std::cos(kStart), 0});
    simulation.set_state(x, v);
    advance(simulation, kSeconds);
    const Vec3 end = at(simulation.positions(), 0), speed = at(simulation.velocities(), 0);
    angle = std::atan2(end[0], end[1]);
    off = speed[0] * std::sin(angle) + speed[1] * std::cos(angle);
    error[n] = std::abs(angle - truth);
  }
  const char* const law = "particle sliding down a frictionless sphere";
  expect({law, "spring, substeps of 10 ms: angle after 0.4 s", truth, 1e-4, "rad"}, angle);
  expect({law, "spring, substeps of 10 ms: velocity off the surface", 0, 1e-3, "m/s"}, off);
  expect({law, "spring, substeps of 40, 20, 10 ms: order", 2, 0.05, ""},
         std::log2(error[0] / error[2]) / 2);
}

// Particles that fall on a fixed surface and slide down. Velocities are those that contact has
// left, in the view.
TEST(ValidationContact, FixedSurfaceTakesAwayEnergyAndNormalVelocity) {
  struct Row {
    const char* name;
    Shape shape;
    Method method;
  };
  const Plane plane = {{0, 0, 0}, {0.2, 1, 0.1}};
  const Sphere sphere = {{-0.1, -0.5, 0.05}, 0.5};
  for (const auto& [name, shape, method] :
       {Row{"tilted plane", plane, Method::spring}, Row{"tilted plane", plane, Method::compliant},
        Row{"sphere", sphere, Method::spring}, Row{"sphere", sphere, Method::compliant}}) {
    Scene scene;
    scene.time.substeps = 20;
    scene.solver.method = method;
    scene.cloths.push_back(loose_particles({0, 0.3, 0}));
    scene.colliders.push_back(collider_of(shape));
    Simulation simulation(scene);
    const double start = simulation.report().energy.total;
    double before = start, gained = 0, into = 0;
    int touching = 0;
    for (int n = 0; n < 60; ++n) {
      simulation.advance_frame();
      const double now = simulation.report().energy.total;
      gained = std::max(gained, (now - before) / start);
      before = now;
      const ClothView c = simulation.view().cloths[0];
      const Vec3 x = {c.x[0], c.y[0], c.z[0]};
      const double here = signed_distance(scene.colliders[0], 0, x);
      if (here > 1e-6) continue;
      ++touching;
      constexpr double dt = 1e-6;
      const Vec3 next = {x[0] + dt * c.vx[0], x[1] + dt * c.vy[0], x[2] + dt * c.vz[0]};
      into = std::max(into, (here - signed_distance(scene.colliders[0], 0, next)) / dt);
    }
    EXPECT_GT(touching, 10);
    const char* const law = "after contact with a fixed surface";
    const std::string what = std::string(name) + ", " + name_of(method) + ": ";
    expect({law, what + "energy gained in a frame", 0, 1e-5, "of E₀"}, gained);
    expect({law, what + "velocity into it", 0, 1e-4, "m/s"}, into);
  }
}

// Whether a strip over a fixed cylinder, wrapped by half a turn, slips when its ends are loaded
// with this ratio. It weighs a fiftieth of the lesser load.
bool slips(double mu, double ratio) {
  constexpr int n = 101;
  constexpr double kLoad = 0.02, kRadius = 0.2;
  Scene scene;
  Cloth strip;
  strip.grid = {n, 2, {-1, 0, 0}, {2, 0, 0}, {0, 0, 0.01}, 0};
  strip.stiffness = {2000, 0, 0};
  strip.drag = 4;
  strip.masses.assign(2 * n, kLoad / 50 / n);
  for (const std::size_t j : {0, 1}) {
    strip.masses[j * n] = kLoad;
    strip.masses[j * n + n - 1] = kLoad * ratio;
  }
  scene.cloths.push_back(strip);
  scene.colliders.push_back(collider_of(Capsule{{0, 0, -1}, {0, 0, 1}, kRadius}, mu));
  Simulation simulation(scene);
  // Laid over the cylinder: an arc of half a turn and two straight ends.
  const double arc = M_PI * kRadius, end = (2 - arc) / 2;
  std::vector<double> x, v(6 * n);
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < n; ++i) {
      const double s = 2.0 * i / (n - 1) - end, angle = std::clamp(s / kRadius, 0.0, M_PI);
      const double below = s < 0 ? s : s > arc ? arc - s : 0;
      x.insert(x.end(), {-kRadius * std::cos(angle), kRadius * std::sin(angle) + below, 0.01 * j});
    }
  simulation.set_state(x, v);
  advance(simulation, 2);
  const double settled = at(simulation.positions(), 0)[1];
  advance(simulation, 4);
  return at(simulation.positions(), 0)[1] > settled + 0.01;
}

TEST(ValidationContact, StripOverACylinderSlipsAtTheCapstanRatio) {
  for (const double mu : {0.2, 0.3, 0.5}) {
    const double truth = std::exp(mu * M_PI);
    double low = 0.95 * truth, high = 1.05 * truth;
    EXPECT_FALSE(slips(mu, low));
    EXPECT_TRUE(slips(mu, high));
    for (int n = 0; n < 5; ++n) (slips(mu, (low + high) / 2) ? high : low) = (low + high) / 2;
    expect({"strip over a fixed cylinder, wrapped by π", friction_text(mu) + ", spring: slips at",
            truth, 0.01, "T₂/T₁"},
           (low + high) / 2);
  }
}

// Sheets laid over every shape: no particle deeper than 1e-4 of the collider's size.
TEST(ValidationContact, NoParticleIsDeeperThanATenThousandthOfTheCollider) {
  struct Row {
    const char* name;
    Shape shape;
    double size;
  };
  for (const Row& row :
       {Row{"sphere", Sphere{{0, 0, 0}, 0.3}, 0.3}, Row{"plane", Plane{{0, 0, 0}, {0.1, 1, 0}}, 1},
        Row{"capsule", Capsule{{-0.3, 0.05, 0}, {0.3, 0, 0.1}, 0.2}, 0.2},
        Row{"box", Box{{0, 0, 0}, {0.25, 0.2, 0.25}, {0, 30, 0}, 0.02}, 0.2},
        Row{"sharp box", Box{{0, 0, 0}, {0.25, 0.2, 0.25}, {0, 30, 0}, 0}, 0.2}}) {
    Scene scene;
    scene.cloths.push_back(flat_sheet(40, 1, {0, 0.32, 0}));
    scene.cloths[0].drag = 1;
    scene.colliders.push_back(collider_of(row.shape, 0.3));
    Simulation simulation(scene);
    double deepest = 0;
    for (int n = 0; n < 60; ++n) {
      simulation.advance_frame();
      deepest = std::max(deepest, simulation.report().penetration.collider_max);
    }
    expect({"sheet laid over a collider", std::string(row.name) + ": deepest particle", 0, 1e-4,
            "of its size"},
           deepest / row.size);
  }
}

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  double along = 0, length = 0, squared = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    along += (p[c] - a[c]) * (b[c] - a[c]);
    length += (b[c] - a[c]) * (b[c] - a[c]);
  }
  const double t = std::clamp(along / length, 0.0, 1.0);
  for (std::size_t c = 0; c < 3; ++c) squared += std::pow(p[c] - a[c] - t * (b[c] - a[c]), 2);
  return std::sqrt(squared);
}

double distance_to_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  // Distance by the plane where p lies over the triangle, seen along its normal; else by its edges.
  const auto minus = [](const Vec3& a, const Vec3& b) {
    return Vec3{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
  };
  const auto cross = [](const Vec3& a, const Vec3& b) {
    return Vec3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const auto dot = [](const Vec3& a, const Vec3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const Vec3 normal = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  bool over = true;
  double edge = 1e9;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &a = t[k], &b = t[(k + 1) % 3];
    over = over && dot(cross(minus(b, a), minus(p, a)), normal) >= 0;
    edge = std::min(edge, distance_to_segment(p, a, b));
  }
  return over ? std::abs(dot(minus(p, t[0]), normal)) / length(normal) : edge;
}

// A ball as small as a fifth of the spacing meets the inside of a triangle and carries it along.
// While it moves, a triangle gives way once in a substep: it lies within the ball by what the ball
// comes on.
TEST(ValidationContact, NoTriangleIsThroughAColliderSmallerThanTheMesh) {
  Simulation simulation(read_scene("small_sphere").scene);
  const Collider& collider = simulation.scene().colliders[0];
  const Sphere& ball = std::get<Sphere>(collider.shape);
  double deepest = 0, nearest = 1e9;
  while (simulation.time() < 4) {
    simulation.advance_frame();
    const Vec3 way = displacement(collider, simulation.time());
    const Vec3 center = {ball.center[0] + way[0], ball.center[1] + way[1], ball.center[2] + way[2]};
    const int columns = simulation.scene().cloths[0].grid.nx;
    const std::vector<double> x = simulation.positions();
    for (int j = 0; j + 1 < columns; ++j)
      for (int i = 0; i + 1 < columns; ++i) {
        const auto p = std::size_t(j * columns + i), q = p + std::size_t(columns);
        for (const auto& t : {std::array{at(x, p), at(x, p + 1), at(x, q)},
                              std::array{at(x, p + 1), at(x, q + 1), at(x, q)}})
          nearest = std::min(nearest, distance_to_triangle(center, t));
      }
    deepest = std::max(deepest, ball.radius - nearest);
  }
  EXPECT_LT(nearest, 1.01 * ball.radius);  // they do meet
  expect({"collider smaller than the mesh", "ball of 0.2 spacings: deepest triangle", 0, 0.01,
          "of its radius"},
         deepest / ball.radius);
}

}  // namespace
}  // namespace weft
