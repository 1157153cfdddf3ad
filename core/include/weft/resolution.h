// The same sheets on coarser or finer grids: what a study of convergence runs, and what a tolerance picks from.
#pragma once

#include <string>
#include <vector>

#include "weft/scene.h"

namespace weft {

// Intervals of a grid along its sides.
struct Intervals {
  int u = 1, v = 1;
  friend bool operator==(const Intervals&, const Intervals&) = default;
};

// The least intervals that have a particle wherever one is held, of a grid: others have them whose intervals are
// multiples of these. Held corners allow any, {1, 1}. The grid's own where no coarser one has them all.
Intervals intervals_of_pins(const Cloth& cloth);

// The cloth, a grid, with so many intervals, 1 … 4095 each: the same sheet, in the same place, of the same mass; of
// springs only where cells keep their shape, for in others they are another material. Throws std::invalid_argument for
// other intervals, and for a mesh.
// - What is held keeps its place on the sheet, to the nearest particle: single particles, the lines between held
//   neighbours, and what lies between four of them. Paths of neighbours with keys at equal times are those between
//   them; other neighbours are held one by one. A particle has one path: where others fall on it, a note says how
//   many are left out.
// - particle_mass and masses are shared out anew; cuts keep their lines.
// `notes`: what is not quite as asked, a sentence each.
struct RegriddedCloth {
  Cloth cloth;
  std::vector<std::string> notes;
};
RegriddedCloth with_intervals(const Cloth& cloth, const Intervals& intervals);

}  // namespace weft
