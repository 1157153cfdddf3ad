// Cloth of triangle meshes: nanoseconds for each vertex and substep, on one thread and on two. A sheet of
// N x N points that are shifted by up to 0.3 spacings, with diagonals at random, hangs by one side. Then what
// self-collision adds to one that flies and turns, flat and far from everything, on one thread.
#include <algorithm>
#include <array>
#include <cstdio>
#include <limits>

#include "../tests/made_up_mesh.h"
#include "weft/simulation.h"

namespace {

weft::Scene hanging(int points) {
  weft::Scene scene;
  scene.time = {1.0 / 60, 40, 1};
  weft::Cloth& cloth = scene.cloths.emplace_back();
  cloth.mesh.shape = weft::made_up({.nx = points, .ny = points, .shift = 0.3});
  // Soft enough for the substep, so that work is all that counts.
  const double k =
      0.02 * cloth.density / (points * points) / (scene.time.frame * scene.time.frame / 1600);
  cloth.stiffness.structural = k;
  for (int n = 0; n < points; ++n) cloth.pins.push_back({n, 0, {}});
  return scene;
}

// ns; the fastest frame of some.
double of_vertex(const weft::Scene& scene, int threads) {
  weft::Simulation run(scene, {.threads = threads});
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 40; ++n) {
    run.advance_frame();
    least = std::min(least, run.report(false).wall_ms.frame_min);
  }
  return least * 1e6 / (double(run.substeps()) * weft::particle_count(scene.cloths[0]));
}

weft::Scene flying(int points, bool bends) {
  weft::Scene scene = hanging(points);
  scene.time.substeps = weft::kAutoSubsteps;
  weft::Cloth& cloth = scene.cloths[0];
  cloth.pins.clear();
  cloth.spin = {1, 0.5, 0};
  cloth.stiffness.structural = 1000;
  if (bends) cloth.membrane = {500, 500, 100, 150, 0}, cloth.bending = 2e-4;
  cloth.self_collision.thickness = 0.5 / points;
  return scene;
}

// ns, without self-collision and with it; by turns, the fastest of some.
std::array<double, 2> without_and_with(weft::Scene scene, weft::SelfCollisionMode mode) {
  std::array<double, 2> least{1e300, 1e300};
  for (int turn = 0; turn < 3; ++turn)
    for (std::size_t with = 0; with < 2; ++with) {
      scene.cloths[0].self_collision.mode = with == 0 ? weft::SelfCollisionMode::off : mode;
      least[with] = std::min(least[with], of_vertex(scene, 1));
    }
  return least;
}

}  // namespace

int main() {
  std::printf("%-28s %6s %10s %10s\n", "cloth", "N", "1 thread", "2 threads");
  for (const int points : {100, 316}) {
    const weft::Scene springs = hanging(points);
    const double k = springs.cloths[0].stiffness.structural;
    weft::Scene membrane = springs;
    membrane.cloths[0].stiffness = {1000, 1000, 200};
    membrane.cloths[0].membrane = {k, k, k / 3, k / 3, 0};
    weft::Scene bends = membrane;
    bends.cloths[0].bending = 1e-3 * k / (points * points);
    for (const auto& [name, scene] :
         {std::pair("springs", &springs), {"membrane", &membrane}, {"membrane that bends", &bends}})
      std::printf("%-28s %6d %8.2f ns %8.2f ns\n", name, points, of_vertex(*scene, 1),
                  of_vertex(*scene, 2));
    for (const bool bent : {false, true})
      for (const auto& [mode, name] :
           {std::pair(weft::SelfCollisionMode::particles, "contact of particles"),
            {weft::SelfCollisionMode::surface, "contact of surfaces"}}) {
        const auto [without, with] = without_and_with(flying(points, bent), mode);
        std::printf("%-28s %6d %8.2f ns, without %.2f ns: %+.1f %%\n", name, points, with, without,
                    100 * (with / without - 1));
      }
  }
}
