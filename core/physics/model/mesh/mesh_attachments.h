// Which pins the vertices of a mesh are tethered to (model/tethers.h): the nearest of up to four groups of
// pins, the pins of a group being joined by edges, at the geodesic distance over the mesh at rest.
//
// Distances spread from the pins as in Dijkstra's algorithm, over edges and straight through triangles: where
// two corners are as far from one pin as they are told, it lies in the plane of the triangle at these
// distances, beyond the side between them, and the third corner is as far as the straight line is long
// (Reimers 2004, "Topics in mesh based modelling"). On a flat mesh
// that is never less than the straight line, and on wild ones 0.3 % more on average, 5 % at most.
#pragma once

#include "physics/model/tethers.h"
#include "weft/mesh.h"

namespace weft::physics {

// `x`: of the vertices at rest [m]; `pins`: numbers of vertices.
std::vector<std::vector<Tether>> mesh_attachments(const TriangleMesh& mesh,
                                                  const std::vector<Vec3>& x,
                                                  const std::vector<int>& pins);

}  // namespace weft::physics
