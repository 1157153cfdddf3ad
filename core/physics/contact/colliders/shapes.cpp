// Colliders as geometry (weft/shape.h): the shapes' own halves, put where the scene has them.
#include "physics/contact/colliders/shapes.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/body/body_surface.h"

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

namespace {

template <class One>
void add_of_size(double size, std::vector<Shape>& to) {
  if constexpr (requires { One::of_size(size); }) to.push_back(One::of_size(size));
}

}  // namespace

std::vector<Shape> shapes_of_size(double size) {
  std::vector<Shape> all;
#define WEFT_ADD_SHAPE(Type, name) add_of_size<Type>(size, all);
  WEFT_SHAPES(WEFT_ADD_SHAPE)
#undef WEFT_ADD_SHAPE
  return all;
}

Vec3 place_of(const Shape& shape) {
  return std::visit([](const auto& s) { return place_of(s); }, shape);
}

Shape moved(Shape shape, const Vec3& by) {
  for_each_value(shape, [&](const char*, auto& value, ShapeValue is) {
    if constexpr (std::is_same_v<decltype(value), Vec3&>)
      if (is == ShapeValue::place || is == ShapeValue::point) value = plus(value, by);
  });
  return shape;
}

namespace {

// The core's, grown by its radius.
template <class One>
std::array<Vec3, 2> bounds_about_place(const One& shape) {
  std::array<Vec3, 2> bounds{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t side = 0; side < 2; ++side) {
      Vec3 way{};
      way[k] = side == 0 ? -1 : 1;
      const Vec3 furthest = support_of(shape, way);
      bounds[side][k] = furthest[k] + way[k] * core_of(shape, furthest).radius;
    }
  return bounds;
}

std::array<Vec3, 2> bounds_about_place(const MeshBody& body) {
  const BodyMoment moment = body.surface->at(body.time);
  std::array<Vec3, 2> bounds{moment.vertex(0), moment.vertex(0)};
  for (int vertex = 1; vertex < int(moment.form().of_file.size()); ++vertex)
    for (std::size_t k = 0; k < 3; ++k) {
      bounds[0][k] = std::min(bounds[0][k], moment.vertex(vertex)[k]);
      bounds[1][k] = std::max(bounds[1][k], moment.vertex(vertex)[k]);
    }
  return bounds;
}

}  // namespace

std::optional<std::array<Vec3, 2>> bounds_of(const Shape& shape) {
  return std::visit(
      [](const auto& s) -> std::optional<std::array<Vec3, 2>> {
        if (std::isinf(feature_of(s))) return {};
        std::array<Vec3, 2> bounds = bounds_about_place(s);
        for (Vec3& corner : bounds) corner = plus(corner, place_of(s));
        return bounds;
      },
      shape);
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
