// Cuts of the scene: what a line crosses is gone from the start, what is shown ends on the line, and a
// scene without the cut makes it whole again.
#include <algorithm>
#include <cmath>

#include "contact_scenes.h"
#include "physics/model/lattice/cuts.h"

namespace weft {
namespace {

Scene sheet(int n, std::vector<CutLine> cuts, Method method = Method::spring) {
  Scene scene;
  scene.solver.method = method;
  scene.cloths.push_back(flat_sheet(n, 1, {0, 0, 0}));
  Cloth& c = scene.cloths[0];
  c.grid.v = {0, -1, 0};
  c.grid.origin = {-0.5, 0, 0};
  for (int i = 0; i < n; ++i) c.pins.push_back({i, 0, {}});
  c.cuts = std::move(cuts);
  return scene;
}

double area(const ClothView& c) {
  double sum = 0;
  const auto add = [&](const auto& at, const auto& t) {
    const Vec3 a = at(t[0]), b = at(t[1]), d = at(t[2]);
    const double ux = b[0] - a[0], uy = b[1] - a[1], vx = d[0] - a[0], vy = d[1] - a[1];
    sum += 0.5 * std::abs(ux * vy - uy * vx);
  };
  const auto particle = [&](std::uint32_t p) { return Vec3{c.x[p], c.y[p], c.z[p]}; };
  const auto point = [&](std::uint32_t p) {
    const auto& at = c.tear_points[p];
    return Vec3{at[0], at[1], at[2]};
  };
  for (const auto& t : c.triangles) add(particle, t);
  for (const auto& t : c.tear_triangles) add(point, t);
  return sum;
}

TEST(Cuts, CrossingsAreThoseOfLinesAndLieWhereTheyMeet) {
  using physics::crossing;
  EXPECT_EQ(crossing({0, 0}, {4, 0}, {1, -1}, {1, 1}), 0.25);
  EXPECT_EQ(crossing({4, 0}, {0, 0}, {1, -1}, {1, 1}), 0.75);
  EXPECT_FALSE(crossing({0, 0}, {4, 0}, {5, -1}, {5, 1}));
  EXPECT_FALSE(crossing({0, 0}, {4, 0}, {1, 1}, {1, 2}));
  // Of two segments that meet on an edge one crosses it, whichever way they come.
  for (const double bend : {-0.3, 0.0, 0.7}) {
    const bool first = crossing({0, 0}, {4, 0}, {1, -1}, {2, 0}).has_value();
    const bool second = crossing({0, 0}, {4, 0}, {2, 0}, {2 + bend, 1}).has_value();
    EXPECT_NE(first, second) << bend;
  }
}

// Springs from column to column that a straight line between two columns crosses: one a row, two shear ones
// a square of it, and of those over two columns both that begin before it.
TEST(Cuts, ALineAcrossTakesExactlyWhatCrossesIt) {
  const int n = 12;
  for (const CutLine& line :
       {CutLine{{4.3, -1}, {4.3, 12}}, CutLine{{4.3, 12}, {4.3, 5.5}, {4.3, -1}}}) {
    Simulation simulation(sheet(n, {line}));
    EXPECT_EQ(simulation.report().torn, n + 2 * (n - 1) + 2 * n);
    EXPECT_TRUE(simulation.view().cloths[0].torn ||
                simulation.view().cloths[0].topology_version > 0);
  }
}

TEST(Cuts, EveryStripFallsAndWhatHangsStays) {
  for (const Method method : {Method::spring, Method::positional, Method::compliant})
    for (const int n : {9, 32}) {
      const double row = 0.37 * n;  // a slanted line from border to border
      Simulation simulation(sheet(n, {{{-1.0, row}, {double(n), row + 2}}}, method));
      advance(simulation, 0.5);
      const std::vector<double> x = simulation.positions();
      // Free fall from y = -1 at the lowest corner.
      EXPECT_NEAR(x[3 * std::size_t(n * n - 1) + 1], -1 - 0.5 * 9.81 * 0.25, 0.02)
          << int(method) << n;
      EXPECT_GT(x[3 * std::size_t(n) + 1], -0.3) << int(method) << n;
    }
}

TEST(Cuts, WhatIsShownMeetsOnTheLineWithoutAGap) {
  const CutLine line{{-1, 3.2}, {5.1, 4.7}, {12, 9.9}};
  Simulation simulation(sheet(12, {line}));
  const View view = simulation.view();
  const ClothView& c = view.cloths[0];
  EXPECT_NEAR(area(c), 1, 1e-3);  // at the bend a corner is cut off
  ASSERT_GT(c.tear_points.size(), 20u);
  int on_line = 0, particles = 0;
  for (const auto& p : c.tear_points) {
    const double i = (p[0] + 0.5) * 11, j = -p[1] * 11;
    const double y = i < 5.1 ? 3.2 + (i + 1) * 1.5 / 6.1 : 4.7 + (i - 5.1) * 5.2 / 6.9;
    const bool whole = std::abs(i - std::round(i)) + std::abs(j - std::round(j)) < 1e-4;
    (whole ? particles : on_line) += 1;
    EXPECT_TRUE(whole || std::abs(j - y) < 2e-3) << i << " " << j;
  }
  EXPECT_GT(on_line, 20);
  EXPECT_GT(particles, 10);
}

TEST(Cuts, ASceneWithoutTheCutMakesItWholeAgain) {
  const Scene whole = sheet(16, {}), cut = sheet(16, {{{7.4, -1}, {7.4, 16}}});
  Simulation simulation(whole);
  advance(simulation, 0.1);
  const std::vector<double> before = simulation.positions();
  simulation.set_scene(cut);
  EXPECT_EQ(simulation.report().torn, 16 + 2 * 15 + 2 * 16);
  EXPECT_EQ(simulation.positions(), before);
  advance(simulation, 0.1);
  Scene two = cut;
  two.cloths[0].cuts.push_back({{-1, 8.6}, {16, 8.6}});
  simulation.set_scene(two);
  const auto torn = simulation.report().torn;
  simulation.set_scene(cut);
  EXPECT_LT(simulation.report().torn, torn);
  simulation.set_scene(whole);
  EXPECT_EQ(simulation.report().torn, 0);
}

// A cut of a caller's own stays.
TEST(Cuts, WhatTearsOtherwiseStaysTorn) {
  Simulation simulation(sheet(16, {{{7.4, -1}, {7.4, 16}}}));
  ASSERT_GT(simulation.cut({0.3, -0.5, -0.1}, {0.3, -0.5, 0.1}, 0.05), 0);
  const auto torn = simulation.report().torn;
  simulation.set_scene(sheet(16, {}));
  EXPECT_EQ(simulation.report().torn, torn - (16 + 2 * 15 + 2 * 16));
}

// What lies beside the sheet, or ends before its first edge, is told.
TEST(Cuts, OneThatCrossesNothingIsTold) {
  for (const auto& [cut, idle] : {std::pair(CutLine{{-3, -1}, {20, -1}}, true),
                                  {CutLine{{4.2, 4.2}, {4.4, 4.4}}, true},
                                  {CutLine{{4.2, 4.2}, {5.4, 4.4}}, false},
                                  {CutLine{{-0.5, 4.2}, {-0.1, 9}, {0.5, 9.5}}, false}}) {
    const auto notes = Simulation(sheet(16, {{{7.4, -1}, {7.4, 16}}, cut})).plan().notes;
    EXPECT_EQ(
        std::count(notes.begin(), notes.end(), "cloth 0: cut 1 passes between no two particles"),
        idle ? 1 : 0);
  }
}

}  // namespace
}  // namespace weft
