// Sheets draped on every shape: nothing below the surface, the same bits everywhere, and rows out
// of reach left alone.
#include <cstdio>

#include "cases.h"
#include "contact_scenes.h"
#include "machines.h"

namespace weft {
namespace {

Scene drape(const Shape& shape, Method method) {
  Scene scene;
  scene.solver.method = method;
  scene.cloths.push_back(flat_sheet(40, 1, {0, 0.32, 0}));
  scene.cloths[0].drag = 1;
  scene.colliders.push_back(collider_of(shape, 0.3));
  scene.colliders.push_back(collider_of(Plane{{0, -0.4, 0}, {0, 1, 0}}, 0.4));
  return scene;
}

const std::vector<Shape>& drapes() {
  static const std::vector<Shape> all = {Sphere{{0, 0, 0}, 0.3},
                                         Capsule{{-0.3, 0.05, 0}, {0.3, 0, 0.1}, 0.2},
                                         Cylinder{{0, -0.2, 0}, {0, 0.05, 0.02}, 0.3, 0.05},
                                         TaperedCapsule{{-0.25, -0.1, 0}, {0.3, 0, 0.1}, 0.2, 0.08},
                                         Box{{0, 0, 0}, {0.25, 0.2, 0.25}, {0, 30, 0}, 0.02},
                                         Box{{0, 0, 0}, {0.25, 0.2, 0.25}, {0, 30, 0}, 0}};
  return all;
}

TEST(ContactDrape, NoParticleSinksIn) {
  Cases cases(5);
  for (const Method method : {Method::spring, Method::compliant})
    for (const Shape& shape : drapes()) {
      if (!cases.next()) continue;
      Simulation simulation(drape(shape, method));
      double deepest = 0;
      for (int n = 0; n < 90; ++n) {
        simulation.advance_frame();
        ASSERT_TRUE(simulation.status().ok);
        deepest = std::max(deepest, simulation.report().penetration.collider_max);
      }
      std::printf("shape %zu: deepest particle %.2g m\n", shape.index(), deepest);
      EXPECT_LT(deepest, 1e-4 * 0.2);
    }
}

TEST(ContactDrape, SameBitsForAnyThreadsAndInstructionSet) {
  Cases cases(2);
  for (const Shape& shape : drapes()) {
    if (!cases.next()) continue;
    Scene scene = drape(shape, Method::spring);
    scene.cloths[0] = flat_sheet(70, 1, {0, 0.25, 0});  // large enough to be shared out
    std::vector<std::uint64_t> hashes;
    for (const Options& options : machines()) {
      Simulation simulation(scene, options);
      advance(simulation, 0.2);
      hashes.push_back(simulation.hash());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
  }
}

TEST(ContactDrape, RowsOutOfReachAreLeftAlone) {
  Scene scene = drape(Sphere{{0, -3, 0}, 0.3}, Method::spring);
  scene.colliders.pop_back();
  for (const auto& [i, j] : {std::pair{0, 0}, {39, 0}, {0, 39}, {39, 39}})
    scene.cloths[0].pins.push_back({i, j, {}});
  Simulation simulation(scene);
  advance(simulation, 0.5);
  double share = 0;
  for (const SkippedStage& s : simulation.report().skipped)
    if (s.name == "collider") std::sscanf(s.why.c_str(), "%*[^:]: %lf", &share);
  std::printf("%.1f %% of the rows skipped\n", share);
  EXPECT_GT(share, 90);
}

}  // namespace
}  // namespace weft
