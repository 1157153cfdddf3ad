// What a plan tells before anything moves: what runs, what does nothing, what single precision does not carry.
#include <gtest/gtest.h>

#include <algorithm>

#include "mesh_scenes.h"
#include "weft/estimate.h"

namespace weft {
namespace {

enum class Sheet { grid, mesh };

// 0.4 m wide, of 5 x 5 particles.
Scene sheet(Sheet kind) {
  Scene scene;
  if (kind == Sheet::mesh) {
    scene = scene_of(made_up({.nx = 5, .ny = 5, .shift = 0}));
    const std::vector<Vec3> x = placed_vertices(scene.cloths[0].mesh);
    const auto [least, most] = std::minmax_element(
        x.begin(), x.end(), [](const Vec3& a, const Vec3& b) { return a[0] < b[0]; });
    scene.cloths[0].mesh.scale = 0.4 / ((*most)[0] - (*least)[0]);
  } else {
    scene.cloths.emplace_back().grid = {5, 5, {}, {0.4, 0, 0}, {0, 0, 0.4}};
  }
  return scene;
}

std::string told(const Plan& plan, const std::string& words) {
  for (const std::string& note : plan.notes)
    if (note.find(words) != std::string::npos) return note;
  return "";
}

// A family of constraints is among what runs, or left out with a reason.
TEST(StartNotes, EveryFamilyIsNamed) {
  int ways = 0;
  for (const Sheet kind : {Sheet::grid, Sheet::mesh})
    for (const Method method :
         {Method::spring, Method::spring_friction, Method::compliant, Method::positional})
      for (const Sweep sweep : {Sweep::gauss_seidel, Sweep::line, Sweep::jacobi})
        for (const bool membrane : {false, true})
          for (const bool springs : {false, true})
            for (const bool bends : {false, true}) {
              Scene scene = sheet(kind);
              scene.solver.method = method;
              scene.solver.sweep = sweep;
              Cloth& cloth = scene.cloths[0];
              if (membrane) cloth.membrane = kCanvas;
              if (!membrane && !springs) cloth.stiffness.structural = 0;
              if (!membrane && !springs && kind == Sheet::grid) cloth.stiffness = {};
              if (bends) cloth.bending = 1e-3;
              cloth.pins = {{0, 0, {}}};
              if (!validate(scene).empty() || (membrane && !springs)) continue;
              const Simulation run(scene, {.threads = 1});
              const Plan& plan = run.plan();
              const auto runs = [&](const std::string& word) {
                return std::any_of(plan.stages.begin(), plan.stages.end(), [&](const auto& s) {
                  return (s.name + " " + s.detail).find(word) != std::string::npos;
                });
              };
              const auto skips = [&](const std::string& word) {
                return std::any_of(plan.skipped.begin(), plan.skipped.end(),
                                   [&](const auto& s) { return s.name == word; });
              };
              const std::string way = std::to_string(int(kind)) + std::to_string(int(method)) +
                                      std::to_string(int(sweep)) + std::to_string(membrane) +
                                      std::to_string(springs) + std::to_string(bends);
              EXPECT_EQ(bends, runs("bending")) << way;
              EXPECT_TRUE(bends || skips("bending")) << way;
              const bool stretches = membrane || springs;
              const char* sweeps[] = {"gauss_seidel", "jacobi", "line"};
              const bool forces = method == Method::spring || method == Method::spring_friction;
              EXPECT_TRUE(forces || !stretches || runs(sweeps[int(sweep)])) << way;
              EXPECT_TRUE(forces || stretches || skips("gauss_seidel") || skips("jacobi") ||
                          skips("line"))
                  << way;
              EXPECT_TRUE(!forces || !stretches || runs(membrane ? "membrane" : "springs")) << way;
              EXPECT_EQ(estimate(run).substeps, run.substeps()) << way;
              ++ways;
            }
  EXPECT_GT(ways, 60);
}

TEST(StartNotes, DampingOfNoSpringsIsToldOf) {
  const char* kinds[] = {"structural", "shear", "bend"};
  double Kinds::*const fields[] = {&Kinds::structural, &Kinds::shear, &Kinds::bend};
  for (int k = 0; k < 3; ++k) {
    Scene scene = sheet(Sheet::grid);
    scene.solver.method = Method::spring_friction;
    Cloth& cloth = scene.cloths[0];
    cloth.spring_damping.*fields[k] = 0.01;
    const std::string words = std::string("spring_damping ") + kinds[k];
    EXPECT_EQ(told(Simulation(scene).plan(), "spring_damping"), "");
    cloth.stiffness.*fields[k] = 0;
    EXPECT_NE(told(Simulation(scene).plan(), words), "");
    cloth.stiffness.*fields[k] = 10;
    cloth.level = 2;
    EXPECT_EQ(told(Simulation(scene).plan(), words) != "", k > 0);
    scene.solver.method = Method::spring;
    EXPECT_NE(told(Simulation(scene).plan(), "method spring_friction alone has it"), "");
  }
}

TEST(StartNotes, KeysThatDoNothingAreToldOf) {
  for (const Sheet kind : {Sheet::grid, Sheet::mesh})
    for (const bool keys : {false, true}) {
      Scene scene = sheet(kind);
      scene.cloths[0].pins = {{0, 0, {}}};
      scene.colliders.emplace_back().shape = Sphere{{0, -9, 0}, 0.1};
      EXPECT_EQ(told(Simulation(scene).plan(), "rotate does"), "");
      Rotation turn{{0, 0, 1}, {}, {}};
      if (keys) turn.keys = {{0, 30}};
      Scene turned = scene;
      turned.colliders[0].rotate = turn;
      EXPECT_EQ(told(Simulation(turned).plan(), "collider 0: rotate does") == "", keys);
      turned = scene;
      turned.cloths[0].pins[0].rotate = turn;
      EXPECT_EQ(told(Simulation(turned).plan(), "cloth 0, 1 pin: rotate does") == "", keys);
    }
  for (const MeshRest rest : {MeshRest::shape, MeshRest::flat}) {
    Scene scene = sheet(Sheet::mesh);
    scene.cloths[0].mesh.rest = rest;
    EXPECT_EQ(told(Simulation(scene).plan(), "uv_scale"), "");
    scene.cloths[0].mesh.uv_scale = 0.5;
    EXPECT_NE(told(Simulation(scene).plan(), "cloth 0: uv_scale of 0.5 m does nothing"), "");
  }
}

// What is told to shake gains energy in free fall, which keeps it, and what is not told does not.
TEST(StartNotes, ShakingByRoundingIsToldOf) {
  for (const Sheet kind : {Sheet::grid, Sheet::mesh})
    for (const double bending : {1e-2, 1.0, 1e4}) {
      Scene scene = sheet(kind);
      scene.time.seconds = 0.05;
      scene.gravity = {};
      scene.cloths[0].velocity = {0.1, 0, 0};
      scene.cloths[0].bending = bending;
      Simulation run(scene, {.threads = 1});
      const auto energy = [&] {
        const auto e = run.report(false).energy;
        return e.kinetic + e.elastic;
      };
      const double before = energy();
      const bool shakes = told(run.plan(), "do not trust its motion") != "";
      while (run.time() < scene.time.seconds) run.advance_frame();
      const double gain = energy() / before - 1;
      EXPECT_EQ(shakes, bending == 1e4) << int(kind) << " " << bending;
      EXPECT_EQ(shakes, gain > 0.02) << int(kind) << " " << bending << ": " << gain;
      Scene slow = scene;
      slow.solver.method = Method::compliant;
      EXPECT_EQ(told(Simulation(slow).plan(), "do not trust its motion"), "");
    }
}

}  // namespace
}  // namespace weft
