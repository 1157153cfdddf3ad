// Trial runs (trial_run.h).
#include "tolerance/trial_run.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::tolerance {
namespace {

// Enough to see a sheet that swings away and comes back, few enough that two runs of a large one fit into memory.
constexpr int kInstants = 8;

int ratio(int fine, int coarse) {
  return coarse > 0 ? fine / coarse : 1;
}

// Of the cloth that is farthest off.
double root_mean_square(const std::vector<double>& a, const std::vector<double>& b,
                        const Motion& coarse, const Motion& fine) {
  double greatest = 0;
  std::size_t first = 0, first_of_fine = 0;
  for (std::size_t c = 0; c < coarse.grids.size(); ++c) {
    const Intervals grid = coarse.grids[c], finer = fine.grids[c];
    const int every_u = ratio(finer.u, grid.u), every_v = ratio(finer.v, grid.v);
    double sum = 0;
    std::size_t count = 0;
    for (int j = 0; j <= grid.v; ++j)
      for (int i = 0; i <= grid.u; ++i, ++count) {
        const std::size_t p = first_of_fine + std::size_t(j * every_v) * std::size_t(finer.u + 1) +
                              std::size_t(i * every_u);
        for (std::size_t k = 0; k < 3; ++k) {
          const double apart = a[3 * (first + count) + k] - b[3 * p + k];
          sum += apart * apart;
        }
      }
    greatest = std::max(greatest, std::sqrt(sum / double(count)));
    first += count;
    first_of_fine += std::size_t(finer.u + 1) * std::size_t(finer.v + 1);
  }
  return greatest;
}

}  // namespace

Motion motion_of(const Scene& scene, const Way& way, int substeps, const Runs& runs) {
  Motion motion;
  Scene tried = scene;
  tried.solver = way.solver;
  tried.time.substeps = substeps;
  if (!validate(tried).empty()) {
    motion.refused = true;
    return motion;
  }
  Simulation simulation(tried, runs.options);
  double particles = 0;
  for (const Cloth& cloth : scene.cloths) {
    const int count = particle_count(cloth);
    motion.grids.push_back(cloth.mesh.given() ? Intervals{count - 1, 0}
                                              : Intervals{cloth.grid.nx - 1, cloth.grid.ny - 1});
    particles += count;
  }
  motion.substeps = simulation.substeps();
  motion.work = way.work * particles * motion.substeps * runs.frames;
  if (simulation.plan().fallback) return motion;
  if (runs.on_run)
    runs.on_run(way.name + ", " + std::to_string(std::int64_t(particles)) + " particles, " +
                std::to_string(motion.substeps) + " substeps a frame");
  const int instants = std::min(kInstants, runs.frames);
  for (int n = 1; n <= runs.frames; ++n) {
    simulation.advance_frame();
    const int kept = int(motion.places.size());
    if (n >= std::llround(double(kept + 1) * runs.frames / instants))
      motion.places.push_back(simulation.positions());
  }
  if (!simulation.status().ok || simulation.plan().fallback) motion.places.clear();
  return motion;
}

double distance(const Motion& coarse, const Motion& fine) {
  if (coarse.places.empty() || fine.places.empty()) return std::numeric_limits<double>::infinity();
  double greatest = 0;
  for (std::size_t n = 0; n < coarse.places.size(); ++n)
    greatest = std::max(greatest, root_mean_square(coarse.places[n], fine.places[n], coarse, fine));
  return greatest;
}

}  // namespace weft::tolerance
