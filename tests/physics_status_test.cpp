// What a simulation tells about itself: the plan, the memory it holds, and why it stopped.
#include <gtest/gtest.h>

#include <algorithm>

#include "sheets.h"

namespace weft {
namespace {

Scene sheet(Method method = Method::spring) {
  Scene scene;
  scene.cloths.emplace_back();
  scene.cloths[0].grid.nx = 20;
  scene.cloths[0].grid.ny = 10;
  scene.solver.method = method;
  scene.time.substeps = method == Method::spring ? kAutoSubsteps : 20;
  return scene;
}

int stages_named(const Simulation& simulation, const std::string& name) {
  const auto& stages = simulation.plan().stages;
  return int(std::count_if(stages.begin(), stages.end(),
                           [&](const PlannedStage& s) { return s.name == name; }));
}
bool skipped(const Simulation& simulation, const std::string& name) {
  const auto& all = simulation.plan().skipped;
  return std::any_of(all.begin(), all.end(), [&](const SkippedStage& s) { return s.name == name; });
}

TEST(Plan, HoldsOnlyWhatTheSceneNeeds) {
  Scene scene = sheet();
  const Simulation plain(scene);
  ASSERT_EQ(plain.plan().stages.size(), 1u);
  EXPECT_EQ(plain.plan().stages[0].name, "springs");
  for (const char* name : {"keyed_pins", "collider", "strain_limit"}) {
    EXPECT_EQ(stages_named(plain, name), 0) << name;
    EXPECT_TRUE(skipped(plain, name)) << name;
  }
  scene.cloths[0].pins = {{0, 0, {{0, {0, 0, 0}}, {1, {0, 1, 0}}}}};
  scene.cloths[0].strain_limit = 0.1;
  scene.colliders.resize(2);
  scene.colliders[0].shape = Sphere{};
  scene.colliders[1].shape = Plane{};
  scene.solver.collision_iterations = 3;
  const Simulation full(scene);
  EXPECT_EQ(stages_named(full, "keyed_pins"), 1);
  EXPECT_EQ(stages_named(full, "collider"), 6);
  EXPECT_GT(stages_named(full, "strain_limit"), 0);
  for (const char* name : {"keyed_pins", "collider", "strain_limit"})
    EXPECT_FALSE(skipped(full, name)) << name;
  EXPECT_EQ(stages_named(Simulation(sheet(Method::compliant)), "springs"), 0);
}

TEST(Plan, CountsWhatEachStageTouches) {
  const Simulation simulation(sheet());
  const PlannedStage& springs = simulation.plan().stages[0];
  EXPECT_EQ(springs.items, 19 * 10 + 20 * 9 + 2 * 19 * 9 + 18 * 10 + 20 * 8);
  EXPECT_EQ(springs.calls_per_frame, simulation.substeps());
  EXPECT_NEAR(simulation.dt() * simulation.substeps(), simulation.scene().time.frame, 1e-12);
  EXPECT_LT(simulation.dt(), simulation.plan().dt_limit);
}

TEST(Plan, PutsAStableMethodInThePlaceOfAnUnstableOne) {
  Scene scene = sheet();
  scene.time.substeps = 1;
  Simulation simulation(scene);
  ASSERT_FALSE(simulation.plan().notes.empty());
  EXPECT_NE(simulation.plan().notes[0].find("compliant"), std::string::npos);
  EXPECT_EQ(stages_named(simulation, "springs"), 0);
  for (int frame = 0; frame < 60; ++frame) simulation.advance_frame();
  EXPECT_TRUE(simulation.status().ok);
  EXPECT_LT(simulation.report().energy.kinetic, 1e3);
}

double bytes(const Scene& scene) {
  return Simulation(scene).bytes_per_particle();
}

TEST(Memory, IsHeldOnlyForWhatIsInUse) {
  Scene compliant = sheet(Method::compliant);
  Scene several = compliant;
  several.solver.iterations = 2;
  EXPECT_LT(bytes(compliant), bytes(several));  // multipliers
  Scene fixed = sheet();
  fixed.time.substeps = Simulation(fixed).substeps();
  EXPECT_EQ(bytes(fixed), bytes(sheet()));    // a change of substep needs none
  EXPECT_LT(bytes(fixed), bytes(compliant));  // positions before the substep
  Scene pinned = fixed;
  pinned.cloths[0].pins = {{0, 0, {}}};
  pinned.cloths[0].stiffness_gradient = 0.5;
  pinned.colliders.resize(1);
  EXPECT_EQ(bytes(pinned), bytes(fixed));
}

// Pins drawn apart break any limit: one note tells of the first frame in which it does not hold, and of the worst.
TEST(StrainLimit, TheFrameInWhichItFailsIsToldOf) {
  for (const Method method : {Method::spring, Method::compliant, Method::positional})
    for (const double pulled : {0.0, 0.4}) {
      Scene scene = sheet(method);
      scene.gravity = {0, 0, 0};
      scene.cloths[0].strain_limit = 0.1;
      scene.cloths[0].pins = {{0, 0, {}}, {19, 0, {{0.1, {1, 0, 0}}, {0.3, {1 + pulled, 0, 0}}}}};
      Simulation simulation(scene);
      const auto told = [&] {
        const std::vector<std::string> notes = simulation.plan().notes;
        return std::count_if(notes.begin(), notes.end(), [](const std::string& note) {
          return note.find("strain limit of 0.1 did not hold in frame") != std::string::npos;
        });
      };
      advance(simulation, 0.1);
      EXPECT_EQ(told(), 0) << int(method);
      double greatest = 0;
      while (simulation.time() < 0.5 - 1e-9) {
        simulation.advance_frame();
        greatest = std::max(greatest, simulation.report().strain.max);
      }
      EXPECT_EQ(told(), pulled > 0 ? 1 : 0) << int(method);
      EXPECT_EQ(greatest > 0.101, pulled > 0) << int(method);
      if (pulled == 0) continue;
      const std::string note = simulation.plan().notes.back();
      EXPECT_NE(note.find(", nor in "), std::string::npos) << note;
      const double worst = std::stod(note.substr(note.find('(') + 1));
      EXPECT_NEAR(worst / greatest, 1, 1e-3) << note;
    }
}

// Velocities that carry particles out of the world within the frame.
void drive_out(Simulation& simulation, int i, int j) {
  const std::vector<double> x = simulation.positions();
  std::vector<double> v(x.size(), 0.0);
  v[3 * std::size_t(j * simulation.scene().cloths[0].grid.nx + i) + 1] = 1e30;
  simulation.set_state(x, v);
}

TEST(NonFinite, StopsAndNamesThePlaceAndKeepsTheLastGoodState) {
  for (const Method method : {Method::spring, Method::positional, Method::compliant}) {
    Simulation simulation(sheet(method));
    simulation.advance_frame();
    simulation.advance_frame();
    drive_out(simulation, 13, 4);
    const std::uint64_t good = simulation.hash();
    const std::vector<double> velocities = simulation.velocities();
    simulation.advance_frame();
    const Status& status = simulation.status();
    EXPECT_FALSE(status.ok);
    EXPECT_EQ(status.frame, 3);
    EXPECT_EQ(status.stage, method == Method::spring ? "springs" : "predict");
    EXPECT_EQ(status.cloth, 0);
    EXPECT_EQ(status.particle, particle_number(simulation.scene().cloths[0].grid, 13, 4));
    EXPECT_NE(status.text.find("[13,4]"), std::string::npos) << status.text;
    EXPECT_EQ(simulation.hash(), good);
    EXPECT_EQ(simulation.velocities(), velocities);
    EXPECT_EQ(simulation.frame(), 2);
    EXPECT_FALSE(simulation.report().finite);
    simulation.advance_frame();  // does nothing any more
    EXPECT_EQ(simulation.frame(), 2);
    EXPECT_EQ(simulation.hash(), good);
  }
}

TEST(NonFinite, StateIsRefused) {
  Simulation simulation(sheet());
  std::vector<double> x = simulation.positions();
  const std::vector<double> v(x.size(), 0.0);
  const std::uint64_t before = simulation.hash();
  x[7] = std::nan("");
  EXPECT_THROW(simulation.set_state(x, v), std::invalid_argument);
  x[7] = 1e300;  // finite, but not as a float
  EXPECT_THROW(simulation.set_state(x, v), std::invalid_argument);
  EXPECT_THROW(simulation.set_state(v, std::vector<double>(5)), std::invalid_argument);
  EXPECT_EQ(simulation.hash(), before);
}

}  // namespace
}  // namespace weft
