// Nothing explodes: a sweep over settings for every method, the explosions that the seeds tell of, and
// random settings. bench/stress is the long form.
#include <gtest/gtest.h>

#include "../bench/stress_case.h"
#include "weft/random.h"
#include "weft/simulation.h"

namespace weft {
namespace {

using bench::Fate;
using bench::Start;
using bench::StressCase;

void expect_bounded(const StressCase& c, const std::string& what) {
  const bench::Verdict v = bench::run_stress(c);
  EXPECT_LT(int(v.fate), int(Fate::unbounded))
      << what << ", " << start_name(c.start) << ": " << fate_name(v.fate) << ", energy " << v.energy
      << "-fold of what was put in; " << v.why;
}

TEST(Stress, RandomSettingsStayBoundedOrAreRefused) {
  int refused = 0;
  for (std::uint64_t n = 0; n < 50; ++n) {
    const StressCase c = bench::random_case(n);
    refused += !validate(c.scene).empty();
    expect_bounded(c, "case " + std::to_string(n));
  }
  EXPECT_LT(refused, 15);
}

StressCase curtain(Method method, Sweep sweep, double stiffness, int substeps, Start start) {
  StressCase c;
  c.scene = bench::stress_sheet(9, 0.15, 0.1, true);
  c.scene.cloths[0].level = 2;
  c.scene.cloths[0].stiffness = {stiffness, 0, 0};
  c.scene.solver.method = method;
  c.scene.solver.sweep = sweep;
  c.scene.time.substeps = substeps;
  c.start = start;
  return c;
}

TEST(Stress, EveryMethodStaysBoundedFromEveryStart) {
  using enum Method;
  using enum Sweep;
  const std::pair<Method, Sweep> all[] = {
      {spring, gauss_seidel},    {spring_friction, gauss_seidel},
      {compliant, gauss_seidel}, {compliant, jacobi},
      {compliant, line},         {positional, gauss_seidel},
      {positional, jacobi},      {positional, line}};
  for (const auto& [method, sweep] : all)
    for (const Start start : bench::kStarts)
      for (const double stiffness : {0.1, 1e3, 1e7})
        for (const int substeps : {1, 20})
          expect_bounded(curtain(method, sweep, stiffness, substeps, start),
                         std::to_string(int(method)) + std::to_string(int(sweep)) + ", " +
                             std::to_string(stiffness) + " N/m, " + std::to_string(substeps) +
                             " substeps");
}

// The bound tells an explosion: the same start without a stability limit passes it by far.
TEST(Stress, TheCourseStyleSolverExplodes) {
  StressCase c = curtain(Method::spring, Sweep::gauss_seidel, 1e4, 1, Start::inside);
  EXPECT_GE(int(bench::run_course_stress(c).fate), int(Fate::unbounded));
}

// A soft sheet hangs, under a fixed substep just inside the limit of the flat one: the stretch that
// its weight makes needs a smaller one, which the plan tells.
TEST(Stress, AStretchThatOutgrowsAFixedSubstepIsNoticed) {
  StressCase c = curtain(Method::spring, Sweep::gauss_seidel, 100, 1, Start::flat);
  const double limit = Simulation(c.scene).plan().dt_limit;
  c.scene.time.frame = 20 * 0.98 * limit;
  c.scene.time.substeps = 20;
  EXPECT_EQ(bench::run_stress(c).fate, Fate::saved);
}

// All particles in one point, springs of the greatest stiffness: what is kept is the bound, not the
// motion, but nothing stops.
TEST(Stress, AFrameThatGainsEnergyIsRunAgain) {
  StressCase c =
      curtain(Method::spring, Sweep::gauss_seidel, 1e4, kAutoSubsteps, Start::coincident);
  // As near to the limit as may be.
  c.scene.time.substeps = int(std::ceil(c.scene.time.frame / Simulation(c.scene).plan().dt_limit));
  const bench::Verdict v = bench::run_stress(c);
  EXPECT_EQ(v.fate, Fate::saved);
  EXPECT_LT(v.energy, bench::kBound);
}

// Substeps of two microseconds, which single precision hardly resolves, and no room for smaller ones.
TEST(Stress, WhatNoSubstepResolvesGoesOnByTheCompliantMethod) {
  for (const std::uint64_t n : {67, 649, 1640, 2118}) {
    const bench::Verdict v = bench::run_stress(bench::random_case(n));
    EXPECT_EQ(v.fate, Fate::saved) << n << ": " << fate_name(v.fate) << " " << v.why;
    EXPECT_LT(v.energy, bench::kBound) << n;
  }
}

// A run that goes back to an earlier snapshot begins with the springs that the scene asks for.
TEST(Stress, SpringsComeBackWithAnEarlierSnapshot) {
  const Scene scene = bench::random_case(2118).scene;
  Simulation simulation(scene);
  const auto runs_springs = [&] {
    const auto& stages = simulation.plan().stages;
    return std::any_of(stages.begin(), stages.end(),
                       [](const auto& s) { return s.name == "springs"; });
  };
  std::vector<double> x = simulation.positions();
  for (std::size_t k = 3 * std::size_t(scene.cloths[0].grid.nx); k < x.size(); ++k)
    x[k] = 1e-3 * double(k % 3);
  simulation.set_state(x, std::vector<double>(x.size(), 0));
  const Snapshot start = simulation.snapshot();
  std::uint64_t hashes[2];
  for (std::uint64_t& hash : hashes) {
    EXPECT_TRUE(runs_springs());
    for (int f = 0; f < 5; ++f) simulation.advance_frame();
    EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
    EXPECT_FALSE(runs_springs());
    hash = simulation.hash();
    simulation.restore(start);
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

// One sweep for each of 8 substeps is far too few for 64 rows, which stretch to several lengths; a
// stretched sheet resists sideways too, and has the largest eigenvalues.
TEST(Stress, TooFewJacobiSweepsStretchASheetAndNothingElse) {
  for (const double shear : {0.0, 1000.0}) {
    Scene scene = bench::stress_sheet(64, 1.0 / 63, 0.3 / (64 * 64), true);
    scene.cloths[0].stiffness = {1e4, shear, 0};
    scene.solver.method = Method::positional;
    scene.solver.sweep = Sweep::jacobi;
    scene.time.substeps = 8;
    Simulation simulation(scene);
    for (int frame = 0; frame < 90; ++frame) simulation.advance_frame();
    EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
    EXPECT_LT(simulation.report().strain.max, 10);
    EXPECT_LT(simulation.report().energy.kinetic, 100);
  }
}

TEST(Stress, JacobiSweepsOfUnequalMassesGiveWay) {
  Scene scene = bench::stress_sheet(5, 0.1, 0.1, false);
  scene.solver.method = Method::compliant;
  scene.solver.sweep = Sweep::jacobi;
  EXPECT_FALSE(Simulation(scene).plan().fallback);
  scene.cloths[0].masses.assign(25, 1e-3);
  scene.cloths[0].masses[12] = 1;
  EXPECT_TRUE(Simulation(scene).plan().fallback);
}

}  // namespace
}  // namespace weft
