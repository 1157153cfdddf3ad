// Surfaces that never pass through each other: crumpled sheets, counted by the independent checker.
#include <algorithm>
#include <cstdio>

#include "machines.h"
#include "sheets.h"
#include "truth.h"
#include "weft/read_scene.h"

namespace weft {
namespace {

// Runs a scene for at least so many substeps; the greatest number of crossings after any frame.
std::int64_t most_crossings(Simulation& simulation, int substeps) {
  std::int64_t most = 0, done = 0;
  while (done < substeps) {
    simulation.advance_frame();
    done += simulation.substeps();
    if (simulation.frame() % 4 == 0)
      most = std::max(most, simulation.report().penetration.crossings);
  }
  const Report r = simulation.report();
  EXPECT_TRUE(simulation.status().ok) << simulation.status().text;
  std::printf(
      "%s: %lld crossings at most in %lld substeps; at the end kinetic energy %.2g J, strain "
      "%.2g, %.2g m below a collider\n",
      simulation.scene().name.c_str(), (long long)most, (long long)done, r.energy.kinetic,
      r.strain.max, r.penetration.collider_max);
  for (const auto& s : r.skipped)
    if (s.name.rfind("self_", 0) == 0) std::printf("  %s: %s\n", s.name.c_str(), s.why.c_str());
  return most;
}

// 10⁴ substeps; thinner than a tenth of the spacing, too, where a layer is passed within two
// substeps.
TEST(Surface, CrumpledBetweenWallsNeverCrosses) {
  for (const double thickness : {0.008, 0.002}) {
    Scene scene = read_scene("crumple").scene;
    char name[48];
    std::snprintf(name, sizeof name, "scene crumple, thickness %.0f mm", 1e3 * thickness);
    scene.name = name;
    scene.cloths[0].self_collision.thickness = thickness;
    Simulation simulation(scene);
    const char* const law = "sheet crumpled between walls, 10000 substeps";
    expect({law, scene.name + ", surface: crossings", 0, 0, "triangle pairs"},
           double(most_crossings(simulation, 10000)));
    // Until then it moves: it is to come to rest.
    for (int frame = 0; frame < 120; ++frame) simulation.advance_frame();
    expect(
        {law, scene.name + ", surface: closer than the thickness two seconds later", 0, 0, "pairs"},
        double(simulation.report().penetration.self_pairs));
    EXPECT_LT(simulation.report().energy.kinetic, 0.05);
  }
}

// Without it the same sheet ends up through itself: what the checker finds is no accident.
TEST(Surface, ParticlesAloneCross) {
  Scene scene = read_scene("crumple").scene;
  scene.name = "the same with particles";
  scene.cloths[0].self_collision.mode = SelfCollisionMode::particles;
  Simulation simulation(scene);
  EXPECT_GT(most_crossings(simulation, 1500), 0);
}

TEST(Surface, SheetsThrownAtEachOtherNeverCross) {
  Scene scene;
  scene.name = "two sheets at 6 m/s";
  scene.gravity = {0, 0, 0};
  for (int c = 0; c < 2; ++c) {
    Cloth cloth;
    cloth.grid = {24, 24, {c * 0.13, c * 0.2, c * 0.07}, {0.5, 0, 0}, {0, 0, 0.5}, 0};
    cloth.stiffness = {400, 200, 5};
    cloth.drag = 0.5;
    cloth.self_collision.mode = SelfCollisionMode::surface;
    cloth.self_collision.thickness = 0.005;
    scene.cloths.push_back(cloth);
  }
  Simulation simulation(scene);
  std::vector<double> v;
  for (int n = 0; n < 2 * 24 * 24; ++n) v.insert(v.end(), {0, n < 24 * 24 ? 3.0 : -3.0, 0});
  simulation.set_state(simulation.positions(), v);
  EXPECT_EQ(most_crossings(simulation, 1200), 0);
}

TEST(Surface, SameBitsForAnyThreadsAndInstructionSet) {
  std::vector<std::uint64_t> hashes;
  for (const Options& o : machines()) {
    Simulation simulation(read_scene("crumple").scene, o);
    advance(simulation, 0.4);
    hashes.push_back(simulation.hash());
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
}

}  // namespace
}  // namespace weft
