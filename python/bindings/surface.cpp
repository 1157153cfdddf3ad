#include "surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "study/triangles.h"
#include "weft/mesh.h"

namespace weft::python {

namespace {

void append_left(const ClothView& c, std::uint32_t first, std::vector<std::uint32_t>& all) {
  const auto columns = std::uint32_t(c.columns), stride = std::uint32_t(c.stride);
  std::vector<std::uint32_t> numbers(c.lanes.empty() ? 0 : c.x.size());  // of a mesh, by lane
  for (std::size_t n = 0; n < c.lanes.size(); ++n) numbers[c.lanes[n]] = std::uint32_t(n);
  for (const auto& triangle : c.triangles)
    for (const std::uint32_t lane : triangle)
      all.push_back(first +
                    (numbers.empty() ? lane / stride * columns + lane % stride : numbers[lane]));
}

// Calls visit(a, b, rest length) for each edge of a mesh.
template <class Visit>
void for_each_edge_of_mesh(const MeshSource& mesh, const Visit& visit) {
  const std::vector<Vec3> x = placed_vertices(mesh);
  std::set<std::array<int, 2>> edges;
  for (const auto& t : mesh.shape->triangles)
    for (std::size_t k = 0; k < 3; ++k)
      edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  for (const auto& [a, b] : edges) {
    const Vec3 &p = x[std::size_t(a)], &q = x[std::size_t(b)];
    visit(a, b, std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]));
  }
}

// Calls visit(a, b, rest length) for the structural constraints of a cloth.
template <class Visit>
void for_each_edge(const Cloth& cloth, const Visit& visit) {
  if (cloth.mesh.given()) return for_each_edge_of_mesh(cloth.mesh, visit);
  const Grid& grid = cloth.grid;
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
  for (const Cloth& c : scene.cloths) total += particle_count(c);
  return total;
}

std::vector<std::uint32_t> triangles_of(const Simulation& simulation) {
  std::vector<std::uint32_t> all;
  std::uint32_t first = 0;
  for (const ClothView& c : simulation.view().cloths) {
    const auto columns = std::uint32_t(c.columns), rows = std::uint32_t(c.rows);
    c.topology_version > 0 ? append_left(c, first, all)
                           : append_triangles(columns, rows, first, all);
    first += c.lanes.empty() ? columns * rows : std::uint32_t(c.lanes.size());
  }
  return all;
}

std::vector<std::uint32_t> edges_of(const Scene& scene) {
  std::vector<std::uint32_t> all;
  std::uint32_t first = 0;
  for (const Cloth& c : scene.cloths) {
    for_each_edge(c, [&](int a, int b, double) {
      all.push_back(first + std::uint32_t(a));
      all.push_back(first + std::uint32_t(b));
    });
    first += std::uint32_t(particle_count(c));
  }
  return all;
}

std::vector<double> strain_of(const Simulation& simulation) {
  std::vector<double> all;
  const std::vector<double> x = simulation.positions();
  const Snapshot snapshot = simulation.snapshot();
  const double* from = x.data();
  for (std::size_t n = 0; n < simulation.scene().cloths.size(); ++n) {
    const Cloth& cloth = simulation.scene().cloths[n];
    const auto torn = torn_of(snapshot, n);
    for_each_edge(cloth, [&](int a, int b, double rest) {
      const double *p = from + 3 * std::size_t(a), *q = from + 3 * std::size_t(b);
      const bool whole = !torn.contains({a, b});
      all.push_back(whole ? std::hypot(q[0] - p[0], q[1] - p[1], q[2] - p[2]) / rest - 1
                          : std::numeric_limits<double>::quiet_NaN());
    });
    from += 3 * std::size_t(particle_count(cloth));
  }
  return all;
}

}  // namespace weft::python
