// validation.md, self-contact: at rest no pair closer than the thickness and no crossings, over 10⁴
// substeps of folding.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "sheets.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

TEST(SelfContact, CourseSheetFoldsAndRestsAThicknessApart) {
  Simulation simulation(read_scene("selfCollision").scene);
  std::int64_t substeps = 0, crossings = 0, pairs = 0;
  double deepest = 0;
  while (substeps < 12000) {
    simulation.advance_frame();
    substeps += simulation.substeps();
    if (simulation.frame() % 10 != 0) continue;
    const auto p = simulation.report().penetration;
    crossings = std::max(crossings, p.crossings);
    if (substeps < 10000) continue;
    pairs = std::max(pairs, p.self_pairs);
    deepest = std::max(deepest, p.self_max);
  }
  std::printf("selfCollision, %lld substeps: %lld crossings at most; after 10000, %lld pairs under the "
              "thickness at most, %.2g m\n",
              (long long)substeps, (long long)crossings, (long long)pairs, deepest);
  EXPECT_EQ(crossings, 0);
  EXPECT_EQ(pairs, 0);
}

TEST(SelfContact, CourseRuleIsStillThere) {
  Scene scene = read_scene("selfCollision").scene;
  scene.cloths[0].self_collision.response = SelfCollisionResponse::course;
  Simulation simulation(scene);
  advance(simulation, 4);
  const auto p = simulation.report().penetration;
  std::printf("the course's rule: %lld crossings, %lld pairs under the thickness, %.2g m at most\n",
              (long long)p.crossings, (long long)p.self_pairs, p.self_max);
  EXPECT_EQ(p.crossings, 0);
  EXPECT_LT(p.self_max, 0.2 * scene.cloths[0].self_collision.thickness);
}

}  // namespace
}  // namespace weft
