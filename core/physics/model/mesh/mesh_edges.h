// The edges of a mesh as constraints.
#pragma once

#include "physics/model/mesh/rest_triangles.h"
#include "physics/model/tearing.h"
#include "weft/mesh.h"

namespace weft::physics {

struct MeshEdges {
  std::vector<Joined> ends;  // the lesser number first; ascending
  std::vector<double> rest;  // m
  std::vector<double>
      triangles;  // that each is a side of; a spring's stiffness is in proportion to it
};

// `x`: of the vertices at rest [m].
MeshEdges edges_of(const TriangleMesh& mesh, const std::vector<Vec3>& x);

// Gives edges the mean of what they are in their triangles at rest, where these need not agree.
void take_lengths(const std::vector<RestTriangle>& triangles, MeshEdges& edges);

}  // namespace weft::physics
