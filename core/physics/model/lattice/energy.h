// The physics in double precision, straight from the equations: energies, forces and strains of a
// lattice. Everything that measures or prepares a run uses this; the kernels are what is measured.
#pragma once

#include <algorithm>
#include <vector>

#include "physics/model/cloth_model.h"
#include "physics/model/lattice/bending.h"
#include "physics/model/lattice/lattice.h"
#include "physics/model/lattice/stencil.h"

namespace weft::physics {

// Calls visit(j, a, b, k) for every constraint of a stencil: particle indices a and b (row-major
// j*columns + i) and stiffness k [N/m].
template <class Visit>
void for_each_constraint(const Cloth& cloth, const Stencil& f, Visit&& visit) {
  const int columns = cloth.grid.nx, rows = cloth.grid.ny;
  for (int j = 0; j + f.dj < rows; ++j) {
    const double k = f.stiffness * row_factor(cloth, f, j);
    for (int n = 0; n < f.per_row(columns); ++n)
      if (f.alive(j, n))
        visit(j * columns + n + f.near(), (j + f.dj) * columns + n + f.far(),
              f.di == 0 ? k * width_share(cloth, n, j, 0, f.dj) : k);
  }
}

// E = Σ ½ k (|e| - l)² [J].
double elastic_energy(const Cloth& cloth, const std::vector<Stencil>& stencils,
                      const std::vector<Vec3>& x);

// f = -∂E/∂x [N], plus damping along the springs when velocities are given.
std::vector<Vec3> spring_forces(const Cloth& cloth, const std::vector<Stencil>& stencils,
                                const std::vector<Vec3>& x, const std::vector<Vec3>* v);

// Adds the forces of all springs of a lattice as it lies [N].
void add_spring_forces(const Cloth& cloth, const std::vector<Stencil>& stencils,
                       const Lattice& lattice, bool damped, std::vector<Vec3>& force);

// Accelerations by what `add_stretch` adds to the forces, by bending (the terms that are `left`, null: all)
// and gravity, zero for pinned particles [m/s²]. Into `a`, which allocates nothing when it is large enough
// already.
template <class AddStretch>
void accelerations(const Vec3& gravity, const Cloth& cloth, const Lattice& l, const BendLinks* left,
                   AddStretch&& add_stretch, std::vector<Vec3>& a) {
  a.assign(std::size_t(l.columns) * l.rows, Vec3{});
  add_stretch(a);
  add_bending_forces(
      cloth, [&](int p, int c) { return double(l.x.at(c, p / l.columns, p % l.columns)); }, a,
      left);
  for (int j = 0; j < l.rows; ++j)
    for (int i = 0; i < l.columns; ++i) {
      const double w = l.w(j, i);
      Vec3& f = a[std::size_t(j) * l.columns + i];
      for (int c = 0; c < 3; ++c) f[c] = w > 0 ? f[c] * w + gravity[c] : 0;
    }
}

// Of the constraints between neighbours along rows and columns.
Strain structural_strain(const Cloth& cloth, const std::vector<Stencil>& stencils,
                         const std::vector<Vec3>& x);

}  // namespace weft::physics
