#include "physics/model/mesh/mesh_edges.h"

#include <algorithm>
#include <cmath>

#include "weft/vec3.h"

namespace weft::physics {

MeshEdges edges_of(const TriangleMesh& mesh, const std::vector<Vec3>& x) {
  std::vector<Joined> sides;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      sides.push_back({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  std::sort(sides.begin(), sides.end());
  MeshEdges edges;
  for (const Joined& side : sides) {
    if (!edges.ends.empty() && edges.ends.back() == side) {
      edges.triangles.back() += 1;
      continue;
    }
    edges.ends.push_back(side);
    const Vec3 e = minus(x[std::size_t(side[1])], x[std::size_t(side[0])]);
    edges.rest.push_back(length(e));
    edges.triangles.push_back(1);
  }
  return edges;
}

void take_lengths(const std::vector<RestTriangle>& triangles, MeshEdges& edges) {
  std::fill(edges.rest.begin(), edges.rest.end(), 0);
  for (const RestTriangle& r : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = r.corner[k], b = r.corner[(k + 1) % 3];
      const auto at = std::lower_bound(edges.ends.begin(), edges.ends.end(),
                                       Joined{std::min(a, b), std::max(a, b)});
      const auto n = std::size_t(at - edges.ends.begin());
      edges.rest[n] += r.rest[k] / edges.triangles[n];
    }
}

}  // namespace weft::physics
