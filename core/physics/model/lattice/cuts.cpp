// Segments against the edges of a grid (cuts.h).
#include "physics/model/lattice/cuts.h"

#include <algorithm>
#include <cmath>

namespace weft::physics {
namespace {

// Twice the area of the triangle; positive where c lies to the left of the way from a to b.
double side(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// The columns that the segment has between two rows.
std::array<double, 2> columns_between(const GridPoint& p, const GridPoint& q, double low,
                                      double high) {
  const auto at = [&](double row) {
    if (p[1] == q[1]) return p[0];
    const double t = std::clamp((row - p[1]) / (q[1] - p[1]), 0.0, 1.0);
    return p[0] + t * (q[0] - p[0]);
  };
  if (p[1] == q[1]) return {std::min(p[0], q[0]), std::max(p[0], q[0])};
  return {std::min(at(low), at(high)), std::max(at(low), at(high))};
}

// Edges that begin in row j and may cross.
void visit_row(const GridPoint& p, const GridPoint& q, const Grid& grid, int di, int dj, int j,
               const VisitCut& visit) {
  const auto [left, right] = columns_between(p, q, j, j + dj);
  const int first = std::max({0, -di, int(std::floor(left)) - std::max(0, di) - 1});
  const int last =
      std::min({grid.nx - 1, grid.nx - 1 - di, int(std::ceil(right)) + std::max(0, -di) + 1});
  for (int i = first; i <= last; ++i)
    if (const auto share = crossing({double(i), double(j)}, {double(i + di), double(j + dj)}, p, q))
      visit(i, j, *share);
}

}  // namespace

std::optional<double> crossing(const GridPoint& a, const GridPoint& b, const GridPoint& p,
                               const GridPoint& q) {
  const double of_a = side(p, q, a), of_b = side(p, q, b);
  if ((of_a >= 0) == (of_b >= 0) || (side(a, b, p) >= 0) == (side(a, b, q) >= 0))
    return std::nullopt;
  return of_a / (of_a - of_b);
}

void for_each_cut(const std::vector<CutLine>& cuts, const Grid& grid, int di, int dj,
                  const VisitCut& visit) {
  for (const CutLine& line : cuts)
    for (std::size_t k = 1; k < line.size(); ++k) {
      const GridPoint &p = line[k - 1], &q = line[k];
      const int first = std::max(0, int(std::floor(std::min(p[1], q[1]))) - dj);
      const int last = std::min(grid.ny - 1 - dj, int(std::ceil(std::max(p[1], q[1]))));
      for (int j = first; j <= last; ++j) visit_row(p, q, grid, di, dj, j, visit);
    }
}

}  // namespace weft::physics
