// Constraints that may tear, as kernels see them.
#pragma once

#include "physics/kernels/rows.h"

namespace weft::physics {

// Where the ends of a row's constraints are, or what they have moved by.
struct TearEnds {
  ConstRow3 near, far;  // number a joins near + a and far + a
};

// Constraints of one stencil in one row. What is longer ends.
struct TearRow {
  int count;
  TearEnds x;
  const TearEnds*
      moved;            // two, in the mean of which they are moved from there; null: they are there
  std::int32_t* alive;  // -1 for constraints, 0 for torn ones and beyond the last
  float longest;        // m
};

inline constexpr int kTearBatch = 16;

// Edges of a mesh, whose ends lie in the component arrays at `near` and `far`.
struct alignas(64) TearBatch {
  std::int32_t near[kTearBatch], far[kTearBatch];
  float longest[kTearBatch];  // m², squared; infinite where there is no edge or no more
};

struct TearEdges {
  const TearBatch* batches;
  int count;
  ConstRow3 x;              // of all vertices
  std::uint16_t* overlong;  // of each batch, a bit for each edge
};

}  // namespace weft::physics
