// Triangles in batches for kernels: those of a batch share no vertex, so that what they add up is added in one
// order, however many lanes go at once.
#pragma once

#include "physics/model/mesh/mesh_order.h"
#include "physics/model/mesh/rest_triangles.h"

namespace weft::physics {

struct TriangleBatches {
  std::vector<std::vector<int>> triangles;  // of each batch, at most kBatch
  std::vector<int> first;                   // batch of each row, and how many there are
};

// A triangle belongs to the first row that it reaches. `corners`: that count, 3, or 6 with those across its
// sides.
TriangleBatches batches_of(const MeshOrder& order, const std::vector<RestTriangle>& triangles,
                           int corners);

}  // namespace weft::physics
