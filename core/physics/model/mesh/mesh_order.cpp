#include "physics/model/mesh/mesh_order.h"

#include <algorithm>
#include <numeric>

namespace weft::physics {
namespace {

// Vertices: from so many on, batches of triangles that share none of six corners are mostly full.
constexpr int kLeastRow = 256;

// The vertices that share an edge with each, or are sewn to it, ascending.
std::vector<std::vector<int>> neighbours_of(const TriangleMesh& mesh,
                                            const std::vector<std::vector<int>>& sewn) {
  std::vector<std::vector<int>> near(mesh.vertices.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3})
        near[std::size_t(t[k])].push_back(t[other]);
  for (const std::vector<int>& group : sewn)
    for (const int a : group)
      for (const int b : group)
        if (a != b) near[std::size_t(a)].push_back(b);
  for (std::vector<int>& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return near;
}

// Vertices in the order of a search from `start` on, with the level of each.
struct Levels {
  std::vector<int> vertices, level;
};

class Search {
 public:
  explicit Search(const std::vector<std::vector<int>>& near)
      : near_(near), seen_(near.size(), -1) {}

  // Of the piece that `start` belongs to, in a round of its own.
  Levels from(int start, int round) {
    Levels all{{start}, {0}};
    seen_[std::size_t(start)] = round;
    for (std::size_t n = 0; n < all.vertices.size(); ++n)
      for (const int next : near_[std::size_t(all.vertices[n])]) {
        if (seen_[std::size_t(next)] == round) continue;
        seen_[std::size_t(next)] = round;
        all.vertices.push_back(next);
        all.level.push_back(all.level[n] + 1);
      }
    return all;
  }
  bool met(int vertex) const { return seen_[std::size_t(vertex)] >= 0; }

 private:
  const std::vector<std::vector<int>>& near_;
  std::vector<int> seen_;
};

}  // namespace

MeshOrder order_of(const TriangleMesh& mesh, const std::vector<std::vector<int>>& sewn) {
  const auto near = neighbours_of(mesh, sewn);
  const int count = int(near.size());
  Search search(near);
  MeshOrder order;
  std::vector<int> widths;  // of the levels
  for (int v = 0; v < count; ++v) {
    if (search.met(v)) continue;
    // From an end of the piece: what is met last from anywhere.
    const Levels piece = search.from(search.from(v, 2 * v).vertices.back(), 2 * v + 1);
    for (std::size_t n = 0; n < piece.vertices.size(); ++n) {
      if (n == 0 || piece.level[n] != piece.level[n - 1]) widths.push_back(0);
      ++widths.back();
    }
    order.vertices.insert(order.vertices.end(), piece.vertices.begin(), piece.vertices.end());
  }
  // Rows lie in memory as long as the longest of them.
  const int least = std::max(kLeastRow, *std::max_element(widths.begin(), widths.end()) / 2);
  for (const int width : widths) {
    if (order.counts.empty() || order.counts.back() >= least) order.counts.push_back(0);
    order.counts.back() += width;
  }
  order.rows.resize(near.size());
  order.lanes.resize(near.size());
  for (std::size_t j = 0, n = 0; j < order.counts.size(); ++j)
    for (int i = 0; i < order.counts[j]; ++i, ++n) {
      order.rows[std::size_t(order.vertices[n])] = int(j);
      order.lanes[std::size_t(order.vertices[n])] = i;
    }
  return order;
}

}  // namespace weft::physics
