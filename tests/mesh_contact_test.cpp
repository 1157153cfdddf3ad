// Meshes that meet themselves, each other and grids: the laws of contact between sheets, on irregular
// triangles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "cases.h"
#include "machines.h"
#include "mesh_scenes.h"
#include "sheets.h"

namespace weft {
namespace {

constexpr double kSide = 0.5;
constexpr int kPoints = 13;
constexpr double kSpacing = kSide / (kPoints - 1);

SelfCollision meeting(SelfCollisionMode mode, double thickness, double friction) {
  SelfCollision self;
  self.mode = mode;
  self.thickness = thickness;
  self.friction = friction;
  return self;
}

// Irregular triangles; another mesh for every seed.
Cloth mesh_sheet(const Vec3& origin, const SelfCollision& self, unsigned seed, int points = kPoints,
                 double side = kSide) {
  Cloth cloth;
  cloth.mesh.shape = made_up({.nx = points,
                              .ny = points,
                              .width = side,
                              .height = side,
                              .shift = 0.25,
                              .shuffled = true,
                              .seed = seed});
  cloth.mesh.translate = origin;
  cloth.density = 0.3;
  cloth.stiffness.structural = 1000;
  cloth.self_collision = self;
  return cloth;
}

Cloth grid_sheet(const Vec3& origin, const SelfCollision& self) {
  Cloth cloth;
  cloth.grid = {kPoints, kPoints, origin, {kSide, 0, 0}, {0, 0, kSide}, 0};
  cloth.density = 0.3;
  cloth.stiffness = {1000, 1000, 200};
  cloth.self_collision = self;
  return cloth;
}

struct Way {
  const char* name;
  Method method;
  Sweep sweep;
  int order, substeps;  // 0: automatic
  bool membrane = false;
};
constexpr Way kWays[] = {
    {"springs", Method::spring, Sweep::gauss_seidel, 1, 0},
    {"damped membrane", Method::spring_friction, Sweep::gauss_seidel, 1, 0, true},
    {"sweeps", Method::compliant, Sweep::gauss_seidel, 1, 40},
    {"sweeps of the second order", Method::compliant, Sweep::gauss_seidel, 2, 40},
    {"strands", Method::compliant, Sweep::line, 1, 40}};

struct Meeting {
  SelfCollisionMode mode;
  const Way& way;
  double thickness, speed;  // spacings, m/s of one sheet to the other
  double friction;
  bool with_grid;  // the upper one
};

std::string name(const Meeting& m) {
  char text[160];
  std::snprintf(text, sizeof text, "mode %d, %s, %.2g spacings, %.3g m/s, friction %.2g%s",
                int(m.mode), m.way.name, m.thickness, m.speed, m.friction,
                m.with_grid ? ", with a grid" : "");
  return text;
}

void set_way(Scene& scene, const Way& way) {
  scene.solver.method = way.method;
  scene.solver.sweep = way.sweep;
  scene.solver.order = way.order;
  scene.solver.iterations = 4;
  scene.solver.sleep = 0;
  scene.time = {1.0 / 60, way.substeps, 0.5};
  for (Cloth& cloth : scene.cloths)
    if (way.membrane && cloth.mesh.given()) cloth.membrane = {900, 800, 60, 100, 1e-4};
}

Scene meeting_scene(const Meeting& m, unsigned seed) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  const double thickness = m.thickness * kSpacing, gap = 1.5 * thickness;
  const SelfCollision self = meeting(m.mode, thickness, m.friction);
  scene.cloths.push_back(mesh_sheet({0, 0, 0}, self, seed));
  const Vec3 above{0.07, gap, 0.11};
  scene.cloths.push_back(m.with_grid ? grid_sheet(above, self) : mesh_sheet(above, self, seed + 1));
  scene.cloths[0].velocity = {0.05 * m.speed, m.speed / 2, 0};
  scene.cloths[1].velocity = {-0.05 * m.speed, -m.speed / 2, 0};
  set_way(scene, m.way);
  return scene;
}

void expect_laws(const Meeting& m, unsigned seed) {
  Simulation simulation(meeting_scene(m, seed));
  const Report start = simulation.report();
  const double seconds = std::clamp(3 * m.thickness * kSpacing / m.speed, 0.1, 0.4);
  double most = start.energy.total;
  Report r = start;
  while (simulation.time() < seconds) {
    simulation.advance_frame();
    r = simulation.report();
    most = std::max(most, r.energy.total);
  }
  double linear = 0, angular = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    linear = std::max(linear, std::abs(r.momentum[k] - start.momentum[k]));
    angular = std::max(angular, std::abs(r.angular_momentum[k] - start.angular_momentum[k]));
  }
  const double sum = 2 * 0.3 * kSide * kSide * m.speed / 2;  // Σ m |v|
  EXPECT_GT(r.contact.energy_taken, 0) << name(m) << ": do not meet";
  EXPECT_LE(most / start.energy.total - 1, 1e-3) << name(m);
  EXPECT_LE(linear / sum, 1e-6) << name(m);
  if (m.friction == 0) {
    EXPECT_LE(angular / (sum * kSide), 1e-3) << name(m);
  }
  EXPECT_EQ(r.penetration.crossings, 0) << name(m);
}

TEST(MeshContact, SheetsThatMeetKeepMomentumAndGainNoEnergy) {
  unsigned n = 0;
  Cases cases(3);
  for (const auto mode : {SelfCollisionMode::particles, SelfCollisionMode::surface})
    for (const double thickness : {0.3, 1.2, 2.0}) {
      if (mode == SelfCollisionMode::particles && thickness < 0.8) continue;
      for (const double speed : {0.25, 5.0})
        for (const bool with_grid : {false, true}) {
          if (!cases.next()) continue;
          expect_laws({mode, kWays[0], thickness, speed, 0, with_grid}, n);
          const double friction = n % 3 == 0 ? 0.3 : 0;
          expect_laws({mode, kWays[1 + n % 4], thickness, speed, friction, with_grid && n % 4 != 0},
                      ++n);
        }
    }
}

// A mesh on one that is held, which leans by so many degrees: how far it slides in a second, the first tenth
// left out [m].
double creep(double friction, double degrees, const Way& way) {
  const double angle = degrees * std::numbers::pi / 180, thickness = 0.003;
  Scene scene;
  scene.gravity = {9.81 * std::sin(angle), -9.81 * std::cos(angle), 0};
  const SelfCollision self = meeting(SelfCollisionMode::surface, thickness, friction);
  scene.cloths.push_back(mesh_sheet({0, 0, 0}, self, 3));
  for (int v = 0; v < kPoints * kPoints; ++v) scene.cloths[0].pins.push_back({v, 0, {}});
  scene.cloths.push_back(mesh_sheet({0.06, 1.02 * thickness, 0.13}, self, 4, 7, 0.23));
  set_way(scene, way);
  Simulation simulation(scene);
  const auto place = [&] {
    const std::vector<Vec3> x = positions_of(simulation);
    double sum = 0;
    for (std::size_t n = kPoints * kPoints; n < x.size(); ++n) sum += x[n][0];
    return sum / 49;
  };
  advance(simulation, 0.1);
  const double early = place();
  advance(simulation, 0.9);
  return place() - early;
}

TEST(MeshContact, ALayerSticksBelowItsAngle) {
  for (const Way& way : {kWays[0], kWays[2]}) {
    EXPECT_LE(std::abs(creep(0.6, 25, way)), 1e-4) << way.name;
    EXPECT_LE(std::abs(creep(0.3, 14, way)), 1e-4) << way.name;
    EXPECT_GT(creep(0.3, 25, way), 0.1) << way.name;
  }
}

double mean_height(const Simulation& simulation, std::size_t first, std::size_t count) {
  const std::vector<Vec3> x = positions_of(simulation);
  double sum = 0;
  for (std::size_t n = first; n < first + count; ++n) sum += x[n][1];
  return sum / double(count);
}

TEST(MeshContact, APileRestsAThicknessApart) {
  constexpr std::size_t kSheets = 3, n = kPoints * kPoints;
  const double thickness = 0.003;
  Scene scene;
  scene.time = {1.0 / 60, kAutoSubsteps, 2};
  scene.solver.sleep = 0;
  for (unsigned k = 0; k < kSheets; ++k) {
    scene.cloths.push_back(mesh_sheet({0.003 * k, 0.003 * (2 * k + 1), 0.002 * k},
                                      meeting(SelfCollisionMode::surface, thickness, 0.3), k));
    scene.cloths.back().drag = 2;
  }
  scene.colliders.emplace_back();
  scene.colliders[0].shape = Plane{{0, 0, 0}, {0, 1, 0}};
  scene.colliders[0].friction = {FrictionModel::coulomb, 0.3, 0.3};
  scene.colliders[0].offset = thickness / 2;
  Simulation simulation(scene);
  advance(simulation, scene.time.seconds);
  for (std::size_t k = 1; k < kSheets; ++k) {
    const double gap = mean_height(simulation, k * n, n) - mean_height(simulation, (k - 1) * n, n);
    EXPECT_GE(gap / thickness, 0.99) << "sheet " << k;
    EXPECT_LE(gap / thickness, 1.05) << "sheet " << k;
  }
  EXPECT_EQ(simulation.report().penetration.crossings, 0);
}

// A sheet that leans by so many degrees to the floor falls on it in folds.
Scene folding(bool mesh, double degrees, double thickness, const Way& way, unsigned seed) {
  constexpr int kFoldPoints = 17;
  Scene scene;
  const SelfCollision self = meeting(SelfCollisionMode::surface, thickness, 0.3);
  scene.cloths.push_back(mesh ? mesh_sheet({0, 0.02, 0}, self, seed, kFoldPoints)
                              : grid_sheet({0, 0, 0}, self));
  Cloth& cloth = scene.cloths[0];
  if (mesh) {
    cloth.mesh.rotate = {-degrees, 0, 0};
    cloth.stiffness.structural = 400;
  } else {
    const double angle = degrees * std::numbers::pi / 180;
    cloth.grid = {kFoldPoints,
                  kFoldPoints,
                  {0, 0.02, 0},
                  {kSide, 0, 0},
                  {0, kSide * std::sin(angle), kSide * std::cos(angle)},
                  0};
    cloth.stiffness = {400, 200, 0};
  }
  cloth.bending = 1e-4;
  cloth.drag = 1;
  scene.colliders.emplace_back();
  scene.colliders[0].shape = Plane{{0, 0, 0}, {0, 1, 0}};
  scene.colliders[0].friction = {FrictionModel::coulomb, 0.6, 0.6};
  set_way(scene, way);
  return scene;
}

TEST(MeshContact, FoldsOverItselfAndDoesNotCross) {
  unsigned seed = 20;
  for (const auto& [way, thickness] :
       {std::pair(&kWays[0], 0.004), {&kWays[2], 0.015}, {&kWays[4], 0.004}}) {
    Simulation simulation(folding(true, 84, thickness, *way, seed++));
    const double start = simulation.report().energy.total;
    for (int frame = 0; frame < 60; ++frame) {
      simulation.advance_frame();
      if (frame % 3 != 0) continue;
      const Report r = simulation.report();
      ASSERT_EQ(r.penetration.crossings, 0) << way->name << ", frame " << frame;
      ASSERT_LE(r.energy.total, start + 1e-3 * std::abs(start)) << way->name << ", frame " << frame;
    }
    EXPECT_GT(simulation.report().contact.contacts, 0) << way->name;
  }
}

TEST(MeshContact, WhereNothingTouchesNothingChanges) {
  std::vector<std::uint64_t> hashes;
  for (const auto mode :
       {SelfCollisionMode::off, SelfCollisionMode::particles, SelfCollisionMode::surface})
    for (const double thickness : {0.003, 0.02}) {
      Scene scene;
      scene.time = {1.0 / 60, 60, 0.5};
      scene.cloths.push_back(mesh_sheet({0, 0, 0}, meeting(mode, thickness, 0.3), 8));
      scene.cloths[0].spin = {0, 3, 1};
      Simulation simulation(scene);
      advance(simulation, 0.5);
      hashes.push_back(simulation.hash());
    }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

TEST(MeshContact, TheSameBitsOnAnyMachine) {
  for (const auto mode : {SelfCollisionMode::particles, SelfCollisionMode::surface})
    for (const Way& way : {kWays[0], kWays[3]}) {
      std::vector<std::uint64_t> hashes;
      for (const Options& options : machines()) {
        Simulation simulation(meeting_scene({mode, way, 1, 1, 0.3, true}, 9), options);
        advance(simulation, 0.2);
        hashes.push_back(simulation.hash());
      }
      for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]) << way.name;
    }
}

}  // namespace
}  // namespace weft
