// Cloth of triangle meshes: nanoseconds for each vertex and substep, on one thread and on two. A sheet of
// N x N points that are shifted by up to 0.3 spacings, with diagonals at random, hangs by one side.
#include <algorithm>
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
  }
}
