// Meshes by methods that project: the greatest strain that sweeps by colours and by strands leave, and what
// they take. A sheet of 1 x 1 m hangs by two corners, stiff (1e6 N/m), with a drag of 1/s: 64 x 64 points that
// are shifted by 0.3 spacings with diagonals at random, and 0.1 spacings with diagonals alike; one sweep a
// substep. Then sheets of 100 x 100 points, with the time of a frame.
#include <algorithm>
#include <cstdio>
#include <limits>

#include "../tests/made_up_mesh.h"
#include "weft/simulation.h"

namespace {

struct Setting {
  const char* name;
  weft::Sweep sweep;
  int substeps, iterations;
  bool tethers;
  double bending, strain_limit;
};

weft::Scene hanging(const weft::MadeUpMesh& like, const Setting& setting) {
  weft::Scene scene;
  scene.time = {1.0 / 60, setting.substeps, 2};
  scene.solver.method = weft::Method::compliant;
  scene.solver.sweep = setting.sweep;
  scene.solver.iterations = setting.iterations;
  scene.solver.tethers = setting.tethers;
  weft::Cloth& cloth = scene.cloths.emplace_back();
  const auto mesh = weft::made_up(like);
  cloth.mesh.shape = mesh;
  cloth.stiffness.structural = 1e6;
  cloth.drag = 1;
  cloth.bending = setting.bending;
  cloth.strain_limit = setting.strain_limit;
  cloth.pins = {{weft::nearest_vertex(*mesh, {0, 0, 0}), 0, {}},
                {weft::nearest_vertex(*mesh, {1, 0, 0}), 0, {}}};
  return scene;
}

struct Result {
  double end = 0, worst = 0;                                  // strain
  double frame_ms = std::numeric_limits<double>::infinity();  // the fastest
  double constraints = 0;
};

Result run(const weft::Scene& scene, int threads = 1) {
  weft::Simulation simulation(scene, {.threads = threads});
  Result result;
  for (int n = 0; n < 120; ++n) {
    simulation.advance_frame();
    if (!simulation.status().ok || simulation.plan().fallback)
      result.worst = std::numeric_limits<double>::infinity();
    const weft::Report report = simulation.report(true);
    result.end = report.strain.max;
    result.worst = std::max(result.worst, result.end);
    result.frame_ms = std::min(result.frame_ms, double(report.wall_ms.frame_min));
  }
  const weft::TriangleMesh& mesh = *scene.cloths[0].mesh.shape;
  result.constraints = double(mesh.vertices.size() + mesh.triangles.size()) - 1;  // of a disc
  return result;
}

void strains() {
  std::printf("Greatest strain after 2 s / of all frames, one sweep a substep\n%-34s", "substeps");
  for (const int substeps : {8, 16, 32, 64}) std::printf(" %15d", substeps);
  const weft::MadeUpMesh wild{.nx = 64, .ny = 64, .shift = 0.3};
  weft::MadeUpMesh regular = wild;
  regular.shift = 0.1;
  regular.diagonals = weft::Diagonals::alike;
  for (const auto& [mesh, what] :
       {std::pair(&wild, "wild mesh"), {&regular, "nearly regular mesh"}})
    for (const auto& [sweep, how] :
         {std::pair(weft::Sweep::gauss_seidel, "colours"), {weft::Sweep::line, "strands"}}) {
      std::printf("\n%-20s  %-12s", what, how);
      for (const int substeps : {8, 16, 32, 64}) {
        const Result r = run(hanging(*mesh, {"", sweep, substeps, 1, false, 0, 0}));
        std::printf("   %5.3f / %5.3f", r.end, r.worst);
      }
    }
  std::printf("\n");
}

void times() {
  const weft::MadeUpMesh wild{.nx = 100, .ny = 100, .shift = 0.3};
  std::printf("\n100 x 100 points, wild: %-20s %9s %9s %12s %8s %8s\n", "", "ms/frame", "2 threads",
              "ns/constr.", "strain", "worst");
  for (const Setting& s :
       {Setting{"colours, 1 x 5", weft::Sweep::gauss_seidel, 1, 5, false, 0, 0},
        {"colours, 5 x 1", weft::Sweep::gauss_seidel, 5, 1, false, 0, 0},
        {"colours, 5 x 1, bending", weft::Sweep::gauss_seidel, 5, 1, false, 1e-5, 0},
        {"colours, 5 x 1, limit 5 %", weft::Sweep::gauss_seidel, 5, 1, false, 0, 0.05},
        {"colours, tethers, 16 x 1", weft::Sweep::gauss_seidel, 16, 1, true, 0, 0},
        {"strands, 16 x 1", weft::Sweep::line, 16, 1, false, 0, 0},
        {"strands, tethers, 16 x 1", weft::Sweep::line, 16, 1, true, 0, 0},
        {"strands, tethers, 32 x 1", weft::Sweep::line, 32, 1, true, 0, 0}}) {
    const weft::Scene scene = hanging(wild, s);
    const Result one = run(scene), two = run(scene, 2);
    std::printf("%-44s %9.3f %9.3f %12.2f %8.3f %8.3f\n", s.name, one.frame_ms, two.frame_ms,
                one.frame_ms * 1e6 / (one.constraints * s.substeps * s.iterations), one.end,
                one.worst);
  }
}

}  // namespace

int main() {
  strains();
  times();
}
