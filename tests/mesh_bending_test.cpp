// Bending of a mesh: its damping takes what flaps and leaves alone what turns as a whole; a note tells where it flattens.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mesh_scenes.h"

namespace weft {
namespace {

constexpr double kRadius = 0.2;  // m, of the roll

// A sheet rolled about the z axis, without stretch.
std::vector<double> rolled(const TriangleMesh& mesh) {
  std::vector<double> x;
  for (const Vec3& p : mesh.vertices) {
    const double turn = p[0] / kRadius;
    x.insert(x.end(), {kRadius * std::sin(turn), kRadius * std::cos(turn), p[2]});
  }
  return x;
}

// In free flight; `damping` of bending [s].
Scene free_scene(std::shared_ptr<const TriangleMesh> mesh, double damping) {
  Scene scene = scene_of(std::move(mesh));
  scene.gravity = {};
  scene.cloths[0].membrane = kCanvas;
  scene.cloths[0].bending = 1e-4;
  scene.cloths[0].bending.damping = damping;
  return scene;
}

TEST(MeshBending, BrakesNoTurnOfCurvedCloth) {
  const auto mesh = made_up({.nx = 15, .ny = 13, .width = 0.6, .height = 0.5, .shift = 0.3});
  const Vec3 spin{2, -3, 5};
  Simulation run(free_scene(mesh, 0.2), {.threads = 1});
  const std::vector<double> x = rolled(*mesh);
  std::vector<double> v;
  for (std::size_t n = 0; n < x.size(); n += 3)
    v.insert(v.end(), {spin[1] * x[n + 2] - spin[2] * x[n + 1], spin[2] * x[n] - spin[0] * x[n + 2],
                       spin[0] * x[n + 1] - spin[1] * x[n]});
  run.set_state(x, v);
  const Report before = run.report();
  for (int n = 0; n < 30; ++n) run.advance_frame();
  const Report after = run.report();
  ASSERT_TRUE(run.status().ok);
  double all = 0;
  for (const double l : before.angular_momentum) all = std::max(all, std::abs(l));
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(after.angular_momentum[k], before.angular_momentum[k], 1e-3 * all) << k;
}

// A rolled sheet that is let go flaps; damped, it loses more than half of that in a second.
TEST(MeshBending, TakesWhatFlaps) {
  const auto mesh = made_up({.nx = 15, .ny = 13, .width = 0.6, .height = 0.5, .shift = 0.2});
  double left[2];
  for (const bool damped : {false, true}) {
    Simulation run(free_scene(mesh, damped ? 0.05 : 0), {.threads = 1});
    const std::vector<double> x = rolled(*mesh);
    run.set_state(x, std::vector<double>(x.size()));
    for (int n = 0; n < 60; ++n) run.advance_frame();
    left[damped] = run.report().energy.total;
  }
  EXPECT_LT(left[1], 0.5 * left[0]);
  EXPECT_GT(left[1], -1e-6);
}

// A mesh that is curved and is to be flat is told of; not one that is flat, nor one that stays curved.
TEST(MeshBending, ANoteTellsThatBendingFlattens) {
  const auto flat = made_up({.nx = 15, .ny = 13, .width = 0.6, .height = 0.5, .shift = 0.3});
  auto curved = std::make_shared<TriangleMesh>(*flat);
  const std::vector<double> x = rolled(*flat);
  for (std::size_t n = 0; n < curved->vertices.size(); ++n)
    curved->vertices[n] = {x[3 * n], x[3 * n + 1], x[3 * n + 2]};
  const auto told = [](std::shared_ptr<const TriangleMesh> mesh, MeshRest rest) {
    Scene scene = free_scene(std::move(mesh), 0);
    scene.cloths[0].mesh.rest = rest;
    const Simulation run(scene, {.threads = 1});
    const std::vector<std::string>& notes = run.plan().notes;
    return std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return note.find("cloth 0: bending draws the mesh to its shape at rest") == 0;
    });
  };
  EXPECT_TRUE(told(curved, MeshRest::flat));
  EXPECT_FALSE(told(curved, MeshRest::shape));
  EXPECT_FALSE(told(flat, MeshRest::flat));
}

}  // namespace
}  // namespace weft
