#include "physics/model/mesh/triangle_batches.h"

#include <algorithm>

#include "physics/kernels/mesh.h"

namespace weft::physics {
namespace {

constexpr std::size_t kOpen = 64;  // batches that a triangle may still join

// Triangles of one row, packed in their order.
std::vector<std::vector<int>> packed(const std::vector<int>& row,
                                     const std::vector<RestTriangle>& triangles, int corners) {
  std::vector<std::vector<int>> batches;
  std::vector<std::size_t> open;
  const auto apart = [&](int a, int b) {
    const auto &p = triangles[std::size_t(a)].corner, &q = triangles[std::size_t(b)].corner;
    return std::none_of(p.begin(), p.begin() + corners, [&](int corner) {
      return corner >= 0 &&
             std::find(q.begin(), q.begin() + corners, corner) != q.begin() + corners;
    });
  };
  for (const int t : row) {
    const auto fits = [&](std::size_t b) {
      return std::all_of(batches[b].begin(), batches[b].end(), [&](int s) { return apart(s, t); });
    };
    auto at = std::find_if(open.begin(), open.end(), fits);
    if (at == open.end()) {
      if (open.size() == kOpen) open.erase(open.begin());
      at = open.insert(open.end(), batches.size());
      batches.emplace_back();
    }
    batches[*at].push_back(t);
    if (batches[*at].size() == kBatch) open.erase(at);
  }
  return batches;
}

}  // namespace

TriangleBatches batches_of(const MeshOrder& order, const std::vector<RestTriangle>& triangles,
                           int corners) {
  std::vector<std::vector<int>> rows(order.counts.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    int first = int(rows.size());
    for (int k = 0; k < corners; ++k)
      if (const int c = triangles[t].corner[std::size_t(k)]; c >= 0)
        first = std::min(first, order.rows[std::size_t(c)]);
    rows[std::size_t(first)].push_back(int(t));
  }
  TriangleBatches all;
  all.first.push_back(0);
  for (const std::vector<int>& row : rows) {
    for (std::vector<int>& one : packed(row, triangles, corners))
      all.triangles.push_back(std::move(one));
    all.first.push_back(int(all.triangles.size()));
  }
  return all;
}

}  // namespace weft::physics
