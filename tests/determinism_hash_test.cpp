// The same bits for any number of threads, for every instruction set, from run to run, and after
// the state has been taken out and put back.
#include <gtest/gtest.h>

#include <algorithm>

#include "machines.h"
#include "weft/read_scene.h"
#include "weft/simulation.h"

namespace weft {
namespace {

// `huge` has a test of its own (slow_huge_test.cpp).
std::vector<std::string> scene_names(const std::vector<std::string>& but = {"huge"}) {
  std::vector<std::string> names;
  for (const ShippedScene& scene : shipped_scenes())
    if (std::find(but.begin(), but.end(), scene.name) == but.end()) names.push_back(scene.name);
  return names;
}

constexpr int kFrames = 3;

std::uint64_t hash_of(const Scene& scene, const Options& options = {}, int frames = kFrames) {
  Simulation simulation(scene, options);
  for (int frame = 0; frame < frames; ++frame) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  return simulation.hash();
}

Options threads(int count) {
  Options options;
  options.threads = count;
  return options;
}

void expect_one_result(const Scene& scene) {
  std::uint64_t expected = 0;
  for (const Options& options : machines()) {
    const std::uint64_t hash = hash_of(scene, options);
    if (expected == 0) expected = hash;
    EXPECT_EQ(hash, expected) << simd_name(options.simd) << ", " << options.threads << " threads";
  }
}

class Shipped : public testing::TestWithParam<std::string> {};

TEST_P(Shipped, HasOneResult) {
  expect_one_result(read_scene(GetParam()).scene);
}

// From a snapshot on there is one way, whatever was before: for what has run longer, and what is new.
class Snapshots : public testing::TestWithParam<std::string> {};

TEST_P(Snapshots, GoOnInOneWay) {
  const Scene scene = read_scene(GetParam()).scene;
  const auto run = [](Simulation& simulation, int frames) {
    for (int frame = 0; frame < frames; ++frame) simulation.advance_frame();
    EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  };
  Simulation old(scene, threads(1)), fresh(scene, threads(2));
  run(old, 10);
  const Snapshot snapshot = old.snapshot();
  run(old, 4);
  for (Simulation* simulation : {&old, &fresh}) {
    simulation->restore(snapshot);
    run(*simulation, 4);
  }
  EXPECT_EQ(old.hash(), fresh.hash());
  EXPECT_EQ(old.velocities(), fresh.velocities());
}

INSTANTIATE_TEST_SUITE_P(, Shipped, testing::ValuesIn(scene_names()),
                         [](const auto& test) { return test.param; });
// But for the larger of two alike.
INSTANTIATE_TEST_SUITE_P(, Snapshots, testing::ValuesIn(scene_names({"huge", "fold316"})),
                         [](const auto& test) { return test.param; });

// Large enough to be shared out by every method, even in frames of ten substeps (passes.cpp).
Scene large_sheet(Method method) {
  Cloth cloth;
  cloth.grid = {141, 131, {0, 0, 0}, {1, 0, 0}, {0, 0, 1.2}, 0.0015};
  cloth.drag = 0.5;
  cloth.strain_limit = 0.1;
  cloth.stiffness_gradient = 0.2;
  cloth.pins = {{0, 0, {}}, {140, 0, {{0, {1, 0, 0}}, {0.1, {0.9, 0.1, 0}}}}};
  Scene scene;
  scene.cloths = {cloth};
  scene.solver.method = method;
  scene.time = {0.01, kAutoSubsteps, 1};
  Collider ball;
  ball.shape = Sphere{{0.5, -0.05, 0.6}, 0.1};
  ball.friction.statik = ball.friction.dynamic = 0.3;
  ball.keys = {{0, {0.5, -0.11, 0.6}}, {0.1, {0.5, 0.1, 0.6}}};
  scene.colliders = {ball};
  return scene;
}

struct Variant {
  std::string name;
  Method method;
  Sweep sweep = Sweep::gauss_seidel;
  int iterations = 1, level = 0;
  double bending = 0;
  StrainLimitOrder limit = StrainLimitOrder::colours;
};

class LargeSheet : public testing::TestWithParam<Variant> {};

TEST_P(LargeSheet, HasOneResult) {
  Scene scene = large_sheet(GetParam().method);
  scene.solver.sweep = GetParam().sweep;
  scene.solver.iterations = GetParam().iterations;
  scene.cloths[0].level = GetParam().level;
  scene.cloths[0].bending = GetParam().bending;
  scene.cloths[0].strain_limit_order = GetParam().limit;
  scene.cloths[0].spring_damping = {0.001, 0.001, 0.001};
  expect_one_result(scene);
}

INSTANTIATE_TEST_SUITE_P(
    , LargeSheet,
    testing::Values(Variant{"spring", Method::spring},
                    Variant{"spring_level", Method::spring, Sweep::gauss_seidel, 1, 3},
                    Variant{"spring_friction", Method::spring_friction},
                    Variant{"course_limit", Method::spring, Sweep::gauss_seidel, 1, 0, 0,
                            StrainLimitOrder::course},
                    Variant{"held_limit", Method::spring, Sweep::gauss_seidel, 1, 0, 0,
                            StrainLimitOrder::strict},
                    Variant{"compliant_held_limit", Method::compliant, Sweep::gauss_seidel, 2, 2, 0,
                            StrainLimitOrder::strict},
                    Variant{"positional", Method::positional, Sweep::gauss_seidel, 2},
                    Variant{"positional_jacobi", Method::positional, Sweep::jacobi, 2},
                    Variant{"compliant", Method::compliant, Sweep::gauss_seidel, 3},
                    Variant{"compliant_level", Method::compliant, Sweep::gauss_seidel, 1, 2},
                    Variant{"compliant_jacobi", Method::compliant, Sweep::jacobi, 3},
                    Variant{"compliant_line", Method::compliant, Sweep::line, 2, 0, 1e-5},
                    Variant{"positional_line", Method::positional, Sweep::line, 1, 2}),
    [](const auto& test) { return test.param.name; });

// Small enough for a thread each, and together worth several, beside one that is worth them all.
TEST(Sheets, HaveOneResultSideBySide) {
  for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line}) {
    Scene scene = large_sheet(sweep == Sweep::line ? Method::compliant : Method::spring);
    scene.solver.sweep = sweep;
    scene.time.substeps = 40;
    const Cloth large = scene.cloths[0];
    scene.cloths.clear();
    for (int n = 0; n < 5; ++n) {
      Cloth small = large;
      small.grid = {30 + 5 * n, 40, {0, 0.2 * n, 0}, {1, 0, 0}, {0, 0, 1.2}, 0.002};
      small.pins = {{0, 0, {}}};
      small.tear_strain = n == 2 ? 0.02 : 0;
      scene.cloths.push_back(small);
      if (n == 3) scene.cloths.push_back(large);
    }
    expect_one_result(scene);
  }
}

TEST_P(LargeSheet, GoesOnFromItsOwnState) {
  if (GetParam().method == Method::spring_friction)
    GTEST_SKIP() << "forces of the damping depend on velocities half a substep apart";
  Scene scene = large_sheet(GetParam().method);
  scene.solver.sweep = GetParam().sweep;
  scene.solver.iterations = GetParam().iterations;
  scene.cloths[0].level = GetParam().level;
  scene.cloths[0].bending = GetParam().bending;
  // Forces that hold a limit are none of what is set, and begin anew.
  scene.cloths[0].strain_limit_order = StrainLimitOrder::colours;
  Simulation simulation(scene);
  for (int frame = 0; frame < kFrames; ++frame) {
    simulation.advance_frame();
    const std::uint64_t before = simulation.hash();
    simulation.set_state(simulation.positions(), simulation.velocities());
    EXPECT_EQ(simulation.hash(), before);
  }
  EXPECT_EQ(simulation.hash(), hash_of(scene));
}

TEST(Seed, MattersWhereThereIsJitter) {
  Options other;
  other.seed = 2;
  for (const bool rough : {true, false}) {
    Scene scene = large_sheet(Method::spring);
    if (!rough) scene.cloths[0].grid.jitter = 0;
    EXPECT_EQ(hash_of(scene, {}, 1) != hash_of(scene, other, 1), rough);
  }
  const Scene upright = read_scene("selfCollision").scene;
  EXPECT_NE(hash_of(upright, {}, 0), hash_of(upright, other, 0));
}

}  // namespace
}  // namespace weft
