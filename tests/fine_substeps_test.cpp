// Paths by forces in fine substeps, which rounding would lead astray the farther the finer they are.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "made_up_mesh.h"
#include "mesh_scenes.h"
#include "truth.h"

namespace weft {
namespace {

// Sheets that swing and fold, undamped, by forces in ever finer substeps: they come as near to the finest as steps of
// second order do, though the motion makes tens of times as much of every rounding.
TEST(FineSubsteps, ComeNearerWithTheSquareOfTheSubstep) {
  const char* names[] = {"springs", "springs and bending", "membrane and bending",
                         "membrane and bending of a mesh"};
  for (int material = 0; material < 4; ++material) {
    const bool is_mesh = material == 3;
    Scene scene =
        is_mesh ? scene_of(made_up({.nx = 17, .ny = 17, .width = 2, .height = 2, .shift = 0.2}))
                : Scene{};
    if (!is_mesh) {
      scene.cloths.emplace_back();
      scene.cloths[0].grid = {17, 17, {0, 0, 0}, {2, 0, 0}, {0, 0, 2}, 0};
    }
    Cloth& cloth = scene.cloths[0];
    for (int j = 0; j < 9; ++j) cloth.pins.push_back(is_mesh ? Pin{17 * j, 0, {}} : Pin{0, j, {}});
    cloth.density = 0.3;
    cloth.drag = 0;
    if (material < 2)
      cloth.stiffness = {150, 50, 0};
    else
      cloth.membrane = {150, 130, 20, 47, 0};
    cloth.bending = material > 0 ? 5e-4 : 0;
    scene.solver.method = Method::spring;
    scene.gravity = {1.8, -7.8, -0.5};
    std::vector<double> finest;
    double before = 0;
    for (const int substeps : {1200, 400, 200, 100}) {
      scene.time = {1.0 / 60, substeps, 1};
      Simulation run(scene, {.threads = 1});
      for (int n = 0; n < 48; ++n) run.advance_frame();
      const std::vector<double> x = run.positions();
      if (finest.empty()) finest = x;
      double sum = 0;
      for (std::size_t c = 0; c < x.size(); ++c) sum += std::pow(x[c] - finest[c], 2);
      const double error = std::sqrt(3 * sum / double(x.size()));
      if (before > 0) {
        EXPECT_GT(error, 2 * before) << names[material] << ", " << substeps;
      }
      before = substeps < 1200 ? error : 0;
    }
    expect({"sheet that swings, 100 substeps a frame beside 1200", names[material], 0, 1e-5, "m"},
           before);
  }
}

}  // namespace
}  // namespace weft
