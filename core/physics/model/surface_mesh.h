// The surface of a cloth as triangles of particles: what contact, output and viewer can read, whatever
// the cloth is made of. Grids keep faster ways to their own triangles where a kernel wants them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace weft::physics {

struct SurfaceMesh {
  std::vector<std::array<int, 3>> triangles;  // corners by particle number
  std::uint64_t version = 0;                  // rises when they change
  std::vector<std::vector<int>> sewn;         // groups of particles that seams make one
  // Of a mesh that can tear: all triangles, the torn as well, and which of them are gone. Else none.
  std::vector<std::array<int, 3>> whole;
  std::vector<std::uint8_t> gone;

  // As the surface was before anything tore.
  const std::vector<std::array<int, 3>>& all() const { return whole.empty() ? triangles : whole; }
};

// The same by lanes of the component arrays, for views: where each particle is, the triangles' corners, and
// their texture coordinates where the mesh has some.
struct DrawnMesh {
  std::vector<std::uint32_t> lanes;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::span<const std::array<std::array<double, 2>, 3>> uv;
};

}  // namespace weft::physics
