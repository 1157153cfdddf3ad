// Stage "collider": one collider against one cloth.
#include <cmath>

#include "physics/path.h"
#include "physics/stages/stages.h"

namespace weft::physics {
namespace {

class ColliderStage final : public RowStage {
 public:
  using Kernel = void (*)(const CollideRow&);
  ColliderStage(const ClothParts& parts, const Collider& collider, const std::string& shape,
                Kernel kernel, const CollideRow& constants)
      : RowStage("collider", shape, 0, parts.particles(), "particles"),
        parts_(parts),
        keys_(collider.keys),
        kernel_(kernel),
        constants_(constants) {}

  void run(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    CollideRow r = constants_;
    r.columns = l.columns;
    r.x = l.x.row(j);
    r.v = l.v.row(j);
    r.w = l.w(j);
    r.dt = float(s.dt);
    r.inverse_dt = float(1 / s.dt);
    if (!keys_.empty()) {
      const Vec3 c = position_at(keys_, s.time), u = velocity_over(keys_, s.time, s.dt);
      r.cx = float(c[0]);
      r.cy = float(c[1]);
      r.cz = float(c[2]);
      r.ux = float(u[0]);
      r.uy = float(u[1]);
      r.uz = float(u[2]);
    }
    kernel_(r);
  }

 private:
  ClothParts parts_;
  const std::vector<Key>& keys_;
  Kernel kernel_;
  CollideRow constants_;
};

void place(CollideRow& r, const Vec3& p) {
  r.cx = float(p[0]);
  r.cy = float(p[1]);
  r.cz = float(p[2]);
}

}  // namespace

std::unique_ptr<RowStage> make_collider(const ClothParts& parts, const Collider& collider) {
  const bool course = collider.friction.model == FrictionModel::course;
  CollideRow r{};
  r.friction_static = float(collider.friction.statik);
  r.friction_dynamic = float(collider.friction.dynamic);
  r.offset = float(collider.offset);
  if (const auto* sphere = std::get_if<Sphere>(&collider.shape)) {
    place(r, sphere->center);
    r.radius = float(sphere->radius + collider.offset);
    return std::make_unique<ColliderStage>(
        parts, collider, course ? "sphere, course friction" : "sphere, Coulomb friction",
        course ? parts.kernels.course_sphere : parts.kernels.sphere, r);
  }
  if (const auto* plane = std::get_if<Plane>(&collider.shape)) {
    place(r, plane->point);
    const Vec3& n = plane->normal;
    const double length = std::hypot(n[0], n[1], n[2]);
    r.nx = float(n[0] / length);
    r.ny = float(n[1] / length);
    r.nz = float(n[2] / length);
    return std::make_unique<ColliderStage>(
        parts, collider, course ? "plane, course friction" : "plane, Coulomb friction",
        course ? parts.kernels.course_plane : parts.kernels.plane, r);
  }
  return nullptr;
}

}  // namespace weft::physics
