// Laws of contact between sheets: momentum is kept, energy is not gained, layers stick and slide as
// Coulomb says, piles rest a thickness apart; whatever the mode, the method, the thickness, the speed and
// how sheets lie on each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "machines.h"
#include "sheets.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr double kSide = 0.5;
constexpr int kPoints = 17;
constexpr double kSpacing = kSide / (kPoints - 1);

Cloth sheet(const Vec3& origin, SelfCollisionMode mode, double thickness, double friction) {
  Cloth cloth;
  cloth.grid = {kPoints, kPoints, origin, {kSide, 0, 0}, {0, 0, kSide}, 0};
  cloth.density = 0.3;
  cloth.stiffness = {1000, 1000, 200};
  cloth.self_collision.mode = mode;
  cloth.self_collision.thickness = thickness;
  cloth.self_collision.friction = friction;
  return cloth;
}

struct Way {
  Method method;
  Sweep sweep;
  int order, substeps;  // 0: automatic
};

struct Meeting {
  SelfCollisionMode mode;
  Way way;
  double thickness, speed;  // spacings, m/s of one sheet to the other
  Vec3 offset;              // of the upper sheet [m]
  double friction = 0;
};

Scene meeting_scene(const Meeting& m) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.time = {1.0 / 60, m.way.substeps, 0.5};
  scene.solver.method = m.way.method;
  scene.solver.sweep = m.way.sweep;
  scene.solver.order = m.way.order;
  scene.solver.iterations = 4;
  scene.solver.sleep = 0;
  const double thickness = m.thickness * kSpacing, gap = 1.5 * thickness;
  scene.cloths.push_back(sheet({0, 0, 0}, m.mode, thickness, m.friction));
  scene.cloths.push_back(
      sheet({m.offset[0], gap + m.offset[1], m.offset[2]}, m.mode, thickness, m.friction));
  return scene;
}

std::string name(const Meeting& m) {
  char text[200];
  std::snprintf(text, sizeof text,
                "mode %d method %d sweep %d order %d substeps %d, %.2g spacings, %.3g m/s, "
                "offset %.3g %.3g, friction %.2g",
                int(m.mode), int(m.way.method), int(m.way.sweep), m.way.order, m.way.substeps,
                m.thickness, m.speed, m.offset[0], m.offset[2], m.friction);
  return text;
}

void expect_laws(const Meeting& m, const Options& options = {}) {
  Simulation simulation(meeting_scene(m), options);
  const std::vector<double> x = simulation.positions();
  std::vector<double> v(x.size(), 0.0);
  for (std::size_t n = 0; n < v.size() / 3; ++n)
    v[3 * n + 1] = n < v.size() / 6 ? m.speed / 2 : -m.speed / 2;
  simulation.set_state(x, v);
  const Report start = simulation.report();
  // Time to meet, and as long again and more.
  const double seconds = std::clamp(3 * m.thickness * kSpacing / m.speed, 0.1, 0.4);
  double most = 0;
  const double sum = 2 * 0.3 * kSide * kSide * m.speed / 2;  // Σ m |v|
  Report r = start;
  while (simulation.time() < seconds) {
    simulation.advance_frame();
    r = simulation.report();
    most = std::max(most, r.energy.total);
  }
  double linear = 0, angular = 0;
  for (int k = 0; k < 3; ++k) {
    linear = std::max(linear, std::abs(r.momentum[k] - start.momentum[k]));
    angular = std::max(angular, std::abs(r.angular_momentum[k] - start.angular_momentum[k]));
  }
  EXPECT_LT(r.energy.kinetic, 0.99 * start.energy.kinetic) << name(m) << ": do not meet";
  EXPECT_LE(most / start.energy.total - 1, 1e-3) << name(m);
  // (The sweeps of `positional` do not keep momentum themselves, to some 1e-4, once a sheet deforms.)
  EXPECT_LE(linear / sum, m.way.method == Method::positional ? 5e-3 : 1e-6) << name(m);
  if (m.friction == 0) {
    EXPECT_LE(angular / (sum * kSide), m.way.method == Method::positional ? 5e-3 : 1e-3) << name(m);
  }
  EXPECT_EQ(r.penetration.crossings, 0) << name(m);
}

constexpr Way kSprings{Method::spring, Sweep::gauss_seidel, 1, 0};
constexpr Way kWays[] = {kSprings,
                         {Method::spring_friction, Sweep::gauss_seidel, 1, 0},
                         {Method::compliant, Sweep::gauss_seidel, 1, 40},
                         {Method::compliant, Sweep::gauss_seidel, 2, 40},
                         {Method::compliant, Sweep::jacobi, 1, 60},
                         {Method::positional, Sweep::gauss_seidel, 1, 40}};

TEST(SelfCollisionLaws, FreeSheetsThatMeetKeepMomentumAndGainNoEnergy) {
  const Vec3 offsets[] = {{0, 0, 0}, {0.11 * kSpacing, 0, 0.3 * kSpacing}, {0.17, 0, 0.11}};
  int n = 0;
  for (const SelfCollisionMode mode : {SelfCollisionMode::particles, SelfCollisionMode::surface})
    for (const double thickness : {0.3, 0.8, 1.2, 2.0}) {
      if (mode == SelfCollisionMode::particles && thickness < 0.8) continue;
      for (const double speed : {0.25, 1.0, 5.0})
        for (const Vec3& offset : offsets) {
          // Each way by turns, springs with all.
          expect_laws({mode, kSprings, thickness, speed, offset});
          expect_laws({mode, kWays[1 + n % 5], thickness, speed, offset, n % 3 == 0 ? 0.3 : 0.0});
          ++n;
        }
    }
}

// The upper of two sheets on a plane that leans by so many degrees: how far it has slid [m].
double slid(double friction, double degrees, double seconds, Way way, double* creep = nullptr) {
  const double angle = degrees * std::numbers::pi / 180, thickness = 0.003;
  Scene scene;
  scene.gravity = {9.81 * std::sin(angle), -9.81 * std::cos(angle), 0};
  scene.time = {1.0 / 60, way.substeps, seconds};
  scene.solver.method = way.method;
  scene.solver.sweep = way.sweep;
  scene.solver.sleep = 0;
  scene.cloths.push_back(sheet({0, 0, 0}, SelfCollisionMode::surface, thickness, friction));
  for (int j = 0; j < kPoints; ++j)
    for (int i = 0; i < kPoints; ++i) scene.cloths[0].pins.push_back({i, j, {}});
  scene.cloths.push_back(
      sheet({0.13, 1.02 * thickness, 0.13}, SelfCollisionMode::surface, thickness, friction));
  Cloth& upper = scene.cloths[1];
  upper.grid = {9, 9, {0.04, 1.02 * thickness, 0.13}, {0.23, 0, 0}, {0, 0, 0.23}, 0};
  Simulation simulation(scene);
  const auto place = [&] {
    const std::vector<double> x = simulation.positions();
    double sum = 0;
    for (std::size_t n = 3 * kPoints * kPoints; n < x.size(); n += 3) sum += x[n];
    return sum / 81;
  };
  const double start = place();
  double early = start;
  while (simulation.time() < seconds - 1e-9) {
    simulation.advance_frame();
    if (simulation.time() < 0.1 + 1e-9) early = place();
  }
  if (creep) *creep = place() - early;
  return place() - start;
}

TEST(SelfCollisionLaws, ALayerSticksBelowItsAngle) {
  for (const Way& way : {kWays[0], kWays[2]})
    for (const auto& [friction, degrees] :
         {std::pair{0.6, 25.0}, std::pair{0.3, 12.0}, std::pair{0.3, 16.0}}) {
      double creep = 0;
      const double moved = slid(friction, degrees, 1, way, &creep);
      EXPECT_LE(std::abs(creep), 1e-4) << friction << ", " << degrees << " degrees";
      EXPECT_LE(std::abs(moved), 2e-4) << friction << ", " << degrees << " degrees";
    }
}

TEST(SelfCollisionLaws, ALayerSlidesAboveItsAngle) {
  for (const Way& way : {kWays[0], kWays[2]})
    for (const auto& [friction, degrees] :
         {std::pair{0.3, 20.0}, std::pair{0.3, 30.0}, std::pair{0.1, 10.0}, std::pair{0.0, 5.0}}) {
      const double seconds = 0.3, angle = degrees * std::numbers::pi / 180;
      const double expected =
          0.5 * 9.81 * (std::sin(angle) - friction * std::cos(angle)) * seconds * seconds;
      EXPECT_NEAR(slid(friction, degrees, seconds, way) / expected, 1, 0.03)
          << friction << ", " << degrees << " degrees";
    }
}

// Four sheets let fall on each other and on a plane.
TEST(SelfCollisionLaws, APileRestsAThicknessApart) {
  constexpr std::size_t kSheets = 4, n = kPoints * kPoints;
  const double thickness = 0.003;
  Scene scene;
  scene.time = {1.0 / 60, kAutoSubsteps, 4};
  scene.solver.sleep = 0;
  for (int k = 0; k < int(kSheets); ++k) {
    scene.cloths.push_back(sheet({0.003 * k, 0.003 * (2 * k + 1), 0.002 * k},
                                 SelfCollisionMode::surface, thickness, 0.3));
    scene.cloths.back().drag = 2;
  }
  scene.colliders.emplace_back();
  scene.colliders[0].shape = Plane{{0, 0, 0}, {0, 1, 0}};
  scene.colliders[0].friction = {FrictionModel::coulomb, 0.3, 0.3};
  scene.colliders[0].offset = thickness / 2;
  Simulation simulation(scene);
  advance(simulation, scene.time.seconds);
  const std::vector<double> x = simulation.positions(), v = simulation.velocities();
  double square = 0;
  for (const double c : v) square += c * c;
  EXPECT_LE(std::sqrt(square / double(kSheets * n)), 0.05) << "m/s";  // (the goal is 1e-3)
  std::array<double, kSheets> height{};
  for (std::size_t k = 0; k < kSheets; ++k)
    for (std::size_t p = 0; p < n; ++p) height[k] += x[3 * (k * n + p) + 1] / double(n);
  for (std::size_t k = 1; k < kSheets; ++k) {
    EXPECT_GE((height[k] - height[k - 1]) / thickness, 0.98) << "sheet " << k;
    EXPECT_LE((height[k] - height[k - 1]) / thickness, 1.05) << "sheet " << k;
  }
  EXPECT_EQ(simulation.report().penetration.crossings, 0);
}

// Where nothing touches, contact changes nothing: a hanging sheet that swings, and one that turns.
TEST(SelfCollisionLaws, WhereNothingTouchesNothingChanges) {
  for (const double spin : {0.0, 3.0}) {
    std::vector<std::uint64_t> hashes;
    for (const auto mode :
         {SelfCollisionMode::off, SelfCollisionMode::particles, SelfCollisionMode::surface})
      for (const double thickness : {0.003, 0.001, 0.0003}) {
        Scene scene;
        scene.time = {1.0 / 60, 60, 0.5};
        scene.cloths.push_back(sheet({0, 0, 0}, mode, thickness, 0.3));
        if (spin == 0) scene.cloths[0].pins = {{0, 0, {}}, {kPoints - 1, 0, {}}};
        Simulation simulation(scene);
        const std::vector<double> x = simulation.positions();
        std::vector<double> v(x.size(), 0.0);
        for (std::size_t p = 0; p < x.size(); p += 3) {
          v[p] = spin * (x[p + 2] - kSide / 2);
          v[p + 2] = -spin * (x[p] - kSide / 2);
        }
        simulation.set_state(x, v);
        advance(simulation, 0.5);
        hashes.push_back(simulation.hash());
      }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]) << spin;
  }
}

// The same bits for any number of threads and any instruction set.
TEST(SelfCollisionLaws, TheSameBitsOnAnyMachine) {
  for (const auto mode : {SelfCollisionMode::particles, SelfCollisionMode::surface}) {
    std::vector<std::uint64_t> hashes;
    for (const Options& options : machines()) {
      Simulation simulation(meeting_scene({mode, kSprings, 1, 1, {0.02, 0, 0.03}, 0.3}), options);
      std::vector<double> x = simulation.positions(), v(x.size(), 0.0);
      for (std::size_t n = 1; n < v.size(); n += 3) v[n] = n < v.size() / 2 ? 1 : -1;
      simulation.set_state(x, v);
      advance(simulation, 0.2);
      hashes.push_back(simulation.hash());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
  }
}

}  // namespace
}  // namespace weft
