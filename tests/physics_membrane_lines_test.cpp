// Sweeps of the membrane, line by line and constraint by constraint: the same motion as by forces in fine substeps;
// what is kept; what tears; the same bits everywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

#include "double_vector.h"
#include "machines.h"
#include "membrane_curtain.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using oracle::operator+;
using oracle::operator-;
using oracle::operator*;

TEST(MembraneLines, MoveAsForcesInFineSubsteps) {
  for (const Membrane& membrane : {kWoven, kIsotropic}) {
    const Scene scene = curtain(25, membrane);
    const std::vector<double> truth = after(by_forces(scene), 30);
    double before = 0;
    for (const int substeps : {8, 16, 32, 64}) {
      const double error = apart(after(by_lines(scene, 1, substeps), 30), truth);
      EXPECT_LT(error, 0.06 / substeps) << substeps;
      if (before > 0) {
        EXPECT_LT(error, before / 1.7) << substeps;
      }
      before = error;
    }
    EXPECT_LT(apart(after(by_lines(scene, 2, 4), 30), truth), 2e-3);
    EXPECT_LT(apart(after(by_lines(scene, 2, 16), 30), truth), 8e-4);
  }
}

// What a cloth can have besides, each alone.
TEST(MembraneLines, MoveAsForcesWithWhatAClothMayHaveBesides) {
  struct Feature {
    const char* name;
    std::function<void(Scene&)> add;
    double most;                      // m
    int frames = 30, substeps = 128;  // of single sweeps
  };
  const Feature features[] = {
      {"cells of 3 to 1",
       [](Scene& s) {
         s.cloths[0].grid.v = {0, 0, 1.0 / 3};
       },
       1e-3},
      {"stiffness gradient", [](Scene& s) { s.cloths[0].stiffness_gradient = 0.6; }, 1e-3},
      {"unequal masses",
       [](Scene& s) {
         s.cloths[0].lumping = Lumping::equal;
         for (int n = 0; n < 17 * 17; ++n) s.cloths[0].masses.push_back(n % 3 == 0 ? 2e-3 : 4e-4);
       },
       2.5e-3},
      {"strong coupling", [](Scene& s) { s.cloths[0].membrane.coupling = 1600; }, 1e-3},
      {"negative coupling", [](Scene& s) { s.cloths[0].membrane.coupling = -900; }, 1e-3},
      {"two sweeps", [](Scene& s) { s.solver.iterations = 2; }, 1e-3},
      {"damping", [](Scene& s) { s.cloths[0].membrane.damping = 4e-3; }, 4e-4, 30, 1024},
      {"damping of bending",
       [](Scene& s) {
         s.cloths[0].bending = 2e-2;
         s.cloths[0].bending.damping = 0.05;
       },
       1e-3},
      {"a cut",
       [](Scene& s) {
         s.cloths[0].cuts = {{{7.4, -1}, {8.7, 9.3}, {12, 9.2}}};
       },
       4e-4, 12},
      {"moving pins",
       [](Scene& s) {
         for (Pin& pin : s.cloths[0].pins)
           for (int k = 0; k <= 30; ++k) {
             const double by = 0.02 * (1 - std::cos(k * 0.2));
             pin.keys.push_back({k / 60.0, {-by, 0, pin.j / 16.0}});
           }
       },
       1e-3},
  };
  for (const Feature& f : features) {
    Scene scene = curtain(17, kWoven);
    f.add(scene);
    Scene truth = by_forces(scene);
    truth.solver.iterations = 1;
    const std::vector<double> end = after(truth, f.frames);
    const auto error = [&](const Scene& s) { return apart(after(s, f.frames), end); };
    const double lines = error(by_lines(scene, 2, 32));
    const double sweeps = error(by_sweeps(scene, Sweep::gauss_seidel, 2, f.substeps));
    EXPECT_LT(sweeps, f.most) << f.name;
    EXPECT_LT(lines, f.most) << f.name;
  }
}

// Starts stretched, turning and rough, in free flight.
Simulation flying(int nx, int ny, const Membrane& membrane, Sweep sweep, int order, int substeps) {
  Scene scene = curtain(nx, membrane);
  scene.gravity = {};
  Cloth& cloth = scene.cloths[0];
  cloth.grid.ny = ny;
  cloth.grid.v = {0, 0, 0.8 * (ny - 1.0) / (nx - 1)};
  cloth.pins.clear();
  cloth.drag = 0;
  Simulation simulation(by_sweeps(scene, sweep, order, substeps));
  std::mt19937 random(7);
  const auto noise = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  std::vector<double> x = simulation.positions(), v(x.size());
  for (std::size_t n = 0; n < x.size(); n += 3) {
    x[n] = 1.02 * x[n] + 1e-4 * noise();
    x[n + 1] += 1e-3 * noise();
    v[n] = 2 * x[n + 2] + 0.5;
    v[n + 2] = -2 * x[n];
    v[n + 1] = 0.5 * noise();
  }
  simulation.set_state(x, v);
  return simulation;
}

double length(const Vec3& a) {
  return oracle::length(a);
}

TEST(MembraneLines, KeepMomentumAndGainNoEnergy) {
  for (const Membrane& membrane : {kWoven, kIsotropic, Membrane{500, 2500, -150, 300, 0}})
    for (const auto& [sweep, order] : {std::pair(Sweep::line, 1),
                                       {Sweep::line, 2},
                                       {Sweep::gauss_seidel, 1},
                                       {Sweep::gauss_seidel, 2}})
      for (const int substeps : {4, 16, 64}) {
        Simulation simulation = flying(31, 22, membrane, sweep, order, substeps);
        const Report start = simulation.report(false);
        double angular = 0, drift = 0;
        for (int frame = 0; frame < 60; ++frame) {
          simulation.advance_frame();
          const Report now = simulation.report(false);
          drift = length(now.momentum - start.momentum);
          // The rough start moves far in a long substep, of which a single sweep takes back a part.
          const bool rough = sweep == Sweep::gauss_seidel && substeps < 64 && frame < 3;
          EXPECT_LT(now.energy.kinetic + now.energy.elastic,
                    (rough ? 1.06 : 1.01) * (start.energy.kinetic + start.energy.elastic))
              << order << " " << substeps << " " << frame;
          angular = length(now.angular_momentum - start.angular_momentum);
        }
        EXPECT_LT(angular, 5e-3 * length(start.angular_momentum)) << order << " " << substeps;
        // Rounding of positions, where velocities are made of them.
        const double rounding = substeps == 64 ? 1e-5 : 2e-3;
        EXPECT_LT(drift, rounding * length(start.momentum)) << order << " " << substeps;
        EXPECT_FALSE(simulation.plan().fallback);
      }
}

// The sheet and its mirror image: diagonals of one way come before those of the other, which is a matter of
// the substep.
TEST(MembraneLines, AreMirrorSymmetricInTheLimit) {
  const int n = 25;
  for (const int substeps : {16, 32, 64}) {
    Scene scene = curtain(n, kWoven);
    scene.gravity = {2, -9, 0};
    const std::vector<double> x = after(by_lines(scene, 1, substeps), 30);
    double most = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const auto a = std::size_t(3 * (j * n + i)), b = std::size_t(3 * ((n - 1 - j) * n + i));
        most = std::max({most, std::abs(x[a] - x[b]), std::abs(x[a + 1] - x[b + 1]),
                         std::abs(x[a + 2] + x[b + 2] - 1)});
      }
    EXPECT_LT(most, substeps == 64 ? 1e-5 : 4e-4) << substeps;
  }
}

TEST(MembraneLines, HasOneResult) {
  const std::function<void(Scene&)> variants[] = {
      [](Scene&) {},
      [](Scene& s) { s.cloths[0].membrane.coupling = 0; },
      [](Scene& s) { s.solver.order = 2, s.solver.tethers = true; },
      [](Scene& s) { s.solver.iterations = 3, s.cloths[0].stiffness_gradient = 0.5; },
      [](Scene& s) { s.cloths[0].tear_strain = 0.01, s.cloths[0].strain_limit = 0; },
      [](Scene& s) {
        s.cloths[0].cuts = {{{20.5, -1}, {20.5, 15.5}}};
      },
      [](Scene& s) { s.cloths[0].strain_limit = 0.005; },
  };
  for (const auto& change : variants)
    for (const Sweep sweep : {Sweep::line, Sweep::gauss_seidel}) {
      Scene scene = by_sweeps(curtain(52, kWoven), sweep, 1, 8);
      scene.cloths[0].grid.ny = 37;
      scene.cloths[0].pins = {{0, 0, {}}, {51, 0, {}}};
      change(scene);
      std::uint64_t hash = 0;
      for (const Options& machine : machines()) {
        Simulation simulation(scene, machine);
        for (int frame = 0; frame < 12; ++frame) simulation.advance_frame();
        if (hash == 0) hash = simulation.hash();
        EXPECT_EQ(hash, simulation.hash()) << int(machine.simd) << " " << machine.threads;
      }
    }
}

TEST(MembraneLines, TearWhereTheyAreStretched) {
  for (const Sweep sweep : {Sweep::line, Sweep::gauss_seidel}) {
    Scene scene = by_sweeps(curtain(24, Membrane{60, 60, 10, 10, 0}), sweep, 1, 16);
    scene.cloths[0].tear_strain = 0.05;
    Simulation simulation(scene);
    for (int frame = 0; frame < 60; ++frame) simulation.advance_frame();
    EXPECT_GT(simulation.report(false).torn, 0);
    EXPECT_TRUE(simulation.status().ok);
  }
}

TEST(MembraneLines, FallFreelyOnceCutOff) {
  for (const Sweep sweep : {Sweep::line, Sweep::gauss_seidel}) {
    Scene scene = by_sweeps(curtain(17, kWoven), sweep, 2, 16);
    scene.gravity = {0, -9.81, 0};
    scene.cloths[0].drag = 0;
    scene.cloths[0].bending = 0;
    Simulation simulation(scene);
    ASSERT_GT(simulation.cut({0.22, 0, -0.1}, {0.22, 0, 1.1}, 1e-3), 0);
    for (int frame = 0; frame < 15; ++frame) simulation.advance_frame();
    const double t = 15.0 / 60;
    EXPECT_NEAR(simulation.positions()[3 * (8 * 17 + 12) + 1], -9.81 * t * t / 2, 1e-3);
  }
}

TEST(MembraneLines, HoldAStrainLimit) {
  for (const Sweep sweep : {Sweep::line, Sweep::gauss_seidel}) {
    Scene scene = by_sweeps(curtain(24, Membrane{100, 100, 10, 20, 0}), sweep, 1, 16);
    scene.cloths[0].strain_limit = 0.02;
    Simulation simulation(scene);
    for (int frame = 0; frame < 60; ++frame) simulation.advance_frame();
    const double limited = simulation.report(false).strain.max;
    scene.cloths[0].strain_limit = 0;
    Simulation loose(scene);
    for (int frame = 0; frame < 60; ++frame) loose.advance_frame();
    EXPECT_LT(limited, 0.0215);
    EXPECT_GT(loose.report(false).strain.max, 0.03);
  }
}

// A sheet that turns and falls on a ball, by few substeps and by many, of a membrane and of springs: where it
// comes to hold more than was ever there, a note says so.
TEST(MembraneLines, TellOfStrainThatNothingPutIn) {
  int told = 0, sound = 0;
  for (const bool membrane : {true, false})
    for (const int substeps : {2, 8, 240}) {
      Scene scene;
      Cloth& cloth = scene.cloths.emplace_back();
      cloth.grid = {32, 32, {0, 0, 0}, {0.33, 0, 0}, {0, 0, 0.16}, 0};
      cloth.density = 0.15;
      if (membrane) cloth.membrane = {510, 270, 0, 5.5, 0};
      cloth.stiffness_gradient = 0.5;
      cloth.spin = {-2.2, -1.6, 0.6};
      scene.colliders.push_back({Sphere{{0.16, -0.155, 0.08}, 0.055}, {}, 0, {}, false});
      scene.solver.iterations = 3;
      Simulation run(by_lines(scene, 1, substeps), {.threads = 1});
      const double start = run.report(false).energy.total;
      double most = 0, moved = 0;
      for (int frame = 0; frame < 40; ++frame) {
        run.advance_frame();
        const auto now = run.report(false).energy;
        most = std::max(most, now.total - start);
        moved = std::max(moved, now.kinetic);
      }
      const std::vector<std::string>& notes = run.plan().notes;
      const bool note = std::any_of(notes.begin(), notes.end(), [](const std::string& n) {
        return n.find("nothing put in") != n.npos;
      });
      const bool made = most > 3 * moved, none = most < 0.1 * moved;
      EXPECT_TRUE(!made || note || run.plan().fallback) << membrane << ", " << substeps;
      EXPECT_FALSE(none && note) << membrane << ", " << substeps;
      told += made;
      sound += none;
    }
  EXPECT_GT(told, 0);
  EXPECT_GT(sound, 0);
}

}  // namespace
}  // namespace weft
