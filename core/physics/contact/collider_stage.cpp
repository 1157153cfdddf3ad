// Stage "collider": one collider against the particles of one cloth.
#include "physics/contact/collider_stage.h"

namespace weft::physics {
namespace {

std::string detail_of(const Collider& c) {
  return std::string(kShapeNames[c.shape.index()]) +
         (c.friction.model == FrictionModel::course ? ", course friction" : ", Coulomb friction") +
         (c.keys.empty() ? "" : ", moving");
}

class ColliderStage final : public ParticlesStage {
 public:
  ColliderStage(const ClothParts& parts, const Collider& collider, const StartInside& start)
      : ParticlesStage("collider", detail_of(collider), 0, parts.particles.count(), "particles"),
        parts_(parts),
        collider_(parts, collider, start),
        far_(parts, collider_.fastest()),
        kernel_(parts.kernels.collider[collider.shape.index()]
                    ->collide[std::size_t(collider.friction.model)]) {}

  void run(int j, const Substep& s) override {
    if (far_.skip(j, s)) return;
    far_.found(j, s, kernel_(collider_.row(parts_, j, s)));
  }
  const SpeculativeCulling& far() const override { return far_; }
  double idle() const override { return far_.share(); }
  void restart() override { far_.restart(collider_.fastest()); }
  void follow(const Collider& collider) override {
    if (&collider != &collider_.collider()) return;
    collider_.follow_keys();
    far_.restart(collider_.fastest());
  }

 private:
  ClothParts parts_;
  MovingCollider collider_;
  SpeculativeCulling far_;
  RowReach (*kernel_)(const CollideRow&);
};

}  // namespace

std::unique_ptr<ParticlesStage> make_collider(const ClothParts& parts, const Collider& collider,
                                              const StartInside& start) {
  return std::make_unique<ColliderStage>(parts, collider, start);
}

}  // namespace weft::physics
