// Stage "tear" of a mesh: edges beyond their tear strain end.
#pragma once

#include "physics/model/mesh/mesh_tearing.h"

namespace weft::physics {

std::unique_ptr<RowStage> make_mesh_tear(const ClothParts& parts, MeshTearing& tearing);

}  // namespace weft::physics
