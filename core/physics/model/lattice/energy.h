// The physics in double precision, straight from the equations: energies, forces and strains of a
// lattice. Everything that measures or prepares a run uses this; the kernels are what is measured.
#pragma once

#include <algorithm>
#include <vector>

#include "physics/model/cloth_model.h"
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

struct BendLinks;

// E = Σ ½ k (|e| - l)² [J].
double elastic_energy(const Cloth& cloth, const std::vector<Stencil>& stencils,
                      const std::vector<Vec3>& x);

// f = -∂E/∂x [N], plus damping along the springs when velocities are given.
std::vector<Vec3> spring_forces(const Cloth& cloth, const std::vector<Stencil>& stencils,
                                const std::vector<Vec3>& x, const std::vector<Vec3>* v);

// Accelerations by springs, bending (the terms that are `left`, null: all) and gravity, zero for
// pinned particles [m/s²]. Into `a`, which allocates nothing when it is large enough already.
void accelerations(const Vec3& gravity, const Cloth& cloth, const std::vector<Stencil>& stencils,
                   const Lattice& lattice, const BendLinks* left, bool damped,
                   std::vector<Vec3>& a);

// Of the constraints between neighbours along rows and columns.
Strain structural_strain(const Cloth& cloth, const std::vector<Stencil>& stencils,
                         const std::vector<Vec3>& x);

}  // namespace weft::physics
