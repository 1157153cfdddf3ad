// Self-contact: at rest no pair closer than the thickness, and no crossings over 10⁴ substeps of
// folding. slow_surface_test has the crumpled sheet.
#include <algorithm>

#include "sheets.h"
#include "truth.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

TEST(SelfContact, CourseSheetFoldsAndRestsAThicknessApart) {
  Scene scene = read_scene("selfCollision").scene;
  scene.cloths[0].self_collision.response = SelfCollisionResponse::stiff;
  std::int64_t crossings = 0, pairs = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Options options;
    options.seed = seed;
    Simulation simulation(scene, options);
    for (std::int64_t substeps = 0; substeps < 12000; substeps += simulation.substeps()) {
      simulation.advance_frame();
      if (simulation.frame() % 10 != 0) continue;
      const auto p = simulation.report().penetration;
      crossings = std::max(crossings, p.crossings);
      if (substeps >= 10000) pairs = std::max(pairs, p.self_pairs);
    }
  }
  const char* const law = "sheet that folds onto itself, 12000 substeps, the worst of five starts";
  expect({law, "scene selfCollision, response stiff: crossings", 0, 0, "triangle pairs"},
         double(crossings));
  expect({law, "scene selfCollision, response stiff: closer than the thickness at rest", 0, 0,
          "pairs"},
         double(pairs));
}

// Of what a sheet falls with, 1.5 J, a thousandth is left at most. (Contact that comes in step with the
// springs' shortest period keeps the folds shaking.)
TEST(SelfContact, FoldedSheetsOfSpringsLieStill) {
  for (const int points : {50, 75}) {
    Scene scene = read_scene("fold50").scene;
    scene.cloths[0].grid.nx = scene.cloths[0].grid.ny = points;
    scene.cloths[0].self_collision.thickness *= 49.0 / (points - 1);
    Simulation simulation(scene);
    while (simulation.frame() < 240) simulation.advance_frame();
    const Report r = simulation.report();
    const std::string what =
        "upright sheet of " + std::to_string(points) + " folds by springs, 4 s: ";
    const char* const law = "sheet that folds onto itself, at rest";
    expect({law, what + "kinetic energy", 0, 1.5e-3, "J"}, r.energy.kinetic);
    expect({law, what + "closer than the thickness", 0, 0, "pairs"},
           double(r.penetration.self_pairs));
  }
}

// Its push is soft: folded layers rest a little nearer than the thickness.
TEST(SelfContact, CourseRuleKeepsLayersApart) {
  const Scene scene = read_scene("selfCollision").scene;
  const double thickness = scene.cloths[0].self_collision.thickness;
  const auto crossings = [](const Simulation& simulation) {
    return double(simulation.report().penetration.crossings);
  };
  const auto overlap = [&](const Simulation& simulation) {
    return simulation.report().penetration.self_max / thickness;
  };
  const char* const law =
      "sheet that folds onto itself, by the course's rule, after 4 s, median of some starts";
  const auto [crossed, overlapping] = medians_of_starts(scene, 4, crossings, overlap);
  expect({law, "scene selfCollision: crossings", 0, 0, "triangle pairs"}, crossed);
  expect({law, "scene selfCollision: greatest overlap", 0, 0.2, "of the thickness"}, overlapping);
}

}  // namespace
}  // namespace weft
