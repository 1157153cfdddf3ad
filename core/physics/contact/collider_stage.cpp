// Stages "collider" and "friction_layer": one collider, or the layer about it in which sliding is damped,
// against the particles of one cloth.
#include "physics/contact/collider_stage.h"

#include "physics/contact/body/body_probe.h"

namespace weft::physics {
namespace {

std::string detail_of(const Collider& c) {
  return std::string(kShapeNames[c.shape.index()]) +
         (c.friction.model == FrictionModel::course ? ", course friction" : ", Coulomb friction") +
         (c.keys.empty() ? "" : ", moving") + (c.rotate.keys.empty() ? "" : ", turning") +
         (c.animation.empty() ? "" : ", animated");
}

class ColliderStage final : public ColliderRowStage {
 public:
  using Kernel = RowReach (*)(const CollideRow&);
  ColliderStage(const ClothParts& parts, const Collider& collider, const StartInside& start,
                const std::string& name, Kernel kernel)
      : ColliderRowStage(parts, collider, start, false, name, detail_of(collider), 0,
                         parts.particles.count(), "particles"),
        parts_(parts),
        kernel_(kernel) {
    if (const BodySurface* surface = surface_of(collider))
      probe_ = std::make_unique<BodyProbe>(*surface, parts);
  }

  void run(int j, const Substep& s) override {
    if (far_.skip(j, s)) return;
    ColliderRow row = collider_.row(parts_, j, s);
    if (probe_) probe_->look(row, j, s);
    far_.found(j, s, kernel_(row));
  }
  void restart() override {
    ColliderRowStage::restart();
    if (probe_) probe_->forget();
  }
  std::size_t bytes() const override { return probe_ ? probe_->bytes() : 0; }

 private:
  ClothParts parts_;
  Kernel kernel_;
  std::unique_ptr<BodyProbe> probe_;  // of a mesh
};

const ColliderKernels& kernels_of(const ClothParts& parts, const Collider& collider) {
  return *parts.kernels.colliders[collider.shape.index()];
}

}  // namespace

std::unique_ptr<ColliderRowStage> make_collider(const ClothParts& parts, const Collider& collider,
                                                const StartInside& start) {
  const auto kernel = kernels_of(parts, collider).collide[std::size_t(collider.friction.model)];
  return std::make_unique<ColliderStage>(parts, collider, start, "collider", kernel);
}

std::unique_ptr<RowStage> make_friction_layer(const ClothParts& parts, const Collider& collider,
                                              const StartInside& start) {
  if (!collider.friction.damps() || collider.cuts) return nullptr;
  return std::make_unique<ColliderStage>(parts, collider, start, "friction_layer",
                                         kernels_of(parts, collider).damp_sliding);
}

}  // namespace weft::physics
