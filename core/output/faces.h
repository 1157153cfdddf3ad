// The faces of a cloth as files have them, with texture coordinates.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "weft/view.h"

namespace weft {

// All have as many corners: quadrilaterals of a whole grid, else triangles. Corners are particles in scene
// order, those of one face after those of the other.
struct Faces {
  std::size_t corners = 3;
  std::vector<std::int64_t> particles;
  std::vector<std::array<double, 2>> uv;  // each once; none: the mesh has no texture coordinates
  std::vector<std::int64_t> uv_of;        // of every corner, a number in uv
};

// But for the boundary of a tear.
Faces faces_of(const ClothView& cloth);

}  // namespace weft
