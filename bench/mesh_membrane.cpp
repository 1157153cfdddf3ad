// The membrane of meshes by method compliant beside that by forces: how far apart they are after half a second
// (root mean square of the vertices), the time of a frame, and what a triangle takes in a sweep. A sheet of 1 x 1 m,
// 33 x 33 points that are shifted by up to 0.3 spacings with diagonals at random, of canvas, held by one side, swings
// down with a load across (curtain), or hangs by parts of one side (hung).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "../tests/made_up_mesh.h"
#include "weft/simulation.h"

namespace {

weft::Scene sheet(int points, bool curtain) {
  weft::Scene scene;
  scene.time.frame = 1.0 / 60;
  weft::Cloth& cloth = scene.cloths.emplace_back();
  cloth.mesh.shape = weft::made_up({.nx = points, .ny = points, .shift = 0.3});
  cloth.membrane = {3000, 2000, 200, 80, 0};
  cloth.bending = 2e-4;
  cloth.drag = 1;
  if (curtain) scene.gravity = {2, -9, 3};
  for (int n = 0; n < points; ++n) {
    if (curtain) cloth.pins.push_back({n * points, 0, {}});
    if (!curtain && (n <= points / 8 || n >= points - 1 - points / 8))
      cloth.pins.push_back({n, 0, {}});
  }
  return scene;
}

struct Result {
  std::vector<double> x;
  double frame_ms;
  int substeps;
  bool fallback;
};

Result half_a_second(const weft::Scene& scene) {
  weft::Simulation run(scene, {.threads = 1});
  const auto start = std::chrono::steady_clock::now();
  for (int n = 0; n < 30; ++n) run.advance_frame();
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  return {run.positions(), took.count() / 30, run.substeps(), run.plan().fallback};
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += (a[n] - b[n]) * (a[n] - b[n]);
  return std::sqrt(3 * sum / double(a.size()));
}

void errors(bool curtain) {
  const weft::Scene forces = sheet(33, curtain);
  const Result truth = half_a_second(forces);
  std::printf("%s: forces, %d substeps, %.2f ms/frame\n", curtain ? "curtain" : "hung",
              truth.substeps, truth.frame_ms);
  for (const weft::Sweep sweep : {weft::Sweep::gauss_seidel, weft::Sweep::line})
    for (const int order : {1, 2}) {
      std::printf("  %-7s order %d ", sweep == weft::Sweep::line ? "strands" : "colours", order);
      for (const int substeps : {4, 8, 16, 32}) {
        weft::Scene scene = forces;
        scene.solver.method = weft::Method::compliant;
        scene.solver.sweep = sweep;
        scene.solver.order = order;
        scene.time.substeps = substeps;
        const Result r = half_a_second(scene);
        std::printf("  %2d: %.1e m %6.2f ms%s", substeps, apart(r.x, truth.x), r.frame_ms,
                    r.fallback ? "*" : " ");
      }
      std::printf("\n");
    }
}

// ns of a triangle and sweep, by what more iterations take.
void sweeps(weft::Sweep sweep, const char* name) {
  constexpr int kMore = 8, kSubsteps = 8;
  double ms[2];
  for (const int more : {0, 1}) {
    weft::Scene scene = sheet(100, true);
    scene.solver.method = weft::Method::compliant;
    scene.solver.sweep = sweep;
    scene.solver.iterations = 2 + more * kMore;
    scene.time.substeps = kSubsteps;
    ms[more] = 1e300;
    for (int turn = 0; turn < 3; ++turn)
      ms[more] = std::min(ms[more], half_a_second(scene).frame_ms);
  }
  const double triangles = 2 * 99 * 99;
  std::printf("%s, 100 x 100: %.1f ns for each triangle and sweep\n", name,
              1e6 * (ms[1] - ms[0]) / (kMore * kSubsteps * triangles));
}

}  // namespace

int main() {
  std::printf("Apart from forces after 0.5 s, one thread (*: with more substeps)\n");
  errors(true);
  errors(false);
  sweeps(weft::Sweep::gauss_seidel, "colours");
  sweeps(weft::Sweep::line, "strands");
}
