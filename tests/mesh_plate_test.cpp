// Meshes that bend, as plates do whatever their triangles are: strips and plates against closed forms.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "mesh_scenes.h"
#include "physics/model/mesh/rest_triangles.h"
#include "truth.h"

namespace weft {
namespace {

struct Mesh {
  const char* name;
  Diagonals diagonals;
  double shift;
};
constexpr Mesh kMeshes[] = {
    {"diagonals alike", Diagonals::alike, 0},
    {"diagonals crossed", Diagonals::crossed, 0},
    {"crossed, vertices off the grid by up to 0.2 spacings", Diagonals::crossed, 0.2},
    {"diagonals at random", Diagonals::random, 0},
    {"at random, vertices off the grid by up to 0.1 spacings", Diagonals::random, 0.1},
    {"at random, vertices off the grid by up to 0.3 spacings", Diagonals::random, 0.3}};

// As cotton's: weft bends more easily than warp.
Bending woven_bending() {
  Bending woven = 0.02;
  woven.weft = 0.01, woven.twist = 0.014;
  return woven;
}

// A strip clamped at one end bends by q L⁴/8D. The clamp is two rows of vertices; it ends half way from the
// second to where slopes are free.
double tip_of_beam(const MadeUpMesh& like, const Bending& bending) {
  const auto mesh = made_up(like);
  Scene scene = scene_of(mesh);
  Cloth& cloth = scene.cloths[0];
  const double spacing = like.width / (like.nx - 1);
  cloth.membrane = {300, 300, 0, 150, 0};
  cloth.bending = bending;
  cloth.drag = 7.6;             // twice the slowest mode
  const double gravity = 0.08;  // a small bend
  scene.gravity = {0, -gravity, 0};
  for (std::size_t n = 0; n < mesh->vertices.size(); ++n)
    if (mesh->vertices[n][0] < 1.01 * spacing) cloth.pins.push_back({int(n), 0, {}});
  Simulation run(scene, {.threads = 1});
  for (int n = 0; n < 250; ++n) run.advance_frame();
  EXPECT_TRUE(run.status().ok) << run.status().text;
  double tip = 0;
  const auto x = positions_of(run);
  for (std::size_t n = 0; n < x.size(); ++n)
    if (mesh->vertices[n][0] > like.width - 1e-9) tip -= x[n][1] / like.ny;
  const double length = like.width - spacing / 2;
  return tip / (0.3 * gravity * std::pow(length, 4) / (8 * bending.warp));
}

TEST(MeshPlate, BendsAsABeamDoes) {
  constexpr const char* kLaw = "cantilever of a mesh, drop of the tip";
  const Bending woven = woven_bending();
  for (const Mesh& mesh : kMeshes)
    for (const bool is_woven : {false, true}) {
      const MadeUpMesh strip{.nx = 21,
                             .ny = 7,
                             .width = 0.5,
                             .height = 0.15,
                             .shift = mesh.shift,
                             .diagonals = mesh.diagonals};
      const std::string what = std::string(mesh.name) + (is_woven ? ", woven" : "");
      expect({kLaw, what, 1, mesh.diagonals == Diagonals::alike ? 0.01 : 0.02, "q L⁴/(8 D)"},
             tip_of_beam(strip, is_woven ? woven : 0.02));
    }
}

// Bent by its own weight as far as it will, Γ = weight L³/D: drop over reach of the end, from the elastica of a strip
// that does not stretch, by shooting.
TEST(MeshPlate, HangsAsTheElasticaDoes) {
  constexpr double kLength = 0.5, kRigidity = 1e-3, kDensity = 0.3;
  for (const auto& [load, truth] : {std::pair{0.1, 0.0125},
                                    {1.0, 0.1246},
                                    {10.0, 1.067},
                                    {50.0, 3.71},
                                    {100.0, 5.89},
                                    {500.0, 14.8},
                                    {1000.0, 21.3}}) {
    const int nx = load > 500   ? 91
                   : load > 100 ? 61
                                : 31;          // it bends within L/Γ^(1/3) of the clamp
    const double edge = kLength / (nx - 1.5);  // half of one is clamped as well
    const auto mesh = made_up({.nx = nx,
                               .ny = 5,
                               .width = edge * (nx - 1),
                               .height = edge * 4,
                               .shift = 0.3,
                               .diagonals = Diagonals::random});
    Scene scene = scene_of(mesh);
    const double gravity = load * kRigidity / (kDensity * std::pow(kLength, 3));
    const double slowest = std::max(0.81, std::sqrt(gravity / kLength));  // 1/s
    scene.gravity = {0, -gravity, 0};
    Cloth& cloth = scene.cloths[0];
    cloth.density = kDensity;
    cloth.membrane = {2000, 2000, 0, 1000, 0};
    cloth.bending = kRigidity;
    cloth.drag = 2 * slowest;
    for (std::size_t n = 0; n < mesh->vertices.size(); ++n)
      if (mesh->vertices[n][0] < 1.01 * edge) cloth.pins.push_back({int(n), 0, {}});
    Simulation run(scene, {.threads = 1});
    for (int n = 0; n < 840 / slowest; ++n) run.advance_frame();
    EXPECT_TRUE(run.status().ok) << run.status().text;
    double drop = 0, reach = 0;
    const auto x = positions_of(run);
    for (std::size_t n = 0; n < x.size(); ++n)
      if (mesh->vertices[n][0] > edge * (nx - 1) - 1e-9)
        drop -= x[n][1] / 5, reach += (x[n][0] - edge / 2) / 5;
    char what[64];
    std::snprintf(what, sizeof what, "Γ = %g", load);
    expect({"cantilever of a wild mesh, drop over reach of the end", what, truth, 0.02, ""},
           drop / reach);
  }
}

// A square plate whose corners are lifted and lowered by d/4 each is twisted alike everywhere, by d/a², and holds
// D d²/a². The rest is what its sheet, which is soft, is stretched by.
TEST(MeshPlate, IsTwistedAsAPlateIs) {
  constexpr double kSide = 0.5, kLift = 0.004;
  constexpr int kCount = 13;
  for (const Mesh& of : kMeshes)
    for (const bool is_woven : {false, true}) {
      const auto mesh = made_up({.nx = kCount,
                                 .ny = kCount,
                                 .width = kSide,
                                 .height = kSide,
                                 .shift = of.shift,
                                 .diagonals = of.diagonals});
      Scene scene = scene_of(mesh);
      Cloth& cloth = scene.cloths[0];
      cloth.membrane = {100, 100, 0, 50, 0};
      cloth.bending = is_woven ? woven_bending() : Bending(0.02);
      cloth.drag = 6;
      scene.gravity = {};
      for (const double x : {0.0, kSide})
        for (const double z : {0.0, kSide}) {
          const double lift = (x == z ? 1 : -1) * kLift / 4;
          Pin pin{nearest_vertex(*mesh, {x, 0, z}), 0, {}};
          pin.keys = {{0, {x, 0, z}}, {0.5, {x, lift, z}}};
          cloth.pins.push_back(pin);
        }
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 300; ++n) run.advance_frame();
      EXPECT_TRUE(run.status().ok) << run.status().text;
      const double energy = cloth.bending.twist * std::pow(kLift / kSide, 2);
      const std::string what = std::string(of.name) + (is_woven ? ", woven" : "");
      const Truth truth{"plate of a mesh, twisted by its corners", what, 1, 0.02, "D d²/a²"};
      EXPECT_LT(show(truth, run.report().energy.elastic / energy),
                of.diagonals == Diagonals::crossed ? 0.15 : 0.02)
          << what;
    }
}

// What holds a moment about no free edge: the triangles that have no side along one, if curved across it.
double held_area(const std::vector<physics::RestTriangle>& triangles, const std::vector<Vec3>& x,
                 std::size_t across) {
  double area = 0;
  for (const physics::RestTriangle& r : triangles) {
    bool free = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto a = std::size_t(r.corner[k]), b = std::size_t(r.corner[(k + 1) % 3]);
      free = free || (r.corner[3 + k] < 0 && std::abs(x[a][across] - x[b][across]) < 1e-12);
    }
    if (!free) area += r.area;
  }
  return area;
}

// Constant curvature, drawn: the energy of the whole sheet. Crossed diagonals hold more of twist until they are at rest
// (above).
TEST(MeshPlate, CurvedOrTwistedAlikeEverywhereItHoldsItsEnergy) {
  const Bending woven = woven_bending();
  for (const Mesh& of : kMeshes)
    for (unsigned seed : {1u, 2u}) {
      const auto mesh =
          made_up({.nx = 33, .ny = 25, .shift = of.shift, .diagonals = of.diagonals, .seed = seed});
      const auto triangles = physics::rest_triangles(*mesh, {mesh->vertices}, woven);
      physics::MeshMaterial bends{};
      bends.bends = true;
      const double curvature = 1e-3;
      const auto energy = [&](auto&& height) {
        std::vector<Vec3> x = mesh->vertices;
        for (Vec3& p : x) p[1] = curvature * height(p[0], p[2]);
        return physics::mesh_energy(triangles, bends, x) / (0.5 * curvature * curvature);
      };
      const double warp = energy([](double u, double) { return 0.5 * u * u; }),
                   weft = energy([](double, double v) { return 0.5 * v * v; }),
                   twist = energy([](double u, double v) { return u * v; });
      const bool crossed = of.diagonals == Diagonals::crossed;
      const auto held = [&](std::size_t across) {
        return held_area(triangles, mesh->vertices, across);
      };
      EXPECT_NEAR(warp / (woven.warp * held(0)), 1, 0.04) << of.name;
      EXPECT_NEAR(weft / (woven.weft * held(2)), 1, 0.04) << of.name;
      EXPECT_NEAR(twist / (2 * woven.twist), 1, crossed ? 0.6 : 0.05) << of.name;
    }
}

// However thin triangles are, and where warp or weft resists nothing.
TEST(MeshPlate, NoShapeHoldsLessThanTheFlatOne) {
  for (const double weft : {0.0, 1e-6, 1e-2})
    for (unsigned seed = 1; seed < 9; ++seed) {
      Bending bending = 1e-4;
      bending.weft = weft, bending.twist = seed % 2 ? 1e-5 : 0;
      const auto mesh = made_up({.nx = 9, .ny = 8, .shift = 0.49, .seed = seed});
      for (const physics::RestTriangle& r :
           physics::rest_triangles(*mesh, {mesh->vertices}, bending)) {
        Eigen::Matrix3d m;
        m << r.moment[0], r.moment[3], r.moment[5], r.moment[3], r.moment[1], r.moment[4],
            r.moment[5], r.moment[4], r.moment[2];
        const Eigen::Vector3d parts =
            Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvalues();
        EXPECT_TRUE(parts.allFinite());
        EXPECT_GE(parts[0], -1e-12 * parts[2]);
      }
    }
}

}  // namespace
}  // namespace weft
