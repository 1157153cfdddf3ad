// The same sheet on other grids: what is held, what it weighs, where it is cut, and how it moves.
#include "weft/resolution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <utility>

#include "weft/simulation.h"

namespace weft {
namespace {

Cloth sheet(int nx, int ny) {
  Cloth cloth;
  cloth.grid = {nx, ny, {1, 2, 3}, {1.5, 0, 0.2}, {0, 0.1, 0.8}, 0};
  return cloth;
}

using Particles = std::set<std::pair<int, int>>;

Particles held(const Cloth& cloth) {
  Particles all;
  for (const Pin& pin : single_pins(cloth)) EXPECT_TRUE(all.emplace(pin.i, pin.j).second);
  return all;
}

TEST(Resolution, WhatIsHeldKeepsItsPlaceOnTheSheet) {
  for (const int times : {2, 3, 5}) {
    Cloth cloth = sheet(9, 5);
    cloth.pins = {{0, 0, {}}, {8, 4, {}}};                          // corners
    for (int i = 2; i <= 4; ++i) cloth.pins.push_back({i, 2, {}});  // a line
    for (int i = 6; i <= 8; ++i)                                    // a patch
      for (int j = 0; j <= 1; ++j) cloth.pins.push_back({i, j, {}});
    const RegriddedCloth fine = with_intervals(cloth, {8 * times, 4 * times});
    EXPECT_TRUE(fine.notes.empty());
    Particles expected{{0, 0}, {8 * times, 4 * times}};
    for (int i = 2 * times; i <= 4 * times; ++i) expected.emplace(i, 2 * times);
    for (int i = 6 * times; i <= 8 * times; ++i)
      for (int j = 0; j <= times; ++j) expected.emplace(i, j);
    EXPECT_EQ(held(fine.cloth), expected) << times;
    EXPECT_EQ(held(with_intervals(fine.cloth, {8, 4}).cloth), held(cloth)) << times;
  }
}

TEST(Resolution, TheLeastIntervalsHaveAParticleWhereverOneIsHeld) {
  Cloth cloth = sheet(13, 9);
  EXPECT_EQ(intervals_of_pins(cloth), (Intervals{1, 1}));
  cloth.pins = {{0, 0, {}}, {12, 8, {}}};
  EXPECT_EQ(intervals_of_pins(cloth), (Intervals{1, 1}));
  cloth.pins.push_back({6, 2, {}});
  EXPECT_EQ(intervals_of_pins(cloth), (Intervals{2, 4}));
  EXPECT_TRUE(with_intervals(cloth, {2, 4}).notes.empty());
  EXPECT_EQ(held(with_intervals(cloth, {2, 4}).cloth), (Particles{{0, 0}, {2, 4}, {1, 1}}));
  // A third of a spacing off, and told.
  const RegriddedCloth other = with_intervals(cloth, {5, 4});
  ASSERT_EQ(other.notes.size(), 1u);
  EXPECT_NE(other.notes[0].find("up to 0.5 spacings"), std::string::npos) << other.notes[0];
}

// Each on a path of its own, a turn of the whole side: those between go between.
TEST(Resolution, PathsBetweenHeldNeighboursAreThoseBetweenThem) {
  Cloth cloth = sheet(5, 5);
  const auto pin = [&](const Grid& grid, int i, double share) {
    const Vec3 start = place_on(grid, i, 0);
    return Pin{i, 0, {{0.5, start}, {2, plus(start, {share, 3 * share, 1 - share})}}};
  };
  for (int i = 0; i < 5; ++i) cloth.pins.push_back(pin(cloth.grid, i, i / 4.0));
  for (const int intervals : {3, 4, 8, 10}) {
    const Cloth other = with_intervals(cloth, {intervals, 4}).cloth;
    ASSERT_EQ(int(other.pins.size()), intervals + 1);
    for (const Pin& p : other.pins) {
      const Pin expected = pin(other.grid, p.i, p.i / double(intervals));
      ASSERT_EQ(p.keys.size(), 2u);
      for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(p.keys[k].time, expected.keys[k].time);
        EXPECT_LT(distance(p.keys[k].position, expected.keys[k].position), 1e-12)
            << intervals << ' ' << p.i;
      }
    }
  }
  // At other times, neighbours are held one by one.
  cloth.pins[2].keys[0].time = 0.25;
  EXPECT_EQ(held(with_intervals(cloth, {8, 4}).cloth),
            (Particles{{0, 0}, {1, 0}, {2, 0}, {4, 0}, {6, 0}, {7, 0}, {8, 0}}));
}

// Several on one particle of a coarser grid: it goes along one path, and a note counts the others, but for those that
// it shares or that neighbours say.
TEST(Resolution, PathsThatAreLeftOutAreTold) {
  const auto notes = [](const std::vector<std::vector<double>>& heights, int intervals,
                        double second_time = 1) {
    Cloth cloth = sheet(17, 5);
    for (std::size_t n = 0; n < heights.size(); ++n) {
      const int i = int(heights[n][0]);
      const Vec3 start = place_on(cloth.grid, i, 0);
      cloth.pins.push_back({i, 0, {{0, start}, {1, plus(start, {0, heights[n][1], 0})}}});
      if (n == 1) cloth.pins.back().keys[1].time = second_time;
    }
    const RegriddedCloth other = with_intervals(cloth, {intervals, 4});
    std::string said;
    for (const std::string& note : other.notes)
      if (note.find("left out") != note.npos) said += note;
    return said;
  };
  const auto left_out = [](int count) {
    return "the paths of " + std::to_string(count) +
           " held particles are left out: others hold the same particles of its grid";
  };
  const std::vector<std::vector<double>> apart{{3, 0.1}, {5, -0.1}};
  EXPECT_EQ(notes(apart, 4), left_out(1));
  EXPECT_EQ(notes(apart, 2), "");  // one each
  EXPECT_EQ(notes(apart, 16), "");
  EXPECT_EQ(notes(apart, 32), "");
  EXPECT_EQ(notes({{3, 0.1}, {5, 0.1}}, 4), "");
  EXPECT_EQ(notes({{3, 0.1}, {5, 0.1}}, 4, 2), left_out(1));  // later
  // Along a line: straight ones are sampled; a peak between two particles of the coarser grid is lost.
  EXPECT_EQ(notes({{0, 0}, {1, 0.1}, {2, 0.2}, {3, 0.3}, {4, 0.4}}, 4), "");
  EXPECT_EQ(notes({{0, 0}, {1, 0}, {2, 0.5}, {3, 0}, {4, 0}}, 4), left_out(1));
  EXPECT_EQ(notes({{0, 0}, {1, 0}, {2, 0.5}, {3, 0}, {4, 0}}, 16), "");
}

double mass_of(const Cloth& cloth) {
  double sum = 0;
  for (int j = 0; j < cloth.grid.ny; ++j)
    for (int i = 0; i < cloth.grid.nx; ++i) sum += particle_mass(cloth, i, j);
  return sum;
}

TEST(Resolution, ASheetKeepsItsMassAndItsCuts) {
  Cloth by_density = sheet(13, 9);
  by_density.cuts = {{{-1, 4}, {13, 4}}, {{6, 2}, {9, 8}}};
  Cloth by_particle = by_density, heavier_along_u = by_density;
  by_particle.particle_mass = 0.004;
  for (int n = 0; n < 13 * 9; ++n) heavier_along_u.masses.push_back(0.001 * (1 + n % 13));
  for (const Intervals intervals : {Intervals{4, 7}, {12, 8}, {25, 3}}) {
    for (const Cloth& cloth : {by_density, by_particle, heavier_along_u}) {
      const Cloth other = with_intervals(cloth, intervals).cloth;
      EXPECT_NEAR(mass_of(other), mass_of(cloth), 1e-12 * mass_of(cloth));
      for (std::size_t c = 0; c < cloth.cuts.size(); ++c)
        for (std::size_t k = 0; k < 2; ++k) {
          EXPECT_NEAR(other.cuts[c][k][0] / intervals.u, cloth.cuts[c][k][0] / 12, 1e-12);
          EXPECT_NEAR(other.cuts[c][k][1] / intervals.v, cloth.cuts[c][k][1] / 8, 1e-12);
        }
    }
    const Cloth other = with_intervals(heavier_along_u, intervals).cloth;
    EXPECT_GT(particle_mass(other, intervals.u, 0), 5 * particle_mass(other, 0, 0));
  }
}

// Twice as fine, a sheet held along a side comes a quarter as far from where it comes in the limit.
TEST(Resolution, FinerGridsOfASheetApproachEachOther) {
  Scene scene;
  scene.gravity = {2, -9, 3};
  Cloth cloth;
  cloth.grid = {9, 9, {0, 0, 0}, {1, 0, 0}, {0, 0, 1}, 0};
  cloth.stiffness = {1000, 500, 0};
  cloth.bending = 1e-3;
  cloth.drag = 1;
  for (int j = 0; j < 9; ++j) cloth.pins.push_back({0, j, {}});
  std::vector<std::vector<double>> corners;
  for (const int n : {8, 16, 32, 64}) {
    scene.cloths = {with_intervals(cloth, {n, n}).cloth};
    Simulation simulation(scene, {.threads = 1});
    for (int frame = 0; frame < 30; ++frame) simulation.advance_frame();
    const std::vector<double> positions = simulation.positions();
    corners.emplace_back(positions.end() - 3, positions.end());
  }
  const auto apart = [&](std::size_t a, std::size_t b) {
    return std::hypot(corners[a][0] - corners[b][0], corners[a][1] - corners[b][1],
                      corners[a][2] - corners[b][2]);
  };
  EXPECT_GT(apart(1, 2) / apart(2, 3), 3.2);
  EXPECT_LT(apart(1, 2) / apart(2, 3), 5.5);
}

}  // namespace
}  // namespace weft
