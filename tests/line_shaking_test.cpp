// Sheets that are drawn out in substeps too long for line sweeps: what is told of them, and what is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "made_up_mesh.h"
#include "weft/simulation.h"

namespace weft {
namespace {

constexpr int kSide = 17;  // points

// Drawn out by a fifth in two seconds, between two sides.
Scene drawn(bool mesh, bool membrane, double stretch) {
  Scene scene;
  scene.gravity = {};
  Cloth& cloth = scene.cloths.emplace_back();
  if (mesh)
    cloth.mesh.shape = made_up({.nx = kSide, .ny = kSide, .width = 1, .height = 1, .shift = 0.2});
  else
    cloth.grid = {kSide, kSide, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  const std::vector<Vec3> starts = mesh ? placed_vertices(cloth.mesh) : std::vector<Vec3>{};
  if (membrane)
    cloth.membrane = {2000, 2000, 400, 400, 0};
  else if (mesh)
    cloth.stiffness.structural = 2000;
  else
    cloth.stiffness = {1000, 1000, 0};
  for (int j = 0; j < kSide; ++j)
    for (const int i : {0, kSide - 1}) {
      Pin pin{mesh ? j * kSide + i : i, mesh ? 0 : j, {}};
      Vec3 at = mesh ? starts[std::size_t(pin.i)] : place_on(cloth.grid, i, j);
      if (i > 0) {
        pin.keys = {{0, at}, {2, at}};
        pin.keys[1].position[0] += stretch;
      }
      cloth.pins.push_back(pin);
    }
  return scene;
}

Scene hung(double stiffness) {
  Scene scene;
  Cloth& cloth = scene.cloths.emplace_back();
  cloth.grid = {32, 32, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.stiffness = {stiffness, 1000, 200};
  cloth.drag = 1;
  cloth.pins = {{0, 0, {}}, {31, 0, {}}};
  return scene;
}

struct Result {
  double strain = 0, energy = 0;
  bool told = false;
};

Result run(Scene scene, int substeps, int iterations = 1, int order = 1) {
  scene.solver.method = Method::compliant;
  scene.solver.sweep = Sweep::line;
  scene.solver.iterations = iterations;
  scene.solver.order = order;
  scene.time.substeps = substeps;
  Simulation simulation(scene, {.threads = 1});
  for (int n = 0; n < 128; ++n) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  const Report report = simulation.report(false);
  // Energy from nowhere, too, is told, and mended from there on.
  const bool told = std::ranges::any_of(report.notes, [](const std::string& note) {
    return note.find("along its lines") != note.npos || note.find("from nowhere") != note.npos ||
           note.find("leave strain") != note.npos;
  });
  return {report.strain.max, report.energy.kinetic + report.energy.elastic, told};
}

// Where nothing is told, sheets are strained about as in fine substeps, and hold about that energy.
TEST(LineShaking, WhatIsDrawnOutTooFarIsTold) {
  struct Case {
    const char* name;
    Scene scene;
  };
  const Case cases[] = {{"grid", drawn(false, false, 0.2)},
                        {"grid, less", drawn(false, false, 0.05)},
                        {"membrane", drawn(false, true, 0.2)},
                        {"mesh", drawn(true, false, 0.2)},
                        {"mesh, less", drawn(true, false, 0.05)},
                        {"hung", hung(1000)},
                        {"stiff, hung", hung(1e5)}};
  int told = 0, silent = 0;
  for (const Case& c : cases) {
    const Result truth = run(c.scene, 64, 2);
    EXPECT_FALSE(truth.told) << c.name;
    for (const int substeps : {2, 4, 6, 8, 16})
      for (const int iterations : {1, 2})
        for (const int order : {1, 2}) {
          const Result r = run(c.scene, substeps, iterations, order);
          (r.told ? told : silent)++;
          if (r.told) continue;
          EXPECT_LT(r.strain, 1.8 * truth.strain + 0.01)
              << c.name << ' ' << substeps << ' ' << iterations << ' ' << order;
          EXPECT_LT(r.energy, 2.2 * truth.energy + 0.05)
              << c.name << ' ' << substeps << ' ' << iterations << ' ' << order;
        }
    // Not of everything.
    EXPECT_FALSE(run(c.scene, 32, 1).told) << c.name;
    EXPECT_FALSE(run(c.scene, 16, 2, 2).told) << c.name;
  }
  EXPECT_GT(told, 40);
  EXPECT_GT(silent, 60);
}

}  // namespace
}  // namespace weft
