// Constraint stencils: all constraints of a cloth that share one offset on the grid, one rest length
// and one stiffness. A stencil needs no index lists: constraint a of row j joins (a+near, j) and
// (a+far, j+dj).
#pragma once

#include <vector>

#include "physics/kernels/lattice.h"
#include "physics/model/lattice/lattice.h"
#include "weft/scene.h"

namespace weft::physics {

enum class Kind { structural, shear, bend };

// Which constraints of a stencil are still there: -1, or 0 once torn.
class Links {
 public:
  Links(int rows, int stride, int per_row);
  // Wide kernels may read up to 16 lanes before the first row and after the last.
  std::int32_t* row(int j) {
    return lanes_.data() + kGuard + static_cast<std::size_t>(j) * stride_;
  }
  bool alive(int j, int a) const {
    return lanes_[kGuard + static_cast<std::size_t>(j) * stride_ + static_cast<std::size_t>(a)] !=
           0;
  }
  // Takes over the lanes of links of the same shape.
  void copy(const Links& from) { std::copy_n(from.lanes_.data(), lanes_.size(), lanes_.data()); }
  std::size_t bytes() const { return lanes_.size() * sizeof(std::int32_t); }

 private:
  static constexpr std::size_t kGuard = 16;
  std::size_t stride_;
  AlignedArray<std::int32_t> lanes_;
};

struct Stencil {
  int di = 0, dj = 0;  // dj >= 0; di > 0 when dj = 0
  Kind kind = Kind::structural;
  double rest = 0;         // m, on the flat sheet
  double stiffness = 0;    // N/m, in the first row
  double damping = 0;      // N·s/m
  Links* links = nullptr;  // null: the cloth cannot tear

  bool alive(int j, int a) const { return !links || links->alive(j, a); }

  int near() const { return di < 0 ? -di : 0; }
  int far() const { return di > 0 ? di : 0; }
  int per_row(int columns) const { return columns - (di < 0 ? -di : di); }
};

// How often a substep adds each spring's force: positions do not change in between, so this is a factor
// on stiffness and damping.
double spring_repeats(const Solver& solver);

// The stencils of a cloth that exist on its grid: structural, shear and bend of non-zero stiffness,
// or those of its level (seed 000), as stiff as the solver's repeats make them. Of a membrane: the edges
// and diagonals of its cells, as stiff as springs must be to agree with it in all but its coupling, for
// which they have the stiffness of the shear.
std::vector<Stencil> stencils_of(const Cloth& cloth, const Solver& solver = {});

// N/m, of the stiffest constraints between neighbours, without repeats.
double greatest_stiffness(const Cloth& cloth);

// Factor on the stiffness of a stencil's constraints of row j, columns at the sides aside: seed 003's
// stiffness gradient, and a half along a border (weft::width_share).
double row_factor(const Cloth& cloth, const Stencil& stencil, int j);

// Of constraint 0 of a row and those after it: the further factor by their columns; null: all 1.
const float* column_factors(const Lattice& lattice, const Stencil& stencil);

// The ends of a stencil's constraints of row j in positions of `columns` columns; row j+dj must exist.
FarRows far_rows(const Stencil& stencil, const Rows& x, int columns, int j);

// The rows that a stencil's constraints of row j join; row j+dj must exist.
StencilRow stencil_row(Lattice& lattice, const Stencil& stencil, int j);

// Constants of a stencil's springs in row j, zero when row j+dj does not exist.
SpringConstants spring_constants(const Cloth& cloth, const Stencil& stencil, int j);

}  // namespace weft::physics
