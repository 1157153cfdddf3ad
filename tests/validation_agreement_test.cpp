// What acts on a sheet acts alike whatever the method, and the more so the shorter the substeps: a
// force that one method takes twice, or friction that depends on the substep, shows here.
#include <algorithm>

#include "sheet_features.h"
#include "truth.h"

namespace weft {
namespace {

// The worst of all sweeps, against springs in substeps of 16 µs.
double farthest(Scene scene, const Feature& feature, const std::vector<Sweep>& sweeps, int order,
                const std::vector<double>& truth) {
  double worst = 0;
  for (const Sweep sweep : sweeps) {
    // Gauss-Seidel sweeps run in the place of these.
    if (sweep == Sweep::jacobi && !scene.cloths[0].masses.empty()) continue;
    scene.solver.method = Method::compliant;
    scene.solver.sweep = sweep;
    scene.solver.order = order;
    worst = std::max(worst, apart(half_a_second(scene, feature), truth));
  }
  return worst;
}

TEST(ValidationAgreement, EveryMethodMovesASheetAlike) {
  for (const Feature& feature : features()) {
    Scene scene = hanging_sheet();
    feature.set(scene);
    scene.time.substeps = 1024;
    const auto truth = half_a_second(scene, feature);
    scene.time.substeps = 128;
    const auto row = [&](const std::string& method, double goal, double result) {
      expect({"half a second of a sheet of 0.5 m, 130 µs against springs at 16 µs",
              feature.name + ": " + method, 0, goal, "m"},
             result);
    };
    row("springs", 0.005, apart(half_a_second(scene, feature), truth));
    row("compliant, worst of three sweeps", 0.02,
        farthest(scene, feature, {Sweep::gauss_seidel, Sweep::jacobi, Sweep::line}, 1, truth));
    row("compliant, order 2, worst of two sweeps", 0.01,
        farthest(scene, feature, {Sweep::gauss_seidel, Sweep::line}, 2, truth));
  }
}

}  // namespace
}  // namespace weft
