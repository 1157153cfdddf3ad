// Colliders as geometry (weft/shape.h): the shapes' own halves, put where the scene has them.
#include "physics/contact/colliders/shapes.h"

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

double signed_distance(const Collider& collider, double time, const Vec3& point) {
  return std::visit(
      [&](const auto& s) {
        const Vec3 place = collider.keys.empty() ? place_of(s) : position_at(collider.keys, time);
        return nearest_of(s, minus(point, place)).distance;
      },
      collider.shape);
}

}  // namespace weft
