// The curvature energy of a cloth's `bending` on its grid (kernels/bending.cpp has the formulas),
// in double precision for what measures and prepares a run, and its stiffnesses for the kernels.
#pragma once

#include <vector>

#include "physics/model/lattice/lattice.h"

namespace weft::physics {

// Stiffnesses of second differences along u (rows) and v (columns) and of cell twists [N/m]. A row or
// column of particles stands for as much of the sheet as it does in mass: where the cloth lumps by area,
// differences along the border have width_share() of these.
struct BendingStiffness {
  double along = 0, across = 0, twist = 0;
};
BendingStiffness bending_stiffness(const Cloth& cloth);

// Which terms of a cloth that can tear are left: second differences from (i, j) along the row and the
// column, and the twist of the cell (i, j); as floats, 1 or 0, laid out as the lattice.
struct BendLinks {
  explicit BendLinks(const Lattice& lattice);
  void make_whole();
  std::size_t bytes() const { return 3 * along.size() * sizeof(float); }
  int stride;
  AlignedArray<float> along, across, twist;
};

// E [J] of a sheet with particles x, row after row; `left` null: all of its terms.
double bending_energy(const Cloth& cloth, const std::vector<Vec3>& x,
                      const BendLinks* left = nullptr);

// Calls visit(k, n, particles, coefficients) for every term ½ k |Σ coefficient x|² of E: three or
// four particles each, row-major j*columns + i. `left` null: none is torn.
template <class Visit>
void for_each_bend(const Cloth& cloth, Visit&& visit, const BendLinks* left = nullptr) {
  static constexpr double kDifference[4] = {1, -2, 1, 0}, kTwist[4] = {1, -1, -1, 1};
  const BendingStiffness k = bending_stiffness(cloth);
  const int columns = cloth.grid.nx, rows = cloth.grid.ny;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int p = j * columns + i;
      const int along[4] = {p, p + 1, p + 2, p}, across[4] = {p, p + columns, p + 2 * columns, p};
      const int cell[4] = {p, p + 1, p + columns, p + columns + 1};
      const std::size_t at = left ? std::size_t(j) * left->stride + i : 0;
      const auto there = [&](const AlignedArray<float> BendLinks::*terms) {
        return !left || (left->*terms)[at] != 0;
      };
      if (i + 2 < columns && there(&BendLinks::along))
        visit(k.along * width_share(cloth, i, j, 1, 0), 3, along, kDifference);
      if (j + 2 < rows && there(&BendLinks::across))
        visit(k.across * width_share(cloth, i, j, 0, 1), 3, across, kDifference);
      if (i + 1 < columns && j + 1 < rows && there(&BendLinks::twist))
        visit(k.twist, 4, cell, kTwist);
    }
}

// Adds -∂E/∂x to the force [N]; position(p, c) is component c of particle p.
template <class Position>
void add_bending_forces(const Cloth& cloth, Position&& position, std::vector<Vec3>& force,
                        const BendLinks* left = nullptr) {
  if (!cloth.bending.given()) return;
  const auto add = [&](double k, int n, const int* particles, const double* factor) {
    for (int c = 0; c < 3; ++c) {
      double d = 0;
      for (int q = 0; q < n; ++q) d += factor[q] * position(particles[q], c);
      for (int q = 0; q < n; ++q) force[particles[q]][c] -= k * factor[q] * d;
    }
  };
  for_each_bend(cloth, add, left);
}

}  // namespace weft::physics
