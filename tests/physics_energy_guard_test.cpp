// The energy guard by itself: what motion it allows, frame by frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "physics/frame/energy_guard.h"
#include "physics/step/threads.h"
#include "weft/simulation.h"

namespace weft::physics {
namespace {

constexpr double kDt = 1e-3, kGravity = 9.81;
constexpr int kSubsteps = 10;

// A soft sheet at rest, `height` above the origin, and its guard.
struct Guarded {
  explicit Guarded(double height, Method method = Method::compliant, double stiffness = 1) {
    scene.gravity = {0, -kGravity, 0};
    scene.solver.method = method;
    Cloth cloth;
    cloth.grid = {9, 7, {0, height, 0}, {0.8, 0, 0}, {0, 0, 0.6}, 0};
    cloth.particle_mass = 0.01;
    cloth.stiffness = {stiffness, stiffness, 0};
    scene.cloths.push_back(cloth);
    cloths.push_back(std::make_unique<ClothStep>(scene, 0, method, 1, kernel_table(Simd::best)));
    guard.open(scene, method, cloths, 0, kDt, threads);
  }
  Particles& particles() { return cloths[0]->particles(); }
  void set_speed(double speed) { set(particles().v, 0, float(speed)); }
  void drop_by(double way) {
    particles().for_each([&](int j, int i) { particles().x.at(1, j, i) -= float(way); });
  }
  bool next_frame() {
    guard.look(scene, cloths, false);
    const bool holds = guard.holds();
    guard.accept(kSubsteps);
    return holds;
  }
  void set(Rows& rows, int axis, float value) {
    particles().for_each([&](int j, int i) { rows.at(axis, j, i) = value; });
  }

  Scene scene;
  Threads threads{1};
  Cloths cloths;
  EnergyGuard guard;
};

// Where the origin is means nothing: only what a sheet has fallen is released.
TEST(EnergyGuard, TakesNoHeightForAFall) {
  for (const double height : {-50.0, 0.0, 50.0}) {
    Guarded sheet(height);
    for (int frame = 0; frame < 3; ++frame) EXPECT_TRUE(sheet.next_frame()) << height;
    sheet.set_speed(1);
    EXPECT_FALSE(sheet.next_frame()) << height;
  }
}

TEST(EnergyGuard, AllowsWhatAFallReleases) {
  Guarded sheet(3);
  double fallen = 0;
  for (int frame = 1; frame <= 20; ++frame) {
    const double fall = 0.5 * kGravity * std::pow(0.01 * frame, 2);
    sheet.drop_by(fall - fallen);
    fallen = fall;
    sheet.set_speed(kGravity * 0.01 * frame);
    EXPECT_TRUE(sheet.next_frame()) << frame;
  }
  // Four times the energy, and no more.
  sheet.set_speed(1.95 * std::sqrt(2 * kGravity * fallen));
  EXPECT_TRUE(sheet.next_frame());
  sheet.set_speed(2.05 * std::sqrt(2 * kGravity * fallen));
  EXPECT_FALSE(sheet.next_frame());
  EXPECT_NEAR(sheet.guard.reduction(), 2 / 2.05, 0.01);
}

// Springs of 100 kN/m heat up by the last place of positions, in time; soft ones do not, nor do
// constraints that are projected.
TEST(EnergyGuard, AllowsForRoundingWhereSpringsAreStiff) {
  const auto after_long = [](Method method, double stiffness) {
    Guarded sheet(0, method, stiffness);
    for (int frame = 0; frame < 20000; ++frame) sheet.next_frame();
    sheet.set_speed(0.04);
    return sheet.next_frame();
  };
  EXPECT_TRUE(after_long(Method::spring, 1e5));
  EXPECT_FALSE(after_long(Method::spring, 1));
  EXPECT_FALSE(after_long(Method::compliant, 1e5));
}

// Too few sweeps of stiff constraints make strain and motion: the note counts both, and is not there where neither is.
TEST(EnergyGuard, WhatSweepsMakeIsTold) {
  int told = 0, sound = 0;
  for (const double stiffness : {1e3, 1e5})
    for (const auto& [substeps, iterations] : {std::pair{64, 1}, {64, 4}, {24, 1}}) {
      Scene scene;
      scene.solver.method = Method::compliant;
      scene.solver.order = 2;
      scene.solver.iterations = iterations;
      scene.time.substeps = substeps;
      Cloth& cloth = scene.cloths.emplace_back();
      cloth.grid = {15, 12, {}, {0.7, 0, 0}, {0, 0, 0.55}, 0};
      cloth.stiffness = {stiffness, stiffness, 0};
      cloth.pins = {{0, 0, {}}, {14, 0, {}}};
      Simulation run(scene, {.threads = 1});
      const auto start = run.report(false).energy;
      double most = 0, given = 0;
      for (int frame = 0; frame < 90; ++frame) {
        run.advance_frame();
        const auto now = run.report(false).energy;
        given = std::max(given, start.gravity - now.gravity);
        most = std::max(most, now.kinetic + now.elastic);
      }
      const std::vector<std::string>& notes = run.plan().notes;
      const bool note = std::ranges::any_of(notes, [](const std::string& n) {
        return n.find("nothing put in: with the motion") != n.npos;
      });
      // Looks are eight frames apart.
      EXPECT_TRUE(note || most < 3 * given) << stiffness << ", " << substeps << ", " << iterations;
      EXPECT_TRUE(!note || most > 1.9 * given)
          << stiffness << ", " << substeps << ", " << iterations;
      told += note;
      sound += most < 1.1 * given;
    }
  EXPECT_GT(told, 0);
  EXPECT_GT(sound, 0);
}

// What a sheet holds that begins stretched is worth more to shorter substeps, and to other sweeps, than to those that it
// began with: a frame that runs again by these takes none of its motion for made.
TEST(EnergyGuard, WhatBeginsStretchedKeepsItsMomentum) {
  int refined = 0;
  for (const int substeps : {1, 2, 3, 8})
    for (const int order : {1, 2})
      for (const Sweep sweep : {Sweep::line, Sweep::gauss_seidel})
        for (const double stretch : {1.05, 1.15, 1.3}) {
          Scene scene;
          scene.gravity = {};
          scene.solver.method = Method::compliant;
          scene.solver.order = order;
          scene.solver.sweep = sweep;
          scene.time.substeps = substeps;
          Cloth& cloth = scene.cloths.emplace_back();
          cloth.grid = {17, 13, {}, {0.5, 0, 0}, {0, 0, 0.4}, 0};
          cloth.drag = 0;
          cloth.stiffness = {1000, 500, 0};
          Simulation run(scene, {.threads = 1});
          std::vector<double> x = run.positions(), v(x.size());
          for (std::size_t n = 0; n < x.size(); ++n) {
            if (n % 3 == 0) x[n] *= stretch;
            v[n] = double(n % 3 == 0) + 0.2 * std::sin(7.0 * double(n));
          }
          run.set_state(x, v);
          const Vec3 before = run.report(false).momentum;
          for (int frame = 0; frame < 4; ++frame) run.advance_frame();
          const Vec3 after = run.report(false).momentum;
          for (int k = 0; k < 3; ++k)
            EXPECT_NEAR(after[k], before[k], 1e-5 * before[0])
                << substeps << " substeps, order " << order << ", sweep " << int(sweep) << ", "
                << stretch;
          refined += run.plan().substeps > substeps;
        }
  EXPECT_GT(refined, 0);
}

}  // namespace
}  // namespace weft::physics
