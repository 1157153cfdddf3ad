// Colliders as geometry (weft/shape.h): the shapes' own halves, put where the scene has them.
#include "physics/contact/colliders/shapes.h"

#include "physics/contact/body/body_surface.h"
#include "physics/model/path.h"

namespace weft {

using namespace physics;

ShapeMesh triangulate(const Shape& shape) {
  return std::visit(
      [](const auto& s) {
        ShapeMesh mesh = mesh_of(s);
        for (Vec3& p : mesh.positions) p = plus(p, place_of(s));
        return mesh;
      },
      shape);
}

Vec3 place_of(const Shape& shape) {
  return std::visit([](const auto& s) { return place_of(s); }, shape);
}

Shape moved(Shape shape, const Vec3& by) {
  std::visit([&](auto& s) { move(s, by); }, shape);
  return shape;
}

Vec3 displacement(const Collider& collider, double time) {
  if (collider.keys.empty()) return {};
  return minus(position_at(collider.keys, time), place_of(collider.shape));
}

Shape at_time(Shape shape, double time) {
  if (MeshBody* body = std::get_if<MeshBody>(&shape); body && body->motion) body->time = time;
  return shape;
}

double signed_distance(const Collider& collider, double time, const Vec3& point) {
  const Vec3 place =
      collider.keys.empty() ? place_of(collider.shape) : position_at(collider.keys, time);
  return nearest_at(collider.shape, time, minus(point, place)).distance;
}

namespace physics {

Nearest nearest_at(const Shape& shape, double time, const Vec3& p) {
  if (const MeshBody* body = std::get_if<MeshBody>(&shape)) {
    const BodySurface::Point point = body->surface->at(time).nearest(p);
    return {point.distance, point.normal};
  }
  return std::visit([&](const auto& s) { return nearest_of(s, p); }, shape);
}

}  // namespace physics

}  // namespace weft
