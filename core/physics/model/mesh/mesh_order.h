// The vertices of a mesh as rows: breadth-first levels (Cuthill, McKee 1969, "Reducing the bandwidth of
// sparse symmetric matrices"), thin ones merged. What is joined by an edge lies in one row or in two that
// follow each other, and so does what seams make one; a triangle with its neighbours spans three at most.
#pragma once

#include "weft/mesh.h"

namespace weft::physics {

struct MeshOrder {
  std::vector<int> counts;    // vertices of each row
  std::vector<int> vertices;  // row after row
  std::vector<int> rows;      // of every vertex
  std::vector<int> lanes;     // of every vertex in its row
};

// `sewn`: groups of vertices that seams make one.
MeshOrder order_of(const TriangleMesh& mesh, const std::vector<std::vector<int>>& sewn = {});

}  // namespace weft::physics
