// The stages of colliders: each is one file. `start`: what of the cloth was inside when the two met.
#pragma once

#include "physics/contact/moving_collider.h"
#include "physics/model/lattice/stages.h"

namespace weft::physics {

// A row stage against one collider: where that is, which rows are out of its reach, and what follows when its path
// has changed.
class ColliderRowStage : public RowStage {
 public:
  double idle() const override { return far_.share(); }
  void restart() override { far_.restart(collider_.fastest()); }
  void keep(Keeper& keeper) override { far_.keep(keeper); }
  void follow(const Collider& collider) override {
    if (&collider != &collider_.collider()) return;
    collider_.follow_keys();
    far_.restart(collider_.fastest());
  }
  // Which rows are out of reach.
  const SpeculativeCulling& far() const { return far_; }

 protected:
  // `triangles`: whether it acts on triangles; the others as of RowStage.
  ColliderRowStage(const ClothParts& parts, const Collider& collider, const StartInside& start,
                   bool triangles, std::string name, std::string detail, int rows_reached,
                   std::int64_t touched, std::string item)
      : RowStage(std::move(name), std::move(detail), rows_reached, touched, std::move(item)),
        collider_(parts, collider, start, triangles),
        far_(parts, collider_.fastest()) {}

  MovingCollider collider_;
  SpeculativeCulling far_;
};

// Particles against a collider.
std::unique_ptr<ColliderRowStage> make_collider(const ClothParts& parts, const Collider& collider,
                                                const StartInside& start);
// The layer of a collider's bias; null where its friction does not damp.
std::unique_ptr<RowStage> make_friction_layer(const ClothParts& parts, const Collider& collider,
                                              const StartInside& start);
// Triangles against a collider, right after its particles; none for planes, and where nothing holds the
// corners of triangles together. `particles`: what that stage found.
Stages make_collider_triangles(const LatticeParts& parts, const Collider& collider,
                               const StartInside& start, const SpeculativeCulling& particles);
// The same for the triangles of a mesh; none where the cloth has none.
Stages make_collider_triangles(const ClothParts& parts, const Collider& collider,
                               const StartInside& start, const SpeculativeCulling& particles);
// A collider that cuts.
std::unique_ptr<RowStage> make_cut(const LatticeParts& parts, const Collider& collider,
                                   const StartInside& start);
std::unique_ptr<RowStage> make_cut(const ClothParts& parts, MeshTearing& tearing,
                                   const Collider& collider, const StartInside& start);

}  // namespace weft::physics
