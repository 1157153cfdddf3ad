// An independent count of where triangles of cloth pass through each other. It knows nothing of how
// contact is resolved: every edge against every triangle that shares no corner with it, in double.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "weft/scene.h"

namespace weft::physics {

using Face = std::array<std::int32_t, 3>;

// Pairs of an edge and a triangle that it passes through.
std::int64_t count_crossings(const std::vector<Vec3>& x, const std::vector<Face>& faces);

// The two triangles of every square of a sheet, corners numbered from `first` on, row by row.
void add_faces(int columns, int rows, std::int32_t first, std::vector<Face>& faces);

}  // namespace weft::physics
