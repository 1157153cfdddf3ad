// What sheets tend to (sheets.h): Richardson's extrapolation from ever finer grids.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include "sheets.h"

namespace bench {
namespace {

// A state at the points of a grid.
struct OnGrid {
  int nx = 0, ny = 0;
  std::vector<double> positions;
};

// At the points that a coarser grid has, too.
std::vector<double> at_points_of(const OnGrid& fine, int nx, int ny) {
  if ((fine.nx - 1) % (nx - 1) != 0 || (fine.ny - 1) % (ny - 1) != 0)
    throw std::invalid_argument("the limit is not known at the points of " + std::to_string(nx) +
                                " x " + std::to_string(ny));
  std::vector<double> some;
  const int across = (fine.nx - 1) / (nx - 1), down = (fine.ny - 1) / (ny - 1);
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i)
      for (int k = 0; k < 3; ++k)
        some.push_back(
            fine.positions[3 * std::size_t(j * down * fine.nx + i * across) + std::size_t(k)]);
  return some;
}

// Where two grids lead to, at the points of the coarser.
OnGrid limit_of(const OnGrid& coarse, const OnGrid& fine, double factor) {
  OnGrid limit{coarse.nx, coarse.ny, at_points_of(fine, coarse.nx, coarse.ny)};
  for (std::size_t k = 0; k < limit.positions.size(); ++k)
    limit.positions[k] += (limit.positions[k] - coarse.positions[k]) / (factor - 1);
  return limit;
}

double apart(const OnGrid& coarse, const OnGrid& fine) {
  return distance(coarse.positions, at_points_of(fine, coarse.nx, coarse.ny)).rms;
}

Truth of_grids(const Sheet& sheet, const std::string& cache) {
  std::array<OnGrid, 3> grids;
  double own = 0;  // of the references
  int points = (sheet.middle - 1) / 2 + 1;
  for (OnGrid& grid : grids) {
    const Problem p = problem_of(sheet, points);
    const Reference r = reference(p.question, cache);
    const weft::Grid& g = p.question.scene.cloths[0].grid;
    grid = {g.nx, g.ny, r.positions};
    own += r.error;
    points = 2 * points - 1;
  }
  const double order = std::log2(apart(grids[0], grids[1]) / apart(grids[1], grids[2]));
  const double factor = std::exp2(std::clamp(order, 1.0, 2.0));
  const OnGrid before = limit_of(grids[0], grids[1], factor),
               limit = limit_of(grids[1], grids[2], factor);
  Truth truth;
  truth.error = apart(before, limit) / factor + own;
  char how[200];
  std::snprintf(
      how, sizeof how,
      "%d, %d and %d points along it, of order %.2f in space; the finest is %.1e m from the limit",
      grids[0].nx, grids[1].nx, grids[2].nx, order, apart(limit, grids[2]));
  truth.how = how;
  truth.at = [limit](const weft::Grid& g) { return at_points_of(limit, g.nx, g.ny); };
  return truth;
}

}  // namespace

Truth truth_of(const Sheet& sheet, const std::string& cache) {
  if (!sheet.limit) return of_grids(sheet, cache);
  return {sheet.limit, sheet.limit_error, "the elastica by shooting"};
}

}  // namespace bench
