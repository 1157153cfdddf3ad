// The cloth as it is drawn: a smooth surface through the particles and its normals, and what some
// looks show on it. Arrays of components, so that whole rows are computed at once.
#pragma once

#include <vector>

#include "picture/frame_data.h"

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
  // Triangles, in a fixed place for each piece of each square; what is torn is a point. Follows
  // triangulate().
  std::vector<std::uint32_t> indices;
  // Triangles beside the tears; their vertices come after those of the lattice.
  std::vector<std::uint32_t> tear_indices;
  // Sides of triangles that no other triangle has, follow find_border(); and the band along them, whose vertices
  // come last, each with what `rim_of` it has.
  std::vector<std::array<std::uint32_t, 2>> border;
  std::vector<std::uint32_t> rim_indices, rim_of;
};

// How many vertices there are for a square of the grid, or squares for a vertex: a coarse grid is
// refined, a very fine one thinned out, to about `detail` vertices along a side.
struct Sampling {
  int refinement = 1, step = 1;
  friend bool operator==(const Sampling&, const Sampling&) = default;
};
Sampling sampling_of(const ClothCopy& cloth, int detail);

// Every step-th particle and the last ones; the cloth is whole.
ClothCopy thinned(const ClothCopy& cloth, int step);
std::vector<float> thinned(const std::vector<float>& values, const ClothCopy& cloth, int step);

// Sets the size of the surface.
void size_surface(const ClothCopy& cloth, int refinement, ClothSurface& surface);

// Catmull-Rom patches through the particles; normals by central differences.
void build_surface(const ClothCopy& cloth, ClothSurface& surface);

// The triangles of a cloth, whole or torn, on a surface whose size is set.
void triangulate(const ClothCopy& cloth, ClothSurface& surface);

// build_surface() for a mesh, and for a torn cloth; the triangles are there already.
void build_mesh_surface(const ClothCopy& cloth, ClothSurface& surface);
void build_torn_surface(const ClothCopy& cloth, ClothSurface& surface);

// Adds the vertices beside the tears to a surface that is complete otherwise.
void add_tear_boundary(const ClothCopy& cloth, ClothSurface& surface);
// How thick a cloth is [m]: as far as its layers keep apart, or, where they do not meet, as fabrics of its weight are.
float thickness_of(const Cloth& cloth);
// Finds where the cloth ends, by the triangles of a surface that is complete otherwise. Between a triangle beside a
// tear and its neighbours, which have vertices of their own, the cloth ends, too: bands there are within the cloth.
void find_border(ClothSurface& surface);
// Adds the band along the border, from half of the width [m] on one side of the surface to half on the other.
void add_rim(float width, ClothSurface& surface);
// The vertex of the lattice for a particle, j*stride + i.
std::size_t vertex_of(const ClothCopy& cloth, const ClothSurface& surface, std::uint32_t particle);

// The sides of the triangles of a mesh, each once.
std::vector<std::array<std::uint32_t, 2>> edges_of(const ClothCopy& mesh);

// About how far neighbours are apart at rest [m].
double spacing_of(const Cloth& cloth);

// Adds to the surface of the thinned cloth the force of the springs on each particle [N] by Hooke's
// law. Of a mesh, whose forces are not those of springs alone: zero.
void add_forces(const ClothCopy& cloth, const Cloth& description, int step, ClothSurface& surface);

// Adds the greatest strain |length / rest - 1| of the structural constraints at each particle.
void add_strains(const ClothCopy& cloth, const Cloth& description, int step, ClothSurface& surface);

// The offsets on the grid of each kind of constraint that the cloth has.
struct Offset {
  int di, dj;
};
struct Offsets {
  std::vector<Offset> structural, shear, bend;
};
Offsets offsets_of(const Cloth& description);

}  // namespace weft::viewer
