// An independent look at where triangles of cloth pass through each other. It knows nothing of how
// contact is resolved: every edge against every triangle that shares no corner with it, in double. Corners that
// seams make one are shared.
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
// `sewn`: of every particle, one that stands for all that seams make one with it; empty: each for itself.
std::vector<Crossing> find_crossings(const std::vector<Vec3>& x, const std::vector<Face>& faces,
                                     const std::vector<Edge>& edges,
                                     const std::vector<std::int32_t>& sewn = {});
std::int64_t count_crossings(const std::vector<Vec3>& x, const std::vector<Face>& faces,
                             const std::vector<std::int32_t>& sewn = {});

// The particles of a cloth as they are now, and its triangles, as torn as it is.
void add_surface(const ClothModel& cloth, std::vector<Vec3>& x, std::vector<Face>& faces);
// Of the same particles, who stands for them.
void add_sewn(const ClothModel& cloth, std::vector<std::int32_t>& sewn);

}  // namespace weft::physics
