// The curvature energy: forces are its gradient, kernels agree with it, and runs stay stable.
#include <gtest/gtest.h>

#include <cmath>

#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/energy.h"
#include "weft/random.h"
#include "weft/simulation.h"

namespace weft::physics {
namespace {

Cloth sheet(int nx, int ny, double bending) {
  Cloth c;
  c.grid.nx = nx;
  c.grid.ny = ny;
  c.grid.u = {1.3, 0, 0};
  c.bending = bending;
  c.stiffness = {0, 0, 0};
  return c;
}

std::vector<Vec3> crumpled(const Cloth& c) {
  Lattice l = make_lattice(c, 0, 1, false);
  std::vector<Vec3> x = l.gather(l.x);
  Random random(3, 0);
  for (Vec3& p : x)
    for (double& v : p) v += 0.05 * random.symmetric();
  return x;
}

TEST(Bending, ForceIsTheGradientOfTheEnergy) {
  const Cloth c = sheet(6, 5, 0.02);
  std::vector<Vec3> x = crumpled(c), force(x.size(), Vec3{});
  add_bending_forces(
      c, [&](int p, int k) { return x[p][k]; }, force);
  for (std::size_t p = 0; p < x.size(); ++p)
    for (int k = 0; k < 3; ++k) {
      const double before = x[p][k], h = 1e-5;
      x[p][k] = before + h;
      const double above = bending_energy(c, x);
      x[p][k] = before - h;
      const double below = bending_energy(c, x);
      x[p][k] = before;
      EXPECT_NEAR(force[p][k], (below - above) / (2 * h), 1e-6 * std::abs(force[p][k]) + 1e-7);
    }
}

TEST(Bending, ACylinderHoldsHalfTheRigidityTimesItsSquaredCurvature) {
  for (const bool along_u : {true, false}) {
    Cloth c = sheet(81, 61, 0.02);
    std::vector<Vec3> x;
    const double r = 0.8;
    for (int j = 0; j < 61; ++j)
      for (int i = 0; i < 81; ++i) {
        const double u = 1.3 * i / 80, v = j / 60.0, s = along_u ? u : v, t = along_u ? v : u;
        x.push_back({r * std::sin(s / r), r * std::cos(s / r), t});
      }
    // Two of n particles of a line are in no second difference's middle.
    const double lines = along_u ? 79.0 / 80 : 59.0 / 60;
    EXPECT_NEAR(bending_energy(c, x), 0.5 * 0.02 * 1.3 / (r * r) * lines,
                1e-3 * bending_energy(c, x));
  }
}

TEST(Bending, OneSubstepOfTheSpringMethodFeelsTheForce) {
  // From rest, one substep of dt moves a particle by the acceleration's share.
  for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512}) {
    if (!simd_available(simd)) continue;
    Scene scene;
    scene.gravity = {0, 0, 0};
    scene.time = {1e-4, 1, 1};
    scene.cloths.push_back(sheet(21, 18, 0.002));
    scene.cloths[0].stiffness = {10, 0, 0};
    Options options;
    options.simd = simd;
    Simulation simulation(scene, options);
    const std::vector<Vec3> start = crumpled(scene.cloths[0]);
    std::vector<double> x, v(start.size() * 3, 0.0);
    for (const Vec3& p : start) x.insert(x.end(), p.begin(), p.end());
    simulation.set_state(x, v);
    ASSERT_EQ(simulation.scene().solver.method, Method::spring);
    simulation.advance_frame();
    const std::vector<double> after = simulation.velocities();
    // v(dt) = dt (a(0) + a(dt))/2 to second order; both from the energy in double.
    const auto acceleration = [&](const std::vector<double>& flat) {
      std::vector<Vec3> p(start.size());
      for (std::size_t n = 0; n < p.size(); ++n)
        p[n] = {flat[3 * n], flat[3 * n + 1], flat[3 * n + 2]};
      std::vector<Vec3> f =
          spring_forces(scene.cloths[0], stencils_of(scene.cloths[0]), p, nullptr);
      add_bending_forces(
          scene.cloths[0], [&](int n, int k) { return p[n][k]; }, f);
      for (std::size_t n = 0; n < f.size(); ++n)
        for (double& k : f[n]) k /= particle_mass(scene.cloths[0], int(n) % 21, int(n) / 21);
      return f;
    };
    const std::vector<Vec3> a = acceleration(x), b = acceleration(simulation.positions());
    double largest = 0, worst = 0;
    for (std::size_t n = 0; n < a.size(); ++n)
      for (int k = 0; k < 3; ++k) {
        const double expected = 1e-4 * (a[n][k] + b[n][k]) / 2;
        largest = std::max(largest, std::abs(expected));
        worst = std::max(worst, std::abs(after[3 * n + k] - expected));
      }
    EXPECT_LT(worst, 1e-3 * largest) << simd_name(simd);
  }
}

TEST(Bending, AutomaticSubstepsKeepAStiffSheetStable) {
  for (const double d : {1e-6, 1e-3, 1e-1}) {
    Scene scene;
    Cloth c = sheet(20, 20, d);
    c.stiffness = {1000, 500, 0};
    c.pins = {{0, 0, {}}, {19, 0, {}}};
    scene.cloths.push_back(c);
    Simulation simulation(scene);
    const double before = simulation.report().energy.total;
    for (int f = 0; f < 60; ++f) simulation.advance_frame();
    ASSERT_TRUE(simulation.status().ok) << simulation.status().text;
    EXPECT_NEAR(simulation.report().energy.total, before, 0.02) << d;
  }
}

TEST(Bending, MethodsThatProjectReachTheSameRestAsTheForce) {
  // A small sheet clamped at one edge, sagging under its weight.
  const auto at_rest = [](Method method, Sweep sweep) {
    Scene scene;
    scene.solver.method = method;
    scene.solver.sweep = sweep;
    scene.time.substeps = method == Method::spring ? kAutoSubsteps : 24;
    Cloth c = sheet(12, 7, 0.05);
    c.grid.u = {1, 0, 0};
    c.grid.v = {0, 0, 0.5};
    c.stiffness = {2000, 1000, 0};
    c.drag = 5;
    for (int j = 0; j < 7; ++j) {
      c.pins.push_back({0, j, {}});
      c.pins.push_back({1, j, {}});
    }
    scene.cloths.push_back(c);
    Simulation simulation(scene);
    for (int f = 0; f < 240; ++f) simulation.advance_frame();
    EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
    return -simulation.positions()[3 * (3 * 12 + 11) + 1];
  };
  const double force = at_rest(Method::spring, Sweep::gauss_seidel);
  EXPECT_GT(force, 0.05);
  EXPECT_NEAR(at_rest(Method::compliant, Sweep::line), force, 0.01 * force);
  EXPECT_NEAR(at_rest(Method::compliant, Sweep::gauss_seidel), force, 0.02 * force);
}

}  // namespace
}  // namespace weft::physics
