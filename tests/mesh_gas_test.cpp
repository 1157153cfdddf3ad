// The gas in a closed mesh by itself: its law, the gradient of the volume, and what cannot hold one.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "made_up_balloon.h"
#include "physics/model/mesh/gas.h"
#include "physics/model/mesh/mesh_order.h"
#include "weft/simulation.h"
#include "weft/vec3.h"

namespace weft {
namespace {

constexpr double kRadius = 0.2;  // m

TEST(MeshGas, LawsAreSlopesOfTheirEnergies) {
  for (const Pressure& pressure :
       {Pressure{.over = 300}, Pressure{.over = -50}, Pressure{.inflate = 1.3},
        Pressure{.inflate = 0.5, .ambient = 700}}) {
    const physics::GasLaw law(pressure, 0.03);
    for (const double share : {1.0, 0.4, 2.0})
      for (const double volume : {0.0001, 0.004, 0.02, 0.03, 0.09}) {
        const double h = 1e-6 * volume;
        const double slope =
            (law.energy(share, volume + h) - law.energy(share, volume - h)) / (2 * h);
        const double scale = 1e-6 * (std::abs(law.over(share, volume)) + pressure.ambient);
        EXPECT_NEAR(law.over(share, volume), -slope, scale) << share << " " << volume;
        const double stiffness =
            (law.over(share, volume - h) - law.over(share, volume + h)) / (2 * h);
        EXPECT_NEAR(law.stiffness(share, volume), stiffness, 1e-5 * stiffness + 1e-3);
        for (const double growth : {0.0, 1e-9, 1e-6}) {
          const double p = law.over_after(share, volume, growth);
          if (volume + growth * p > 0.002) {
            EXPECT_NEAR(p, law.over(share, volume + growth * p), scale);
          }
        }
      }
  }
  const physics::GasLaw keyed(Pressure{.over = 10, .keys = {{1, 0}, {3, 2}}}, 1);
  EXPECT_EQ(keyed.share(0), 0);
  EXPECT_EQ(keyed.share(2), 1);
  EXPECT_EQ(keyed.share(9), 2);
  EXPECT_EQ(keyed.greatest_share(), 2);
}

// The gradient by differences; and what it adds up to, in any place and turned over.
TEST(MeshGas, GradientsAreThoseOfTheVolume) {
  std::mt19937 random(3);
  const auto draw = [&] { return 2 * (double(random()) / 4294967296.0) - 1; };
  for (const bool inwards : {false, true})
    for (const bool cushion : {false, true}) {
      Cloth cloth;
      auto mesh = cushion ? made_up_cushion(4, 0.1) : made_up_balloon(2, kRadius);
      if (inwards)
        for (auto& t : mesh->triangles) std::swap(t[1], t[2]);
      for (Vec3& p : mesh->vertices)
        for (double& value : p) value += 0.02 * draw();
      cloth.mesh.shape = mesh;
      cloth.mesh.translate = {50, 0, -20};
      cloth.sewing = true;
      cloth.pressure.over = 1;
      const physics::MeshOrder order = physics::order_of(*mesh, sewn_vertices(cloth));
      const physics::Particles particles(order.counts, false, order.vertices);
      const physics::Gas gas(cloth, particles);
      physics::Gas::Work work = gas.work();
      std::vector<Vec3> x = placed_vertices(cloth.mesh), gradient(x.size());
      const double volume = gas.look(x, work);
      EXPECT_GT(volume, 0);
      EXPECT_NEAR(volume, std::abs(enclosed_volume(cloth)), 1e-12);
      Vec3 sum{}, moment{};
      for (int p = 0; p < gas.points(); ++p)
        for (const auto& member : gas.members(p)) {
          const auto n = std::size_t(member.number);
          gradient[n] = work.gradients[std::size_t(p)];
          sum = plus(sum, gradient[n]);
          moment = plus(moment, cross(x[n], gradient[n]));
        }
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(sum[k], 0, 1e-14);
        EXPECT_NEAR(moment[k], 0, 1e-12);
      }
      for (std::size_t n = 0; n < x.size(); n += 7)
        for (std::size_t k = 0; k < 3; ++k) {
          const double at = x[n][k], h = 1e-5;
          x[n][k] = at + h;
          const double above = gas.look(x, work);
          x[n][k] = at - h;
          const double below = gas.look(x, work);
          x[n][k] = at;
          EXPECT_NEAR(gradient[n][k], (above - below) / (2 * h), 1e-9);
        }
    }
}

TEST(MeshGas, WhatIsNotClosedIsRefused) {
  Scene scene;
  scene.cloths.emplace_back().mesh.shape = made_up_balloon(1, kRadius);
  scene.cloths[0].pressure.over = 10;
  EXPECT_TRUE(validate(scene).empty());
  const auto told = [](const Scene& s) {
    const auto faults = validate(s);
    return faults.empty() ? "" : faults[0].place + ": " + faults[0].what;
  };
  auto open = std::make_shared<TriangleMesh>(*scene.cloths[0].mesh.shape);
  open->triangles.erase(open->triangles.begin());
  Scene other = scene;
  other.cloths[0].mesh.shape = open;
  EXPECT_EQ(told(other).substr(0, 55), "/cloths/0/pressure: the mesh is open at the edge of ver");
  auto turned = std::make_shared<TriangleMesh>(*scene.cloths[0].mesh.shape);
  std::swap(turned->triangles[3][0], turned->triangles[3][1]);
  other.cloths[0].mesh.shape = turned;
  EXPECT_EQ(told(other).substr(0, 37), "/cloths/0/pressure: the mesh is open ");
  other = scene;
  other.cloths[0].pressure.inflate = 1;
  EXPECT_EQ(told(other), "/cloths/0/pressure: both over and inflate are given");
  other = Scene{};
  other.cloths.emplace_back().pressure.over = 10;
  EXPECT_EQ(told(other), "/cloths/0/pressure: a grid encloses nothing");
  other = scene;
  other.cloths[0].mesh.shape = made_up_cushion(3, 0.1);
  EXPECT_EQ(told(other).substr(0, 37), "/cloths/0/pressure: the mesh is open ");
  other.cloths[0].sewing = true;
  EXPECT_EQ(told(other), "");
  other.cloths[0].mesh.shape = made_up_cushion(3, 1e-14);
  other.cloths[0].pressure = {.inflate = 1};
  EXPECT_EQ(told(other), "/cloths/0/pressure/inflate: the mesh encloses no volume as it starts");
  other = scene;
  other.cloths[0].pressure.keys = {{1, 1}, {1, 2}};
  EXPECT_EQ(told(other), "/cloths/0/pressure/keys/1: time 1 comes after 1");
}

}  // namespace
}  // namespace weft
