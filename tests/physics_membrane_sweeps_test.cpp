// Sweeps over a membrane cell by cell: the same motion as by forces and by lines; nothing swings up; what Jacobi sweeps
// run in its place.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "membrane_curtain.h"
#include "weft/simulation.h"

namespace weft {
namespace {

// Constraint by constraint the same motion, from shorter substeps on, and the faster the more sweeps there are.
TEST(MembraneSweeps, MoveAsForcesInFineSubstepsOrManySweeps) {
  for (const Membrane& membrane : {kWoven, kIsotropic, Membrane{1000, 1500, -400, 200, 0}}) {
    const Scene scene = curtain(25, membrane);
    const std::vector<double> truth = after(by_forces(scene), 30);
    const auto error = [&](int order, int substeps, int iterations) {
      Scene sweeps = by_sweeps(scene, Sweep::gauss_seidel, order, substeps);
      sweeps.solver.iterations = iterations;
      return apart(after(sweeps, 30), truth);
    };
    for (const int order : {1, 2}) {
      double before = 0;
      for (const int substeps : {16, 32, 64, 128}) {
        const double now = error(order, substeps, 1);
        if (before > 4e-4) {
          EXPECT_LT(now, before / 1.7) << order << ' ' << substeps;
        }
        before = now;
      }
      EXPECT_LT(before, order == 1 ? 6e-4 : 3e-4) << order;
    }
    // Converged, sweeps of either kind solve the same equations.
    Scene lines = by_lines(scene, 1, 16), single = by_sweeps(scene, Sweep::gauss_seidel, 1, 16);
    lines.solver.iterations = 12;
    single.solver.iterations = 120;
    EXPECT_LT(apart(after(single, 10), after(lines, 10)), 1e-4);
  }
}

// Damping takes what it should, however many sweeps share it.
TEST(MembraneSweeps, DampAsForcesInAnyNumberOfSweeps) {
  for (const double damping : {5e-4, 2e-3}) {
    Scene scene = curtain(13, {3000, 2000, 200, 80, damping});
    scene.cloths[0].bending = {};
    const std::vector<double> truth = after(by_forces(scene), 30);
    for (const int order : {1, 2})
      for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line})
        for (const int iterations : {1, 2, 3, 6}) {
          Scene sweeps = by_sweeps(scene, sweep, order, order == 1 ? 512 : 128);
          sweeps.solver.iterations = iterations;
          EXPECT_LT(apart(after(sweeps, 30), truth), 4e-4)
              << damping << ", order " << order << ", sweep " << int(sweep) << ", " << iterations;
        }
  }
}

// A strip that is slowly drawn out, of cells that are long or hardly resist shear: what a sweep leaves falls with
// the substep, whatever the order, and nothing swings up.
TEST(MembraneSweeps, OfLongOrSoftCellsStretchLessTheFinerTheyAre) {
  struct Pull {
    int nx, ny;
    Membrane membrane;
  };
  for (const Pull& pull : {Pull{5, 21, {5000, 5000, 0, 100, 0}},
                           {5, 21, {5000, 3000, -1500, 100, 0}},
                           {13, 13, {5000, 5000, 0, 1, 0}},
                           {9, 25, {250, 500, 100, 2, 0}}})
    for (const int order : {1, 2}) {
      double before = 1e9;
      for (const int substeps : {8, 16, 32, 64, 128, 256}) {
        Scene scene = by_sweeps(curtain(3, pull.membrane), Sweep::gauss_seidel, order, substeps);
        scene.gravity = {};
        Cloth& cloth = scene.cloths[0];
        cloth.grid = {pull.nx, pull.ny, {0, 0, 0}, {0.5, 0, 0}, {0, 0, 0.5}, 0};
        cloth.bending = {};
        cloth.density = 0.3;
        cloth.drag = 20;
        cloth.pins.clear();
        for (int i = 0; i < pull.nx; ++i) {
          cloth.pins.push_back({i, 0, {}});
          const double x = 0.5 * i / (pull.nx - 1);
          cloth.pins.push_back({i, pull.ny - 1, {{0, {x, 0, 0.5}}, {0.75, {x, 0, 0.5375}}}});
        }
        Simulation simulation(scene);
        for (int frame = 0; frame < 45; ++frame) simulation.advance_frame();
        const Report r = simulation.report(false);
        EXPECT_LT(r.strain.max, 1.02 * before) << order << " " << substeps;
        EXPECT_LT(r.energy.kinetic, 0.01) << order << " " << substeps;
        before = r.strain.max;
      }
      EXPECT_LT(before, 0.09) << order;
    }
}

TEST(MembraneSweeps, OfJacobiAreOfSpringsAndSaySo) {
  Scene scene = by_lines(curtain(9, kWoven), 1, 8);
  scene.cloths[0].membrane.damping = 1e-4;
  scene.cloths[0].bending.damping = 1e-3;
  for (const Sweep sweep : {Sweep::line, Sweep::gauss_seidel, Sweep::jacobi}) {
    scene.solver.sweep = sweep;
    const Simulation simulation(scene);
    bool told = false;
    for (const std::string& note : simulation.plan().notes)
      told |= note.find(
                  "springs of the membrane's warp, weft and shear run in its place, without "
                  "its damping") != std::string::npos &&
              note.find("solves the membrane itself") != std::string::npos;
    EXPECT_EQ(told, sweep == Sweep::jacobi);
  }
}

}  // namespace
}  // namespace weft
