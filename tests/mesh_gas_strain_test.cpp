// What sweeps leave of the strain by a gas, in automatic substeps: little, or told.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "made_up_balloon.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr double kRadius = 0.3;  // m

struct Material {
  double stiffness, density;  // N/m, kg/m²
};

Scene balloon(int times, const Material& material, int order) {
  Scene scene;
  scene.gravity = {};
  scene.solver.method = Method::compliant;
  scene.solver.order = order;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.mesh.shape = made_up_balloon(times, kRadius);
  cloth.density = material.density;
  cloth.membrane = alike_in_all_directions(material.stiffness);
  return scene;
}

bool tells_strain(const Simulation& run) {
  return std::ranges::any_of(run.plan().notes, [](const std::string& n) {
    return n.find("where it holds its gas, sweeps in substeps of") != n.npos;
  });
}

// 2 T/r = p, which is C (λ² - 1) = p R λ with C = C11 + C12.
double strain_by_laplace(double over, double stiffness) {
  const double slope = over * kRadius / (1.3 * stiffness);
  return 0.5 * (slope + std::sqrt(slope * slope + 4)) - 1;
}

TEST(MeshGasStrain, IsThatOfLaplaceOrTold) {
  for (const int order : {1, 2})
    for (const int times : {2, 3})
      for (const Material& material :
           {Material{600, 0.2}, Material{2000, 0.2}, Material{2000, 1}, Material{50000, 0.2}})
        for (const double over : {100.0, 300.0}) {
          Scene scene = balloon(times, material, order);
          scene.cloths[0].pressure.over = over;
          scene.cloths[0].drag = 20;
          Simulation run(scene, {.threads = 1});
          for (int n = 0; n < 20; ++n) run.advance_frame();
          const double expected = strain_by_laplace(over, material.stiffness);
          const double strain = mean_radius(run) / kRadius - 1;
          std::printf("order %d, %d times, %g N/m, %g kg/m², %g Pa, %d substeps: %.5f of %.5f\n",
                      order, times, material.stiffness, material.density, over, run.substeps(),
                      strain, expected);
          if (!tells_strain(run)) {
            EXPECT_NEAR(strain, expected, 0.12 * expected);
          }
          EXPECT_TRUE(tells_strain(run) || material.stiffness < 50000);
        }
}

// What strain is left would count as energy.
TEST(MeshGasStrain, MakesNoEnergy) {
  for (const int times : {2, 3})
    for (const Material& material : {Material{600, 0.2}, Material{2000, 0.3}})
      for (const double inflate : {1.1, 1.3}) {
        Scene scene = balloon(times, material, 2);
        Cloth& cloth = scene.cloths[0];
        auto egg = std::make_shared<TriangleMesh>(*cloth.mesh.shape);
        for (Vec3& x : egg->vertices) x = {x[0], 0.8 * x[1], 1.2 * x[2]};
        cloth.mesh.shape = egg;
        cloth.pressure = {.inflate = inflate, .ambient = 1000};
        cloth.bending = 1e-4;
        cloth.velocity = {1, 2, 3};
        cloth.spin = {2, 3, 4};
        Simulation run(scene, {.threads = 1});
        const double start = run.report().energy.total;
        double most = start;
        for (int n = 0; n < 10; ++n) {
          run.advance_frame();
          most = std::max(most, run.report().energy.total);
        }
        std::printf("%d times, %g N/m, inflated %g: %.4f J, %.4f at most, %d substeps\n", times,
                    material.stiffness, inflate, start, most, run.substeps());
        EXPECT_LT(most, 1.01 * start);
      }
}

}  // namespace
}  // namespace weft
