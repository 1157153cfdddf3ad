// What the kernels of bodies that are meshes take (near_triangles.cpp).
#pragma once

#include <cstdint>

#include "physics/kernels/kernel_list.h"

namespace weft::physics {

// Triangles that go straight on, as rows of floats, `stride` apart: the components of one corner after another,
// seen from a place [m].
struct TrianglesOnWay {
  int stride;         // how many there are, a multiple of 16
  const float* from;  // nine rows
  const float* way;   // nine rows, how far they go; null: they stand
  float share;        // of the way that is behind them
  float rounding;     // m, of the positions
  float* placed;      // out: kPlacedRows rows, what distances from them take
};
inline constexpr int kPlacedRows = 22;

// Some of them, and a point.
struct TrianglesAbout {
  int stride;
  const float* placed;
  const std::int32_t* numbers;  // of the triangles
  int first, count;             // the first is a multiple of 16
  float x, y, z;                // m
  float slack;                  // m; distances are known to that
  float* squares;               // room for all of them, and 16 lanes [m²]
  std::int32_t* nearest;        // out: the numbers of those that may be nearest, and 16 lanes
};
struct NearestOfThem {
  int count;
  float distance;  // m, of the nearest
};

// `place_triangles`: how exactly distances from them are known [m].
#define WEFT_BODY_KERNELS(KERNEL)                         \
  KERNEL(float, place_triangles, (const TrianglesOnWay&)) \
  KERNEL(NearestOfThem, nearest_triangles, (const TrianglesAbout&))

struct BodyKernels {
  WEFT_BODY_KERNELS(WEFT_KERNEL_MEMBER)
};

}  // namespace weft::physics
