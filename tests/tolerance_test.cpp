// What picks method, substeps and grids for an asked error: its estimates against closed forms, its choices against
// far finer runs, over the whole length.
#include "weft/tolerance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tolerance/ladder.h"

namespace weft {
namespace {

// Runs that are off by C h^p: each of one particle, at one instant.
tolerance::Motion off_by(double error) {
  tolerance::Motion motion;
  motion.grids = {{0, 0}};
  motion.places = {{1 + error, 2, 3}};
  return motion;
}

TEST(Tolerance, LaddersTellTheErrorOfAnyPower) {
  for (const double p : {0.7, 1.0, 1.5, 2.0}) {
    tolerance::Ladder ladder(2);
    for (int rung = 0; rung < 5; ++rung) {
      ladder.add(off_by(0.1 * std::pow(2, -p * rung)));
      if (rung < 2) continue;
      const double finest = 0.1 * std::pow(2, -p * rung);
      EXPECT_NEAR(ladder.order(), p, 1e-9);
      EXPECT_NEAR(ladder.error(), finest, 1e-9);
      EXPECT_NEAR(ladder.error(0.5), finest * std::pow(2, p), 1e-9);
      EXPECT_EQ(ladder.needed(finest * std::pow(2, p) * 1.01), 0.5);
      EXPECT_NEAR(ladder.needed(finest * 1.1).value(), std::pow(1.1, -1 / p), 1e-9);
      EXPECT_GT(ladder.needed(finest / 1.2).value(), 1);
      EXPECT_FALSE(ladder.needed(finest / 8));  // too far from what was run
    }
  }
}

TEST(Tolerance, WhatDoesNotFallTellsNothing) {
  tolerance::Ladder ladder(2);
  for (const double error : {0.1, 0.05, 0.08, 0.03, 0.07}) ladder.add(off_by(error));
  EXPECT_FALSE(ladder.falls());
  EXPECT_FALSE(ladder.needed(0.05));
  EXPECT_TRUE(ladder.needed(0.2));  // whatever it does, so far apart it is not
}

// Falls fast, then hardly.
TEST(Tolerance, APlateauIsNoConvergence) {
  tolerance::Ladder ladder(2);
  for (const double error : {1.0, 0.3, 0.05, 0.045}) ladder.add(off_by(error));
  for (const double error : {0.041, 0.038}) ladder.add(off_by(error));
  EXPECT_FALSE(ladder.falls());
}

struct Case {
  const char* name;
  double stiffness, bending, seconds;
  bool side;  // held along a side; or by two corners
};

Scene scene_of(const Case& c) {
  Scene scene;
  scene.name = c.name;
  scene.gravity = {2, -9, 3};
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {13, 13, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.stiffness = {c.stiffness, c.stiffness / 2, 0};
  cloth.bending = c.bending;
  cloth.drag = 1;
  if (c.side)
    for (int j = 0; j < 13; ++j) cloth.pins.push_back({0, j, {}});
  else
    cloth.pins = {{0, 0, {}}, {12, 0, {}}};
  return scene;
}

const Case kCases[] = {{"curtain", 1000, 1e-3, 0.5, true},
                       {"stiffer", 2e4, 1e-2, 0.4, true},
                       {"soft", 200, 3e-4, 0.7, true},
                       {"corners", 1000, 1e-3, 0.4, false}};

std::vector<std::vector<double>> frames_of(const Scene& scene, double seconds) {
  Simulation simulation(scene);
  std::vector<std::vector<double>> frames;
  for (int n = 0; n < std::lround(seconds * 60); ++n) {
    simulation.advance_frame();
    frames.push_back(simulation.positions());
  }
  return frames;
}

// The greatest over all frames, at the points of a grid of n intervals a side.
double error_of(const std::vector<std::vector<double>>& run, int n,
                const std::vector<std::vector<double>>& truth, int finer) {
  double greatest = 0;
  for (std::size_t f = 0; f < run.size(); ++f) {
    double sum = 0;
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i)
        for (int k = 0; k < 3; ++k) {
          const int every = finer / n;
          const double apart = run[f][std::size_t(3 * (j * (n + 1) + i) + k)] -
                               truth[f][std::size_t(3 * (j * every * (finer + 1) + i * every) + k)];
          sum += apart * apart;
        }
    greatest = std::max(greatest, std::sqrt(sum / ((n + 1) * (n + 1))));
  }
  return greatest;
}

TEST(Tolerance, SubstepsKeepTheErrorOverTheWholeRun) {
  for (const Case& c : kCases) {
    const Scene scene = scene_of(c);
    Scene fine = scene;
    fine.time.substeps = 4 * Simulation(scene).substeps();
    const auto truth = frames_of(fine, c.seconds);
    for (const double asked : {0.03, 0.003, 0.0006}) {
      const Tolerance tolerance{asked, c.seconds, false, {}};
      const Choice choice = choose(scene, tolerance, {});
      ASSERT_TRUE(choice.promised) << c.name << ' ' << asked << '\n' << to_text(choice, tolerance);
      EXPECT_NEAR(choice.tried, c.seconds, 0.02);
      const double error = error_of(frames_of(choice.scene, c.seconds), 12, truth, 12);
      std::printf("%s, %g m: %.1e m\n%s", c.name, asked, error, to_text(choice, tolerance).c_str());
      EXPECT_LT(error, 1.1 * asked) << c.name;
    }
  }
}

TEST(Tolerance, GridsKeepTheDistanceFromTheSheet) {
  for (const Case& c : kCases) {
    if (!c.side) continue;  // a sheet has no limit that is held at points
    const Scene scene = scene_of(c);
    for (const double asked : {0.03, 0.008}) {
      const Tolerance tolerance{asked, c.seconds, true, {}};
      const Choice choice = choose(scene, tolerance, {});
      ASSERT_TRUE(choice.promised) << c.name << ' ' << asked << '\n' << to_text(choice, tolerance);
      const Grid& grid = choice.scene.cloths[0].grid;
      ASSERT_EQ(grid.nx, grid.ny);
      const int n = grid.nx - 1, finer = n * std::max(3, (63 + n) / n);
      Scene fine = scene;
      fine.cloths = {with_intervals(scene.cloths[0], {finer, finer}).cloth};
      const double error =
          error_of(frames_of(choice.scene, c.seconds), n, frames_of(fine, c.seconds), finer);
      std::printf("%s, %g m: %.1e m\n%s", c.name, asked, error, to_text(choice, tolerance).c_str());
      EXPECT_LT(error, 1.2 * asked) << c.name;
    }
  }
}

TEST(Tolerance, TheChoiceIsTheSameForAnyThreads) {
  const Scene scene = scene_of(kCases[0]);
  for (const bool grids : {false, true}) {
    const Choice one = choose(scene, {0.005, 0.3, grids, {}}, {.threads = 1});
    const Choice three = choose(scene, {0.005, 0.3, grids, {}}, {.threads = 3});
    EXPECT_EQ(one.scene, three.scene);
    EXPECT_EQ(one.trial_work, three.trial_work);
  }
}

// A soft sheet without bending that falls past its support crumples: finer substeps end elsewhere.
TEST(Tolerance, WhatIsChaoticIsNotPromised) {
  Scene scene;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {17, 17, {0, 0.4, 0}, {0.5, 0, 0}, {0, 0, 0.5}, 0.001};
  cloth.stiffness = {100, 50, 0};
  cloth.drag = 1;
  cloth.pins = {{0, 0, {}}, {16, 0, {}}};
  scene.wind = {{-2, 0, 2}, 0.6, 0.2, 0, {}};
  const Choice choice = choose(scene, {0.0005, 1.5, false, {}}, {});
  EXPECT_FALSE(choice.promised);
  ASSERT_FALSE(choice.notes.empty());
  EXPECT_NE(choice.notes[0].find("not promised"), std::string::npos) << choice.notes[0];
  // The nearest that was tried runs.
  const auto nearest = std::ranges::min_element(choice.trials, {}, &Trial::error);
  EXPECT_EQ(choice.scene.time.substeps, nearest->substeps);
  EXPECT_EQ(choice.scene.solver.method, nearest->solver.method);
}

// Damping that takes forces many substeps.
TEST(Tolerance, StrongDampingIsKept) {
  Scene scene = scene_of(kCases[0]);
  Cloth& cloth = scene.cloths[0];
  cloth.membrane = {1500, 1500, 500, 500, 0};
  cloth.stiffness = Cloth{}.stiffness;
  cloth.bending = 2e-2;
  cloth.bending.damping = 1;
  const Tolerance tolerance{0.005, 0.1, false, {}};
  const Choice choice = choose(scene, tolerance, {});
  ASSERT_TRUE(choice.promised) << to_text(choice, tolerance);
  Scene fine = scene;
  fine.time.substeps = 2 * Simulation(scene).substeps();
  EXPECT_LT(error_of(frames_of(choice.scene, 0.1), 12, frames_of(fine, 0.1), 12), 0.006)
      << to_text(choice, tolerance);
}

// The error is that of the cloth which is farthest off, and cells keep their shape, which springs need.
TEST(Tolerance, GridsOfAllClothsKeepTheDistanceAndTheirCells) {
  Scene scene = scene_of(kCases[0]);
  scene.cloths[0].grid.nx = 25;  // of the same side: long cells
  scene.cloths[0].pins.clear();
  for (int j = 0; j < 13; ++j) scene.cloths[0].pins.push_back({0, j, {}});
  Cloth& small = scene.cloths.emplace_back(scene.cloths[0]);
  small.grid = {4, 4, {0, 0, 3}, {0.5, 0, 0}, {0, 0, 0.5}, 0};
  small.pins.clear();
  for (int j = 0; j < 4; ++j) small.pins.push_back({0, j, {}});
  const Tolerance tolerance{0.02, 0.3, true, {}};
  const Choice choice = choose(scene, tolerance, {});
  ASSERT_TRUE(choice.promised) << to_text(choice, tolerance);
  for (std::size_t c = 0; c < 2; ++c) {
    const Cloth &picked = choice.scene.cloths[c], &own = scene.cloths[c];
    const double shape = (picked.grid.nx - 1.0) / (picked.grid.ny - 1.0);
    EXPECT_NEAR(shape, (own.grid.nx - 1.0) / (own.grid.ny - 1.0), 0.03 * shape);
    Scene one = choice.scene, fine = scene;
    one.cloths = {picked};
    fine.cloths = {with_intervals(own, {4 * (picked.grid.nx - 1), 4 * (picked.grid.ny - 1)}).cloth};
    const auto run = frames_of(one, 0.3), truth = frames_of(fine, 0.3);
    const int nx = picked.grid.nx, finer = 4 * (nx - 1) + 1;
    double sum = 0;
    for (int j = 0; j < picked.grid.ny; ++j)
      for (int i = 0; i < nx; ++i)
        for (int k = 0; k < 3; ++k)
          sum += std::pow(run.back()[std::size_t(3 * (j * nx + i) + k)] -
                              truth.back()[std::size_t(3 * (4 * j * finer + 4 * i) + k)],
                          2);
    EXPECT_LT(std::sqrt(sum / (nx * picked.grid.ny)), 0.024) << c << '\n'
                                                             << to_text(choice, tolerance);
  }
}

TEST(Tolerance, WhatHasNoOtherResolutionIsRefused) {
  EXPECT_THROW(choose(scene_of(kCases[0]), {0.01, 1e12, false, {}}, {}), std::invalid_argument);
  EXPECT_THROW(choose(scene_of(kCases[0]), {0, 1, false, {}}, {}), std::invalid_argument);
  Scene scene = scene_of(kCases[0]);
  scene.cloths[0].level = 2;
  EXPECT_THROW(choose(scene, {0.01, 0.2, true, {}}, {}), std::invalid_argument);
  scene.cloths[0].level = 0;
  scene.solver.method = Method::positional;
  EXPECT_THROW(choose(scene, {0.01, 0.2, false, {}}, {}), std::invalid_argument);
  scene.time.frame = -1;
  EXPECT_THROW(choose(scene, {0.01, 0.2, false, {}}, {}), SceneError);
}

}  // namespace
}  // namespace weft
