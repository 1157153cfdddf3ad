// The squares of a mesh (mesh_squares.h).
#include "physics/contact/self/mesh_squares.h"

#include <algorithm>
#include <set>
#include <utility>

namespace weft::physics {

MeshSquares squares_of(std::vector<std::array<std::int32_t, 3>> triangles) {
  // By their first corners, so that what is near has numbers that are.
  std::ranges::stable_sort(triangles, {}, [](const auto& t) { return std::ranges::min(t); });
  MeshSquares mesh;
  mesh.triangles = triangles.size();
  std::set<std::int32_t> vertices;
  std::set<std::pair<std::int32_t, std::int32_t>> edges;
  for (auto& t : triangles) {
    const auto taken = [&](std::int32_t v) { return vertices.contains(v); };
    std::rotate(t.begin(),
                std::ranges::find_if_not(t, taken) == t.end() ? t.begin()
                                                              : std::ranges::find_if_not(t, taken),
                t.end());
    std::uint8_t owned = vertices.insert(t[0]).second ? kOwnsVertex : 0;
    constexpr int kEdges[3][2] = {{0, 1}, {0, 2}, {1, 2}};
    for (int n = 0; n < 3; ++n)
      if (edges.insert(std::minmax(t[std::size_t(kEdges[n][0])], t[std::size_t(kEdges[n][1])]))
              .second)
        owned = std::uint8_t(owned | kOwnsEdge << n);
    mesh.squares.push_back({{t[0], t[1], t[2], t[2]}});
    mesh.owned.push_back(owned);
  }
  for (const auto& t : triangles)
    for (const std::int32_t v : t)
      if (vertices.insert(v).second) {
        mesh.squares.push_back({{v, v, v, v}});
        mesh.owned.push_back(kOwnsVertex);
      }
  return mesh;
}

}  // namespace weft::physics
