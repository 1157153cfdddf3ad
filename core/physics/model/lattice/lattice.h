// The particles of a grid: every row has as many columns.
#pragma once

#include "physics/model/particles.h"
#include "weft/scene.h"

namespace weft::physics {

struct Lattice : Particles {
  Lattice(int column_count, int row_count, bool keep_previous)
      : Particles(std::vector<int>(std::size_t(row_count), column_count), keep_previous),
        columns(column_count) {}
  int columns;
};

// The particles of a cloth at rest at the start, jittered along the sheet's normal by `seed`.
Lattice make_lattice(const Cloth& cloth, int cloth_index, std::uint64_t seed, bool keep_previous);

}  // namespace weft::physics
