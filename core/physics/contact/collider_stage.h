// The stages of colliders: each is one file. `start`: what of the cloth was inside when the two met.
#pragma once

#include "physics/contact/moving_collider.h"
#include "physics/model/lattice/stages.h"

namespace weft::physics {

// Particles against a collider.
class ParticlesStage : public RowStage {
 public:
  using RowStage::RowStage;
  // Which rows are out of reach.
  virtual const SpeculativeCulling& far() const = 0;
};
std::unique_ptr<ParticlesStage> make_collider(const ClothParts& parts, const Collider& collider,
                                              const StartInside& start);
// The layer of a collider's bias; null where its friction does not damp.
std::unique_ptr<RowStage> make_friction_layer(const ClothParts& parts, const Collider& collider,
                                              const StartInside& start);
// Triangles against a collider, right after its particles; null for planes, and where nothing holds the
// corners of triangles together. `particles`: what that stage found.
std::unique_ptr<RowStage> make_collider_triangles(const LatticeParts& parts,
                                                  const Collider& collider,
                                                  const StartInside& start,
                                                  const SpeculativeCulling& particles);
// The same for the triangles of a mesh; null where the cloth has none.
std::unique_ptr<RowStage> make_collider_triangles(const ClothParts& parts, const Collider& collider,
                                                  const StartInside& start,
                                                  const SpeculativeCulling& particles);
// A collider that cuts.
std::unique_ptr<RowStage> make_cut(const LatticeParts& parts, const Collider& collider,
                                   const StartInside& start);
std::unique_ptr<RowStage> make_cut(const ClothParts& parts, MeshTearing& tearing,
                                   const Collider& collider, const StartInside& start);

}  // namespace weft::physics
