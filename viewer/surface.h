// The cloth as it is drawn: a smooth surface through the particles and its normals, and what some
// looks show on it. Arrays of components, so that whole rows are computed at once.
#pragma once

#include <vector>

#include "snapshot.h"

namespace weft::viewer {

// A lattice of columns * rows vertices without padding; each cell of the cloth's grid is cut into
// refinement * refinement.
struct ClothSurface {
  int refinement = 1;
  int columns = 0, rows = 0;
  std::vector<float> x, y, z;     // m
  std::vector<float> nx, ny, nz;  // not of unit length
  std::vector<float> fx, fy, fz;  // N; empty unless asked for
  std::vector<float> strain;      // empty unless asked for
};

// As many vertices as make a coarse grid look smooth.
int chosen_refinement(int columns, int rows);

// Catmull-Rom patches through the particles; normals by central differences.
void build_surface(const ClothCopy& cloth, int refinement, ClothSurface& surface);

// Adds to the surface the force of the springs on each particle [N] by Hooke's law.
void add_forces(const ClothCopy& cloth, const Cloth& description, ClothSurface& surface);

// Adds the greatest strain |length / rest - 1| of the structural constraints at each particle.
void add_strains(const ClothCopy& cloth, const Cloth& description, ClothSurface& surface);

// The offsets on the grid of each kind of constraint that the cloth has.
struct Offset {
  int di, dj;
};
struct Offsets {
  std::vector<Offset> structural, shear, bend;
};
Offsets offsets_of(const Cloth& description);

}  // namespace weft::viewer
