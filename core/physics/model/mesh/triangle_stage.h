// Stages of a mesh, row after row of vertices. "triangles": all inner forces and the leapfrog step.
// `tearing`: null where it cannot.
#pragma once

#include "physics/model/mesh/mesh_tearing.h"

namespace weft::physics {

std::unique_ptr<RowStage> make_triangles(const ClothParts& parts, const MeshOrder& order,
                                         const std::vector<RestTriangle>& triangles,
                                         const MeshMaterial& material, MeshTearing* tearing);

// Air on the triangles; null where none acts on cloth. `seed`: of gusts.
std::unique_ptr<RowStage> make_mesh_wind(const ClothParts& parts, const MeshOrder& order,
                                         const std::vector<RestTriangle>& triangles,
                                         std::uint64_t seed, MeshTearing* tearing);

}  // namespace weft::physics
