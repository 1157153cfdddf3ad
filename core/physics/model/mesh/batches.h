// Triangles and edges in batches for kernels: those of a batch share no vertex, so that what they add up is
// added in one order, however many lanes go at once.
#pragma once

#include "physics/model/mesh/mesh_order.h"
#include "physics/model/mesh/rest_triangles.h"

namespace weft::physics {

// The vertices that an edge or triangle reaches; -1: none.
using Corners = std::array<int, 6>;

struct MeshBatch;  // kernels/mesh.h

struct Batches {
  std::vector<std::vector<int>> elements;  // of each batch, at most kBatch
  std::vector<int> first;                  // batch of each row, and how many there are
  bool disjoint = false;                   // whether no two elements share a vertex
};

// All triangles. Each belongs to the first row that it reaches. `corners`: that count, 3, or 6 with those
// across its sides.
Batches batches_of(const MeshOrder& order, const std::vector<RestTriangle>& triangles, int corners);

// What kernels know of triangle n of a batch, but for where its corners are.
void set_triangle(MeshBatch& batch, std::size_t n, const RestTriangle& triangle);

// In colours, for sweeps that solve one colour after the other: those of one share no vertex, but where more
// than 32 meet in one. What is left then has the last colour, in which batches alone are disjoint.
std::vector<Batches> coloured_batches(const MeshOrder& order, const std::vector<Corners>& elements);

}  // namespace weft::physics
