// Energy that forces make of nothing is told of, with what ends it; calm sheets tell nothing. Rigid constraints make none.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cases.h"
#include "made_up_mesh.h"
#include "weft/simulation.h"

namespace weft {
namespace {

// Soft for its weight, so that it hangs down to several times its length, nearly without shear springs.
Scene soft_sheet(int n, double stiffness) {
  Scene scene;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {n, n, {0, 0, 0}, {1.2, 0, 0}, {0, -0.3, 2.36}, 0};
  cloth.density = 0.7;
  cloth.drag = 0;
  cloth.stiffness = {stiffness, stiffness / 10, 0};
  cloth.pins = {{0, 0, {}}, {n - 1, 0, {}}};
  return scene;
}

struct Result {
  double gain = 0;  // of energy, by the greatest motion; the greatest that was seen
  bool told = false;
  bool more_sweeps = false;  // than asked for, as a note says
};

bool has_note(const Simulation& simulation, const std::string& words) {
  return std::ranges::any_of(simulation.plan().notes, [&](const std::string& note) {
    return note.find(words) != note.npos;
  });
}
bool is_told(const Simulation& simulation) {
  return has_note(simulation, "J of nothing");
}

Result run(const Scene& scene, int frames) {
  Simulation simulation(scene, {.threads = 1});
  const auto energy = [&] { return simulation.report(false).energy; };
  const double start = energy().total;
  double motion = 0, most = start;
  for (int n = 0; n < frames; ++n) {
    simulation.advance_frame();
    if (n % 8 != 7) continue;
    motion = std::max(motion, energy().kinetic);
    most = std::max(most, energy().total);
  }
  EXPECT_TRUE(simulation.status().ok);
  return {(most - start) / motion, is_told(simulation), false};
}

TEST(Heating, WhatGrowsIsToldAndEndsInHalfTheSubsteps) {
  Scene scene = soft_sheet(33, 25.65);
  const Result grown = run(scene, 720);
  EXPECT_GT(grown.gain, 0.5);
  EXPECT_TRUE(grown.told);
  scene.time.substeps = 8;
  const Result calm = run(scene, 720);
  EXPECT_LT(calm.gain, 0.03);
  EXPECT_FALSE(calm.told);
}

// Of a few substeps a frame, too, in which much comes and goes.
TEST(Heating, NothingIsToldOfWhatKeepsItsEnergy) {
  int told = 0;
  for (const Method method : {Method::spring, Method::spring_friction})
    for (const int n : {5, 9, 17})
      for (const double stiffness : {20.0, 60.0, 500.0}) {
        Scene scene = soft_sheet(n, stiffness);
        scene.solver.method = method;
        const Result r = run(scene, 480);
        told += r.told;
        EXPECT_GT(r.gain, r.told ? 0.09 : -1) << n << ' ' << stiffness;
        EXPECT_LT(r.gain, r.told ? 1 : 0.11) << n << ' ' << stiffness;
      }
  EXPECT_LT(told, 4);  // of 18
}

// A body that is in the cloth as they meet grows, and stretches it: that is put in.
TEST(Heating, NothingIsToldOfWhatBodiesThatStartInsidePutIn) {
  Sphere ball;
  ball.radius = 0.3;
  Box box;
  box.half = {0.1, 0.1, 0.1};
  for (const Shape& shape : {Shape(ball), Shape(box)})
    for (const Vec3& gravity : {Vec3{}, Vec3{0, -9.81, 0}}) {
      Scene scene;
      scene.gravity = gravity;
      Cloth& cloth = scene.cloths.emplace_back();
      cloth.grid = {21, 21, {-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1}, 0};
      cloth.stiffness = {1000, 500, 50};
      cloth.drag = 0;
      scene.colliders.emplace_back().shape = shape;
      EXPECT_FALSE(run(scene, 200).told) << shape.index() << ' ' << gravity[1];
    }
}

// The same of cloth that begins at rest at height 0, by the sum of motion and height: rigid constraints hold no energy.
Result lifted(const Scene& scene, int frames) {
  Simulation simulation(scene, {.threads = 1});
  double most = 0, motion = 0;
  const int between_looks = 1 + frames / 10;
  for (int n = 1; n <= frames; ++n) {
    simulation.advance_frame();
    if (n % between_looks != 0) continue;
    const auto energy = simulation.report(false).energy;
    motion = std::max(motion, energy.kinetic);
    most = std::max(most, energy.kinetic + energy.gravity);
  }
  return {most / motion, is_told(simulation), has_note(simulation, "run in place of")};
}

Scene level_sheet(int columns, int rows, const std::vector<std::pair<int, int>>& pins) {
  Scene scene;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {columns, rows, {-0.5, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.drag = 0;
  for (const auto& [i, j] : pins) cloth.pins.push_back({i, j, {}});
  return scene;
}

// In up to 1e5 substeps a second, whatever sweeps there are. Where energy is lost, that is by implicit Euler. What begins
// as long as constraints ask for gains none.
TEST(Heating, RigidConstraintsMakeNoEnergy) {
  using Pins = std::vector<std::pair<int, int>>;
  Cases cases(7);
  for (const int substeps : {100, 400, 1667})
    for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line, Sweep::jacobi})
      for (const int iterations : {1, 2, 5})
        for (const double bend : {0.0, 100.0})
          for (const Pins& pins :
               {Pins{{0, 0}}, Pins{{0, 0}, {8, 0}}, Pins{{0, 0}, {0, 4}, {0, 8}}})
            for (const double share : {0.5, 0.4}) {
              if (!cases.next()) continue;
              Scene scene = level_sheet(9, 9 + 4 * (iterations % 2), pins);
              scene.cloths[0].stiffness = {1000, 500, bend};
              scene.cloths[0].positional_k = share;
              scene.solver.method = Method::positional;
              scene.solver.sweep = sweep;
              scene.solver.iterations = iterations;
              scene.time.substeps = substeps;
              EXPECT_LT(lifted(scene, 32).gain, 0.005)
                  << substeps << " substeps, sweep " << int(sweep) << ", " << iterations
                  << " iterations, bend " << bend << ", pins " << pins.size() << ", " << share;
            }
}

// Of the ways that made most, longer.
TEST(Heating, NothingIsToldOfRigidBendSprings) {
  Scene scene = level_sheet(9, 9, {{0, 0}, {8, 0}});
  scene.solver.method = Method::positional;
  scene.solver.iterations = 1;
  scene.time.substeps = 1667;
  const auto calm = [&](double bend, Sweep sweep) {
    scene.cloths[0].stiffness = {1000, 500, bend};
    scene.solver.sweep = sweep;
    const Result r = lifted(scene, 72);
    // Lines go one way, and make a little.
    EXPECT_LT(r.gain, sweep == Sweep::line ? 0.01 : 0.005) << bend << ' ' << int(sweep);
    EXPECT_FALSE(r.told) << bend << ' ' << int(sweep);
  };
  calm(100, Sweep::gauss_seidel);
  calm(0, Sweep::gauss_seidel);
  calm(100, Sweep::line);
  // Frames shorter than any automatic substep.
  scene.solver.sweep = Sweep::gauss_seidel;
  scene.time = {.frame = 1e-5, .substeps = kAutoSubsteps};
  EXPECT_LT(lifted(scene, 60'000).gain, 0.005);
}

// They hold no energy where they begin too long, and snap back all the same.
TEST(Heating, NothingIsToldOfRigidConstraintsThatBeginTooLong) {
  for (const int substeps : {2, 16, 128, 400}) {
    Scene scene = soft_sheet(9, 500);
    scene.solver.method = Method::positional;
    scene.time.substeps = substeps;
    Simulation simulation(scene, {.threads = 1});
    std::vector<double> x = simulation.positions();
    for (double& place : x) place *= 1.2;
    simulation.set_state(x, std::vector<double>(x.size(), 0.0));
    for (int n = 0; n < 160; ++n) simulation.advance_frame();
    EXPECT_FALSE(is_told(simulation)) << substeps;
  }
}

// Springs that are too stiff for their substeps keep strain that sweeps leave (a note tells), but it does not come out.
// A level sheet of 1 m, as a grid or as an irregular mesh, that sweeps by colours solve.
Scene swept(bool irregular, int columns, int rows, const std::vector<std::pair<int, int>>& pins) {
  Scene scene = level_sheet(columns, rows, pins);
  if (irregular) {
    scene.cloths[0] = {};
    scene.cloths[0].drag = 0;
    scene.cloths[0].mesh.shape = made_up({.nx = columns, .ny = rows, .shift = 0.3});
    for (const auto& [i, j] : pins) scene.cloths[0].pins.push_back({j * columns + i, 0, {}});
  }
  scene.solver.method = Method::compliant;
  scene.solver.sweep = Sweep::gauss_seidel;
  return scene;
}

TEST(Heating, TheSecondOrderMakesNoMotionBySweeps) {
  Cases cases(5);
  for (const bool irregular : {false, true})
    for (const bool membrane : {false, true})
      for (const double stiffness : {1e5, 1e6})
        for (const int substeps : {64, 128})
          for (const int iterations : {1, 2, 3, 4}) {
            if (!cases.next()) continue;
            Scene scene = swept(irregular, 17, 17, {{0, 0}, {16, 0}});
            Cloth& cloth = scene.cloths[0];
            const double half = stiffness / 2;
            if (membrane)
              cloth.membrane = {stiffness, stiffness, half / 2, half, 0};
            else if (irregular)
              cloth.stiffness.structural = stiffness;
            else
              cloth.stiffness = {stiffness, stiffness, 1};
            scene.solver.order = 2;
            scene.solver.iterations = iterations;
            scene.time.substeps = substeps;
            const Result result = lifted(scene, 80);
            EXPECT_EQ(result.more_sweeps, iterations == 1);
            EXPECT_LT(result.gain, 0.01)
                << (irregular ? "mesh" : "grid") << (membrane ? " of a membrane, " : ", ")
                << stiffness << " N/m, " << substeps << " substeps, " << iterations
                << " iterations";
          }
}

// How long substeps are is known once the stages are there.
TEST(Heating, TheSecondOrderMakesNoMotionInAutomaticSubsteps) {
  for (const bool irregular : {false, true}) {
    Scene scene = swept(irregular, 65, 33, {{0, 0}, {0, 32}});
    scene.cloths[0].stiffness.structural = 1e5;
    if (irregular) scene.cloths[0].mesh.scale = 0.5;
    scene.solver.order = 2;
    const Result result = lifted(scene, 60);
    EXPECT_TRUE(result.more_sweeps) << irregular;
    EXPECT_LT(result.gain, 0.01) << irregular;
  }
}

// As where nothing gives, in substeps so short that implicit Euler takes little.
TEST(Heating, StiffSpringsMakeNoMotionInFineSubsteps) {
  Cases cases(3);
  for (const bool irregular : {false, true})
    for (const double stiffness : {1e7, 1e9})
      for (const int substeps : {400, 1667})
        for (const int iterations : {1, 2, 3}) {
          if (!cases.next()) continue;
          Scene scene = swept(irregular, 13, 9, {{0, 0}});
          Kinds& springs = scene.cloths[0].stiffness;
          springs.structural = stiffness;
          if (!irregular) springs = {stiffness, stiffness / 2, 0};
          scene.solver.iterations = iterations;
          scene.time.substeps = substeps;
          const Result result = lifted(scene, 40);
          EXPECT_EQ(result.more_sweeps, iterations % 2 == 1);
          EXPECT_LT(result.gain, 0.01) << (irregular ? "mesh, " : "grid, ") << stiffness << " N/m, "
                                       << substeps << " substeps, " << iterations << " iterations";
        }
}

}  // namespace
}  // namespace weft
