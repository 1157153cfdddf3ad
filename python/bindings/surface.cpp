#include "surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "study/triangles.h"

namespace weft::python {

namespace {

void append_left(const ClothView& c, std::uint32_t first, std::vector<std::uint32_t>& all) {
  const auto columns = std::uint32_t(c.columns), stride = std::uint32_t(c.stride);
  for (const auto& triangle : c.triangles)
    for (const std::uint32_t lane : triangle)
      all.push_back(first + lane / stride * columns + lane % stride);
}

// Calls visit(a, b, rest length) for the structural constraints of a cloth.
template <class Visit>
void for_each_edge(const Grid& grid, const Visit& visit) {
  for (int j = 0; j < grid.ny; ++j)
    for (int i = 0; i + 1 < grid.nx; ++i)
      visit(particle_number(grid, i, j), particle_number(grid, i + 1, j), spacing_u(grid));
  for (int j = 0; j + 1 < grid.ny; ++j)
    for (int i = 0; i < grid.nx; ++i)
      visit(particle_number(grid, i, j), particle_number(grid, i, j + 1), spacing_v(grid));
}

std::set<std::array<int, 2>> torn_of(const Snapshot& snapshot, std::size_t cloth) {
  std::set<std::array<int, 2>> torn;
  for (const auto& [a, b] : snapshot.cloths[cloth].torn)
    torn.insert({std::min(a, b), std::max(a, b)});
  return torn;
}

}  // namespace

std::int64_t particle_total(const Scene& scene) {
  std::int64_t total = 0;
  for (const Cloth& c : scene.cloths) total += std::int64_t(c.grid.nx) * c.grid.ny;
  return total;
}

std::vector<std::uint32_t> triangles_of(const Simulation& simulation) {
  std::vector<std::uint32_t> all;
  std::uint32_t first = 0;
  for (const ClothView& c : simulation.view().cloths) {
    const auto columns = std::uint32_t(c.columns), rows = std::uint32_t(c.rows);
    c.topology_version > 0 ? append_left(c, first, all)
                           : append_triangles(columns, rows, first, all);
    first += columns * rows;
  }
  return all;
}

std::vector<std::uint32_t> edges_of(const Scene& scene) {
  std::vector<std::uint32_t> all;
  std::uint32_t first = 0;
  for (const Cloth& c : scene.cloths) {
    for_each_edge(c.grid, [&](int a, int b, double) {
      all.push_back(first + std::uint32_t(a));
      all.push_back(first + std::uint32_t(b));
    });
    first += std::uint32_t(c.grid.nx) * std::uint32_t(c.grid.ny);
  }
  return all;
}

std::vector<double> strain_of(const Simulation& simulation) {
  std::vector<double> all;
  const std::vector<double> x = simulation.positions();
  const Snapshot snapshot = simulation.snapshot();
  const double* from = x.data();
  for (std::size_t n = 0; n < simulation.scene().cloths.size(); ++n) {
    const Grid& grid = simulation.scene().cloths[n].grid;
    const auto torn = torn_of(snapshot, n);
    for_each_edge(grid, [&](int a, int b, double rest) {
      const double *p = from + 3 * std::size_t(a), *q = from + 3 * std::size_t(b);
      const bool whole = !torn.contains({a, b});
      all.push_back(whole ? std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]) / rest - 1
                          : std::numeric_limits<double>::quiet_NaN());
    });
    from += 3 * std::size_t(grid.nx) * std::size_t(grid.ny);
  }
  return all;
}

}  // namespace weft::python
