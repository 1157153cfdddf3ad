// Line sweeps over a mesh: strands in the place of lines.
#pragma once

#include "physics/model/mesh/mesh_tearing.h"
#include "physics/model/mesh/strands.h"

namespace weft::physics {

// `stiffness`: of an edge from each of its triangles [N/m]; `x`: of the vertices at rest [m]; `tearing`: null where it cannot.
std::unique_ptr<Stage> make_strands(const ClothParts& parts, const MeshEdges& edges,
                                    double stiffness, const std::vector<Vec3>& x,
                                    MeshTearing* tearing);

}  // namespace weft::physics
