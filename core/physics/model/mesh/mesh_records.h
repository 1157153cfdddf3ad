// Records of a mesh's vertices (kernels/mesh_sweep.h): where they lie, and the stages that fill them and take
// what sweeps have found.
#pragma once

#include "physics/kernels/mesh_sweep.h"
#include "physics/model/cloth_model.h"

namespace weft::physics {

// Room for all vertices.
AlignedArray<float> records_of(const Particles& particles);
// Where the record of a vertex begins, and of lane n of the padding behind a row, for what has no vertex.
std::int32_t offset_of(const Particles& particles, int vertex);
std::int32_t offset_of_nobody(const Particles& particles, int row, int n);

// Row j and those that its constraints reach are there after its turn, and stay until they are stored.
std::unique_ptr<RowStage> make_load_records(const ClothParts& parts, AlignedArray<float>& records,
                                            int reach);
// `limit`: corrections are of a substep's end, and change velocities at once. `history`: of the second order, which
// keeps what rounding leaves, else null.
std::unique_ptr<RowStage> make_store_records(const ClothParts& parts, AlignedArray<float>& records,
                                             bool limit, History* history);

}  // namespace weft::physics
