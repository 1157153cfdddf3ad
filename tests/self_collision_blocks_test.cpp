// Sheets are cut into blocks for contact; what comes down between two of them is not missed.
#include <gtest/gtest.h>

#include <memory>

#include "made_up_bodies.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr double kSpacing = 0.02;  // m

Cloth thin_sheet(int nx, int ny, const Vec3& origin, const Vec3& u, const Vec3& v) {
  Cloth c;
  c.grid = {nx, ny, origin, u, v, 0};
  c.stiffness = {500, 250, 0};
  c.self_collision.mode = SelfCollisionMode::surface;
  c.self_collision.thickness = 5e-4;
  return c;
}

// The same as a mesh, held where the grid is.
Cloth as_mesh_cloth(Cloth c) {
  std::vector<double> x;
  for (int j = 0; j < c.grid.ny; ++j)
    for (int i = 0; i < c.grid.nx; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        x.push_back(c.grid.origin[k] + c.grid.u[k] * i / (c.grid.nx - 1) +
                    c.grid.v[k] * j / (c.grid.ny - 1));
  c.mesh.shape = std::make_shared<TriangleMesh>(tests::as_mesh(x, c.grid.nx, c.grid.ny));
  for (Pin& pin : c.pins) pin.vertices = {pin.j * c.grid.nx + pin.i};
  c.grid = {};
  c.stiffness = Cloth{}.stiffness;
  c.stiffness.structural = 500;
  return c;
}

// A narrow strip, its lower edge along the rows or columns of a sheet that is held at its sides, falls on it
// everywhere from one particle to beyond the next block's first.
TEST(SelfCollisionBlocks, WhatFallsBetweenTwoIsSeen) {
  constexpr int kPoints = 40, kStrip = 5;
  for (const bool mesh : {false, true})
    for (const bool across : {false, true})
      for (double at = 13.5; at < 17; at += 0.5) {
        const auto turned = [&](double along, double height, double side) {
          return across ? Vec3{side, height, along} : Vec3{along, height, side};
        };
        Scene scene;
        scene.time.seconds = 0.05;
        const double side = kSpacing * (kPoints - 1);
        scene.cloths = {thin_sheet(kPoints, kPoints, {0, 0, 0}, {side, 0, 0}, {0, 0, side}),
                        thin_sheet(kStrip, kStrip, turned(kSpacing * at, 0.006, 0.3),
                                   turned(0, 0, 0.08), turned(0, 0.08, 0))};
        for (int k = 0; k + 1 < kPoints; ++k)
          for (const auto& [i, j] : {std::pair(k, 0), std::pair(kPoints - 1, k),
                                     std::pair(k + 1, kPoints - 1), std::pair(0, k + 1)})
            scene.cloths[0].pins.push_back({i, j, {}});
        scene.cloths[1].velocity = {0, -1, 0};
        if (mesh)
          for (Cloth& c : scene.cloths) c = as_mesh_cloth(c);
        Simulation simulation(scene);
        std::int64_t contacts = 0;
        for (int frame = 0; frame < 3; ++frame) {
          simulation.advance_frame();
          const Report r = simulation.report();
          contacts += r.contact.contacts;
          ASSERT_EQ(r.penetration.crossings, 0) << mesh << across << ' ' << at;
        }
        EXPECT_GT(contacts, 0) << mesh << across << ' ' << at;
        // It has come down by 5 cm, had nothing been there.
        const std::vector<double> x = simulation.positions();
        EXPECT_GT(x[3 * kPoints * kPoints + 1], -0.03) << mesh << across << ' ' << at;
      }
}

}  // namespace
}  // namespace weft
