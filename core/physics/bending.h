// The curvature energy of a cloth's `bending` on its grid (kernels/bending.cpp has the formulas),
// in double precision for what measures and prepares a run, and its stiffnesses for the kernels.
#pragma once

#include <vector>

#include "physics/lattice.h"

namespace weft::physics {

// Stiffnesses of second differences along u (rows) and v (columns) and of cell twists [N/m]. Every
// row and column of particles stands for an equal share of the sheet, as it does in mass.
struct BendingStiffness {
  double along = 0, across = 0, twist = 0;
};
BendingStiffness bending_stiffness(const Cloth& cloth);

// E [J] of a sheet with particles x, row after row.
double bending_energy(const Cloth& cloth, const std::vector<Vec3>& x);

// Calls visit(k, n, particles, coefficients) for every term ½ k |Σ coefficient x|² of E: three or
// four particles each, row-major j*columns + i.
template <class Visit>
void for_each_bend(const Cloth& cloth, Visit&& visit) {
  static constexpr double kDifference[4] = {1, -2, 1, 0}, kTwist[4] = {1, -1, -1, 1};
  const BendingStiffness k = bending_stiffness(cloth);
  const int columns = cloth.grid.nx, rows = cloth.grid.ny;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const int p = j * columns + i;
      const int along[4] = {p, p + 1, p + 2, p}, across[4] = {p, p + columns, p + 2 * columns, p};
      const int cell[4] = {p, p + 1, p + columns, p + columns + 1};
      if (i + 2 < columns) visit(k.along, 3, along, kDifference);
      if (j + 2 < rows) visit(k.across, 3, across, kDifference);
      if (i + 1 < columns && j + 1 < rows) visit(k.twist, 4, cell, kTwist);
    }
}

// Adds -∂E/∂x to the force [N]; position(p, c) is component c of particle p.
template <class Position>
void add_bending_forces(const Cloth& cloth, Position&& position, std::vector<Vec3>& force) {
  if (cloth.bending == 0) return;
  for_each_bend(cloth, [&](double k, int n, const int* particles, const double* factor) {
    for (int c = 0; c < 3; ++c) {
      double d = 0;
      for (int q = 0; q < n; ++q) d += factor[q] * position(particles[q], c);
      for (int q = 0; q < n; ++q) force[particles[q]][c] -= k * factor[q] * d;
    }
  });
}

}  // namespace weft::physics
