// The triangles of a mesh as squares (kernels/surface.h), which is what surfaces are measured by. Triangle
// ABC is the square A, B, C, C; every vertex and every edge is owned by one square, so that no contact is
// found twice. A vertex that is no triangle's to own is a square by itself.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "physics/kernels/surface.h"

namespace weft::physics {

struct MeshSquares {
  std::vector<Square> squares;      // those of triangles first
  std::vector<std::uint8_t> owned;  // of every square: kOwnsVertex, kOwnsEdge << the edge
  std::size_t triangles = 0;
};
inline constexpr std::uint8_t kOwnsVertex = 1, kOwnsEdge = 2, kOwnsAll = 15;

// Of triangles with such corners, bodies.
MeshSquares squares_of(std::vector<std::array<std::int32_t, 3>> triangles);

// Whether what was found is between two things that their squares own.
inline bool owns(const SurfaceContact& found, std::uint8_t owner, std::uint8_t neighbour) {
  if (found.kind < 4) return ((found.kind % 2 == 0 ? owner : neighbour) & kOwnsVertex) != 0;
  const int n = (found.kind - 4) / 3, m = (found.kind - 4) % 3;
  return (owner >> n & neighbour >> m & kOwnsEdge) != 0;
}

}  // namespace weft::physics
