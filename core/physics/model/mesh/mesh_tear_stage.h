// Stage "tear" of a mesh: edges beyond their tear strain end.
#pragma once

#include "physics/model/mesh/mesh_tearing.h"

namespace weft::physics {

// Edges are as long as sweeps tell, if any do, and else as they lie.
std::unique_ptr<RowStage> make_mesh_tear(const ClothParts& parts, MeshTearing& tearing,
                                         const MidstLengths& midst);

}  // namespace weft::physics
