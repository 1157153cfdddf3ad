// The stages of colliders: each is one file. `start`: what of the cloth was inside when the two met.
#pragma once

#include "physics/contact/moving_collider.h"
#include "physics/model/lattice/stages.h"

namespace weft::physics {

// Particles against a collider.
std::unique_ptr<RowStage> make_collider(const ClothParts& parts, const Collider& collider,
                                        const StartInside& start);
// Triangles against a collider; null where the mesh is fine enough for particles alone.
std::unique_ptr<RowStage> make_collider_triangles(const LatticeParts& parts,
                                                  const Collider& collider,
                                                  const StartInside& start);
// A collider that cuts.
std::unique_ptr<RowStage> make_cut(const LatticeParts& parts, const Collider& collider,
                                   const StartInside& start);

}  // namespace weft::physics
