// Which pins the particles of a grid are tethered to (model/tethers.h).
//
// The sheet is a flat parallelogram at rest, so the distance over it is the straight one on the
// grid. Of all pins a particle is tethered to the nearest in each of the four quadrants around it:
// pins on different sides hold it in different directions, and one behind a nearer pin of the same
// quadrant adds little. For nearly inextensible cloth only: real stretch would be taken back.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "physics/kernels/second_order.h"
#include "physics/model/lattice/stages.h"
#include "physics/model/tethers.h"

namespace weft::physics {
namespace {

struct Place {
  int i = -1, j = -1;
  bool operator==(const Place&) const = default;
};

// Of the distance over the sheet [m²].
double squared_distance(const Grid& g, const Place& p, int i, int j) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    const double e = g.u[k] / (g.nx - 1) * (p.i - i) + g.v[k] / (g.ny - 1) * (p.j - j);
    sum += e * e;
  }
  return sum;
}

// The nearest pin of one quadrant for every particle, handed on from neighbour to neighbour.
std::vector<Place> nearest(const LatticeParts& parts, int side_i, int side_j) {
  const Lattice& l = parts.lattice;
  std::vector<Place> best(std::size_t(l.columns) * l.rows);
  for (const Pin& pin : parts.cloth.pins)
    best[std::size_t(pin.j) * l.columns + pin.i] = {pin.i, pin.j};
  const auto squared = [&](const Place& p, int i, int j) {
    return p.i < 0 ? std::numeric_limits<double>::infinity()
                   : squared_distance(parts.cloth.grid, p, i, j);
  };
  for (int b = 0; b < l.rows; ++b)
    for (int a = 0; a < l.columns; ++a) {
      const int i = side_i > 0 ? l.columns - 1 - a : a, j = side_j > 0 ? l.rows - 1 - b : b;
      Place& here = best[std::size_t(j) * l.columns + i];
      for (const auto& [di, dj] :
           {std::array{side_i, 0}, std::array{0, side_j}, std::array{side_i, side_j}}) {
        const int ni = i + di, nj = j + dj;
        if (ni < 0 || nj < 0 || ni >= l.columns || nj >= l.rows) continue;
        const Place& there = best[std::size_t(nj) * l.columns + ni];
        if (squared(there, i, j) < squared(here, i, j)) here = there;
      }
    }
  return best;
}

}  // namespace

std::unique_ptr<RowStage> make_attachments(const LatticeParts& parts, Rows& corrections) {
  const Lattice& l = parts.lattice;
  if (parts.cloth.pins.empty()) return nullptr;
  std::array<std::vector<Place>, kTethers> found{nearest(parts, -1, -1), nearest(parts, 1, -1),
                                                 nearest(parts, -1, 1), nearest(parts, 1, 1)};
  std::vector<std::vector<Tether>> slots;
  for (int p = 0; p < l.count(); ++p) {
    const int i = p % l.columns, j = p / l.columns;
    if (l.w(j, i) == 0) continue;
    for (std::size_t q = 0; q < kTethers; ++q) {
      const Place place = found[q][std::size_t(p)];
      const bool again = std::any_of(found.begin(), found.begin() + std::ptrdiff_t(q),
                                     [&](auto& f) { return f[std::size_t(p)] == place; });
      if (place.i < 0 || again) continue;
      const double reach = std::sqrt(squared_distance(parts.cloth.grid, place, i, j));
      add_tether(slots, l.count(), p, {l.number(place.j, place.i), reach});
    }
  }
  return make_tethers(parts, slots, corrections);
}

}  // namespace weft::physics
