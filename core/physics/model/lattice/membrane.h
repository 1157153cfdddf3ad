// The membrane energy of a cloth on its grid (kernels/membrane.cpp has the formulas), in double precision
// for what measures and prepares a run, and its constants for the kernels.
#pragma once

#include <vector>

#include "physics/kernels/membrane.h"
#include "physics/model/lattice/lattice.h"
#include "physics/model/lattice/stencil.h"
#include "physics/step/rows.h"

namespace weft::physics {

// The cells of a sheet with what is torn left out: an edge counts while its constraint is there, a cell's
// shear while both of its diagonals are, and the coupling of its strains while all six are.
//
// Stress is C (share e + rate de/dt): 1 and the membrane's damping for the force of a cloth that moves, 0
// and 1 for the pull by small displacements in place of velocities, of a sheet without stress.
class MembraneCells {
 public:
  MembraneCells(const Cloth& cloth, const std::vector<Stencil>& stencils, double repeats = 1);

  // E [J] of particles x, row after row; and of those of a lattice that cannot tear, which costs a fifth.
  double energy(const std::vector<Vec3>& x) const;
  double energy(const Rows& x) const;
  // Adds the force [N] on every particle; velocities v [m/s], or null: none.
  void add_forces(const std::vector<Vec3>& x, const std::vector<Vec3>* v, double share, double rate,
                  std::vector<Vec3>& force) const;
  double damping() const { return membrane_.damping; }
  // For the kernel; as `repeats` makes them.
  MembraneConstants constants(int j) const;

 private:
  struct Cell;
  Cell cell(int i, int j) const;
  // Share of the stiffness that the cells between row j and the next have; 0 where there is no such row.
  double factor(int j) const;

  Membrane membrane_;
  const std::vector<Stencil>& stencils_;
  int columns_, rows_;
  double hu_, hv_, gradient_;
};

}  // namespace weft::physics
