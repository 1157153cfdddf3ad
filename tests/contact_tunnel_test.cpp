// Nothing slips through: particles through thin colliders, small colliders through the mesh.
#include "contact_scenes.h"
#include "physics/contact/colliders/shapes.h"

namespace weft {
namespace {

TEST(ContactTunnel, FastParticlesStopAtThinColliders) {
  const std::vector<Shape> thin = {Box{{0, 0, 0}, {0.5, 0.001, 0.5}, {0, 0, 0}, 0},
                                   Box{{0, 0, 0}, {0.5, 0.01, 0.5}, {0, 0, 10}, 0.005},
                                   Sphere{{0, 0, 0}, 0.02},
                                   Capsule{{-0.5, 0, 0}, {0.5, 0, 0}, 0.012}};
  for (const Shape& shape : thin)
    for (const double speed : {3.0, 30.0, 300.0}) {
      Scene scene;
      scene.gravity = {0, 0, 0};
      scene.time.substeps = 4;
      scene.cloths.push_back(loose_particles({0, 0.37, 0}));
      scene.cloths[0].grid.origin = {-0.005, 0.37, -0.005};
      scene.cloths[0].grid.u = {0.01, 0, 0};
      scene.cloths[0].grid.v = {0, 0, 0.01};
      scene.colliders.push_back(collider_of(shape, 1));
      Simulation simulation(scene);
      std::vector<double> x = simulation.positions(), v(x.size());
      for (std::size_t p = 0; p < v.size() / 3; ++p) v[3 * p + 1] = -speed;
      simulation.set_state(x, v);
      advance(simulation, 0.5);
      for (std::size_t p = 0; p < v.size() / 3; ++p)
        EXPECT_GT(at(simulation.positions(), p)[1], 0)
            << shape.index() << " at " << speed << " m/s";
    }
}

TEST(ContactTunnel, FastColliderSweepsParticlesAlong) {
  Scene scene;
  scene.gravity = {0, 0, 0};
  scene.time.substeps = 2;
  scene.cloths.push_back(loose_particles({0, 0, 0}));
  scene.colliders.push_back(collider_of(Box{{0, 1, 0}, {0.5, 0.002, 0.5}, {}, 0}));
  scene.colliders[0].keys = {{0, {0, 1, 0}}, {0.1, {0, -1, 0}}};
  Simulation simulation(scene);
  advance(simulation, 0.1);
  for (std::size_t p = 0; p < 4; ++p) EXPECT_LT(at(simulation.positions(), p)[1], -1);
}

// Coarse sheet held by its border; how deep the collider's lowest point lies below every triangle.
struct Held {
  Scene scene;
  Held(const Shape& shape, std::vector<Key> keys) {
    scene.gravity = {0, 0, 0};
    scene.time.substeps = 20;
    scene.cloths.push_back(flat_sheet(7, 0.6, {0, 0, 0}));
    scene.cloths[0].drag = 2;
    for (int n = 0; n < 7; ++n)
      for (const auto& [i, j] : {std::pair{n, 0}, {n, 6}})
        scene.cloths[0].pins.push_back({i, j, {}});
    scene.colliders.push_back(collider_of(shape, 0.2));
    scene.colliders[0].keys = std::move(keys);
  }
};

// The sheet's least height under the collider's axis, by its triangles.
double height_below(const Simulation& simulation, double x, double z) {
  const ClothView c = simulation.view().cloths[0];
  const auto vertex = [&](int i, int j) {
    const std::size_t p = std::size_t(j) * std::size_t(c.stride) + std::size_t(i);
    return Vec3{c.x[p], c.y[p], c.z[p]};
  };
  double least = 1e9;
  for (int j = 0; j + 1 < c.rows; ++j)
    for (int i = 0; i + 1 < c.columns; ++i)
      for (const auto& t : {std::array{vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)},
                            std::array{vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)}}) {
        const auto area = [&](const Vec3& a, const Vec3& b, double px, double pz) {
          return (b[0] - a[0]) * (pz - a[2]) - (b[2] - a[2]) * (px - a[0]);
        };
        const double whole = area(t[0], t[1], t[2][0], t[2][2]);
        const double a = area(t[1], t[2], x, z) / whole, b = area(t[2], t[0], x, z) / whole;
        if (a < 0 || b < 0 || a + b > 1) continue;
        least = std::min(least, a * t[0][1] + b * t[1][1] + (1 - a - b) * t[2][1]);
      }
  return least;
}

TEST(ContactTunnel, SmallCollidersDoNotSlipBetweenParticles) {
  const std::vector<Shape> small = {Sphere{{0.04, 0.2, 0.03}, 0.02},
                                    Capsule{{0.04, 0.2, 0.03}, {0.04, 0.4, 0.03}, 0.01},
                                    Box{{0.04, 0.2, 0.03}, {0.02, 0.02, 0.02}, {30, 0, 40}, 0.002},
                                    Box{{0.04, 0.2, 0.03}, {0.02, 0.02, 0.02}, {45, 35.26, 0}, 0}};
  for (const Shape& shape : small)
    for (const double speed : {0.2, 2.0, 20.0}) {
      const double seconds = 0.35 / speed;
      Held held(shape, {{0, {0.04, 0.2, 0.03}}, {seconds, {0.04, -0.15, 0.03}}});
      Simulation simulation(held.scene);
      advance(simulation, std::max(seconds, 0.1));
      // The sheet hangs below the collider's center, everywhere around it.
      EXPECT_LT(height_below(simulation, 0.04, 0.03), -0.15)
          << "shape " << shape.index() << " at " << speed << " m/s";
    }
}

// The nearer a body comes to a held corner, the longer the lever of the triangle's other corners.
TEST(ContactTunnel, BodiesThatPassAHeldCornerFlingNothing) {
  for (const double miss : {0.0, 0.001, 0.01})
    for (const int substeps : {1, 4, 16}) {
      Scene scene;
      scene.gravity = {0, 0, 0};
      scene.time.substeps = substeps;
      scene.solver.method = Method::compliant;
      scene.cloths.push_back(flat_sheet(5, 0.4, {0.2, 0, 0.2}));
      scene.cloths[0].stiffness = {3, 1, 0.2};
      scene.cloths[0].pins = {{0, 0, {}}};
      scene.colliders.push_back(
          collider_of(Box{{miss, 0.1, miss}, {0.01, 0.01, 0.01}, {20, 30, 0}, 0}, 0.5));
      scene.colliders[0].keys = {{0, {miss, 0.1, miss}}, {0.1, {miss, -0.3, miss}}};
      Simulation simulation(scene);
      for (int frame = 0; frame < 12; ++frame) {
        simulation.advance_frame();
        for (const double x : simulation.positions())
          ASSERT_LT(std::abs(x), 1) << miss << " m, " << substeps << " substeps, frame " << frame;
        for (const double v : simulation.velocities())
          ASSERT_LT(std::abs(v), 40) << miss << " m, " << substeps << " substeps, frame " << frame;
      }
    }
}

TEST(ContactTunnel, LargeCollidersNeedNoTriangles) {
  Held held(Sphere{{0, 0.5, 0}, 0.4}, {});
  const Simulation simulation(held.scene);
  for (const PlannedStage& s : simulation.plan().stages) EXPECT_NE(s.name, "collider_faces");
}

}  // namespace
}  // namespace weft
