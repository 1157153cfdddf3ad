// Strands of a mesh: chains of edges that go straight on through their vertices. What lines are to a grid they
// are to a mesh: each is solved as a whole, and a pull goes through all of it at once.
#pragma once

#include "physics/model/mesh/mesh_edges.h"

namespace weft::physics {

struct Strand {
  std::vector<int> vertices;  // in turn; none comes twice
  std::vector<int> edges;     // one fewer
};

// All edges, each in one strand. At a vertex edges are paired by how straight they go on, the straightest pair
// first, none with a bend of more than acos 0.7. `x`: of the vertices at rest [m].
std::vector<Strand> strands_of(const MeshEdges& edges, const std::vector<Vec3>& x);

// In colours: the numbers of strands that share no vertex. The longest come first, in every colour too.
std::vector<std::vector<int>> coloured_strands(const std::vector<Strand>& strands, int vertices);

}  // namespace weft::physics
