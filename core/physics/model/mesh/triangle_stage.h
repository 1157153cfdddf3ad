// Stage "triangles": all inner forces of a mesh and its leapfrog step, row after row of vertices.
#pragma once

#include "physics/model/mesh/mesh_order.h"
#include "physics/model/mesh/rest_triangles.h"

namespace weft::physics {

std::unique_ptr<RowStage> make_triangles(const ClothParts& parts, const MeshOrder& order,
                                         const std::vector<RestTriangle>& triangles,
                                         const MeshMaterial& material);

}  // namespace weft::physics
