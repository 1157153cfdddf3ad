// An independent look at where triangles of cloth pass through each other. It knows nothing of how
// contact is resolved: every edge against every triangle that shares no corner with it, in double.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "weft/scene.h"

namespace weft::physics {

class ClothModel;

using Face = std::array<std::int32_t, 3>;
using Edge = std::array<std::int32_t, 2>;  // the lower number first

// An edge and the triangle that it passes through, by its number.
struct Crossing {
  Edge edge;
  std::int32_t face;
};

// In the order of the edges, each of which is named once.
std::vector<Edge> edges_of(const std::vector<Face>& faces);
std::vector<Crossing> find_crossings(const std::vector<Vec3>& x, const std::vector<Face>& faces,
                                     const std::vector<Edge>& edges);
std::int64_t count_crossings(const std::vector<Vec3>& x, const std::vector<Face>& faces);

// The particles of a cloth as they are now, and its triangles, as torn as it is.
void add_surface(const ClothModel& cloth, std::vector<Vec3>& x, std::vector<Face>& faces);

}  // namespace weft::physics
