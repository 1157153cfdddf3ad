// Contact and friction against closed forms (validation.md). Figures go to standard output.
#include <cstdio>

#include "contact_scenes.h"

namespace weft {
namespace {

// Loose particles on the ground under gravity that is tilted by `degrees`.
Scene incline(double degrees, double statik, double dynamic, Method method) {
  Scene scene;
  const double a = degrees * M_PI / 180;
  scene.gravity = {9.81 * std::sin(a), -9.81 * std::cos(a), 0};
  scene.time.substeps = 20;
  scene.solver.method = method;
  scene.cloths.push_back(loose_particles({0, 0, 0}));
  scene.colliders.push_back(collider_of(Plane{}));
  scene.colliders[0].friction = {FrictionModel::coulomb, statik, dynamic};
  return scene;
}

TEST(ValidationContact, InclineSticksBelowTheAngleOfFriction) {
  for (const Method method : {Method::spring, Method::compliant})
    for (const double mu : {0.3, 0.5}) {
      const double limit = std::atan(mu) * 180 / M_PI;
      Simulation below(incline(limit - 0.1, mu, mu / 2, method));
      Simulation above(incline(limit + 0.1, mu, mu / 2, method));
      const double start = at(below.positions(), 0)[0];
      advance(below, 1);
      advance(above, 1);
      EXPECT_NEAR(at(below.positions(), 0)[0], start, 1e-6);
      EXPECT_GT(at(above.positions(), 0)[0], start + 0.1);
      std::printf("incline, mu %.1f: sticks at %.2f deg, slides at %.2f deg\n", mu, limit - 0.1,
                  limit + 0.1);
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
    const double truth = 9.81 * (std::sin(a) - mu * std::cos(a));
    std::printf("incline 30 deg, mu 0.3: %.5f m/s2 (closed form %.5f)\n", rate, truth);
    EXPECT_NEAR(rate / truth, 1, 0.01);
    EXPECT_NEAR(at(simulation.velocities(), 0)[1], 0, 0.02);
  }
}

TEST(ValidationContact, MovingSurfaceDragsClothAlong) {
  Scene scene = incline(0, 0.5, 0.5, Method::spring);
  scene.colliders[0].keys = {{0, {0, 0, 0}}, {2, {1, 0, 0}}};
  Simulation simulation(scene);
  const double start = at(simulation.positions(), 0)[0];
  advance(simulation, 1);
  EXPECT_NEAR(at(simulation.velocities(), 0)[0], 0.5, 1e-4);
  // It lags by what it takes to reach the speed: u²/(2 μ g).
  EXPECT_NEAR(at(simulation.positions(), 0)[0] - start, 0.5 - 0.25 / (2 * 0.5 * 9.81), 2e-3);
}

TEST(ValidationContact, LeavesAFrictionlessSphereAtTwoThirds) {
  Scene scene;
  scene.time.substeps = 200;
  scene.cloths.push_back(loose_particles({0, 0, 0}));
  scene.colliders.push_back(collider_of(Sphere{{0, 0, 0}, 1}));
  Simulation simulation(scene);
  // All four start near the top, at different angles from it.
  std::vector<double> x, v(12);
  for (const double angle : {0.02, 0.03, 0.05, 0.1})
    x.insert(x.end(), {std::sin(angle), std::cos(angle), 0});
  simulation.set_state(x, v);
  advance(simulation, 2.5);
  // In free flight the speed along x stays what it was when the particle left: there v² = g r cos θ,
  // so that vx² = g r cos³ θ.
  const std::vector<double> speed = simulation.velocities();
  for (std::size_t p = 0; p < 4; ++p) {
    const double start = std::array{0.02, 0.03, 0.05, 0.1}[p];
    const double truth = 2 / 3. * std::cos(start), left = std::cbrt(speed[3 * p] * speed[3 * p] / 9.81);
    ASSERT_LT(at(simulation.positions(), p)[1], 0.5);
    std::printf("sphere left at %.2f deg (%.2f)\n", std::acos(left) * 180 / M_PI,
                std::acos(truth) * 180 / M_PI);
    EXPECT_NEAR(left, truth, 0.002);
  }
}

TEST(ValidationContact, NoEnergyIsGainedOnAFixedSurface) {
  Scene scene;
  scene.time.substeps = 20;
  scene.cloths.push_back(loose_particles({0, 0.3, 0}));
  scene.colliders.push_back(collider_of(Plane{{0, 0, 0}, {0.2, 1, 0.1}}));
  Simulation simulation(scene);
  double before = simulation.report().energy.total;
  for (int n = 0; n < 60; ++n) {
    simulation.advance_frame();
    const Report r = simulation.report();
    EXPECT_LE(r.energy.total, before + 1e-5 * std::abs(before));
    before = r.energy.total;
  }
}

// A strip over a fixed cylinder, wrapped by β = π, loads its two ends unequally: it slips when the
// ratio of the tensions passes e^{μπ}.
bool slips(double mu, double ratio) {
  Scene scene;
  scene.time.substeps = 100;
  const int n = 201;
  Cloth strip;
  strip.grid.nx = n;
  strip.grid.ny = 2;
  strip.grid.origin = {-1, 0, 0};
  strip.grid.u = {2, 0, 0};
  strip.grid.v = {0, 0, 0.01};
  strip.stiffness = {2000, 0, 0};
  strip.drag = 8;
  strip.masses.assign(std::size_t(2 * n), 1e-5);
  for (const int j : {0, 1}) {
    strip.masses[std::size_t(j * n)] = 0.02;
    strip.masses[std::size_t(j * n + n - 1)] = 0.02 * ratio;
  }
  scene.cloths.push_back(strip);
  scene.colliders.push_back(collider_of(Capsule{{0, 0, -1}, {0, 0, 1}, 0.2}, mu));
  scene.solver.method = Method::compliant;
  scene.solver.iterations = 4;
  Simulation simulation(scene);
  // Laid over the cylinder: an arc of half a turn and two straight ends.
  const double radius = 0.2, arc = M_PI * radius, end = (2 - arc) / 2;
  std::vector<double> x, v(std::size_t(6 * n));
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < n; ++i) {
      const double s = 2.0 * i / (n - 1) - end, angle = std::clamp(s / radius, 0.0, M_PI);
      const double below = s < 0 ? s : s > arc ? arc - s : 0;
      x.insert(x.end(), {-radius * std::cos(angle), radius * std::sin(angle) + below, 0.01 * j});
    }
  simulation.set_state(x, v);
  advance(simulation, 1.0);
  const double settled = at(simulation.positions(), 0)[1];
  advance(simulation, 2.0);
  return at(simulation.positions(), 0)[1] > settled + 0.01;
}

TEST(ValidationContact, StripOverACylinderSlipsAtTheCapstanRatio) {
  for (const double mu : {0.2, 0.3, 0.5}) {
    const double truth = std::exp(mu * M_PI);
    double low = 1, high = 2 * truth;
    for (int n = 0; n < 8; ++n) (slips(mu, (low + high) / 2) ? high : low) = (low + high) / 2;
    std::printf("capstan, mu %.1f: slips at %.3f (e^(mu pi) = %.3f)\n", mu, (low + high) / 2,
                truth);
    EXPECT_NEAR((low + high) / 2 / truth, 1, 0.08);
  }
}

// Sheets laid over every shape: no particle deeper than 1e-4 of the collider's size.
TEST(ValidationContact, NoParticleIsDeeperThanATenThousandthOfTheCollider) {
  struct Row {
    const char* name;
    Shape shape;
    double size;
  };
  for (const Row& row : {Row{"sphere", Sphere{{0, 0, 0}, 0.3}, 0.3},
                         Row{"plane", Plane{{0, 0, 0}, {0.1, 1, 0}}, 1},
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
    std::printf("%s: deepest particle %.2g of its size\n", row.name, deepest / row.size);
    EXPECT_LE(deepest, 1e-4 * row.size);
  }
}

}  // namespace
}  // namespace weft
