// Where the lines along which a sheet is cut (Cloth::cuts) cross the edges of its grid, on the flat sheet.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "weft/scene.h"

namespace weft::physics {

using GridPoint = std::array<double, 2>;  // [column, row]

// The share of the way from a to b at which the segment from p to q crosses, none where it does not. A point
// on a line counts as lying on its left, so that of two segments that meet on an edge one crosses it.
std::optional<double> crossing(const GridPoint& a, const GridPoint& b, const GridPoint& p,
                               const GridPoint& q);

// Calls visit(i, j, share) for every pair of particles (i, j) and (i + di, j + dj) of the grid that a line
// passes between; dj >= 0.
using VisitCut = std::function<void(int i, int j, double share)>;
void for_each_cut(const std::vector<CutLine>& cuts, const Grid& grid, int di, int dj,
                  const VisitCut& visit);

}  // namespace weft::physics
