// Colliders as geometry (weft/shape.h): the shapes' own halves, put where the scene has them.
#include "physics/contact/colliders/shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/contact/body/body_surface.h"
#include "physics/model/placement.h"

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
  const Matrix turn = matrix_of(body.turn);
  const auto at = [&](int vertex) {
    return body.turn == Vec3{} ? moment.vertex(vertex) : times(turn, moment.vertex(vertex));
  };
  std::array<Vec3, 2> bounds{at(0), at(0)};
  for (int vertex = 1; vertex < int(moment.form().of_file.size()); ++vertex) {
    const Vec3 p = at(vertex);
    for (std::size_t k = 0; k < 3; ++k) {
      bounds[0][k] = std::min(bounds[0][k], p[k]);
      bounds[1][k] = std::max(bounds[1][k], p[k]);
    }
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

Shape turned(Shape shape, const Matrix& turn, const Vec3& about) {
  for_each_value(shape, [&](const char*, auto& value, ShapeValue is) {
    if constexpr (std::is_same_v<decltype(value), Vec3&>) {
      if (is == ShapeValue::place || is == ShapeValue::point)
        value = plus(about, times(turn, minus(value, about)));
      if (is == ShapeValue::direction) value = times(turn, value);
      if (is == ShapeValue::angles) value = angles_of(times(turn, matrix_of(value)));
    }
  });
  return shape;
}

Vec3 displacement(const Collider& collider, double time) {
  return minus(Placement(collider, time).place, place_of(collider.shape));
}

// The surface of a mesh is made with its own angles: it has this turn besides.
Shape shape_at(const Collider& collider, double time) {
  const Placement now(collider, time);
  const Vec3 start = place_of(collider.shape);
  Shape shape = collider.shape;
  if (now.turned) {
    if (MeshBody* body = std::get_if<MeshBody>(&shape))
      body->turn = angles_of(now.turn);
    else
      shape = turned(shape, now.turn, start);
  }
  return at_time(moved(shape, minus(now.place, start)), time);
}

Shape at_time(Shape shape, double time) {
  if (MeshBody* body = std::get_if<MeshBody>(&shape); body && body->motion) body->time = time;
  return shape;
}

double signed_distance(const Collider& collider, double time, const Vec3& point) {
  return nearest_at(collider.shape, time, Placement(collider, time).seen(point)).distance;
}

namespace physics {

// Of a box about the shape as it stands at the start, and of how far its animation ever takes it.
double lever_of(const Collider& collider, const Vec3& about) {
  const Vec3& along = collider.rotate.axis;
  const Vec3 axis = times(along, 1 / length(along));
  if (const Plane* plane = std::get_if<Plane>(&collider.shape)) {
    constexpr double kAlong = 1e-12;  // sine, beyond rounding
    const bool itself = length(cross(axis, plane->normal)) <= kAlong * length(plane->normal);
    return itself ? 0 : std::numeric_limits<double>::infinity();
  }
  const std::array<Vec3, 2> bounds = *bounds_of(collider.shape);
  double most = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Vec3 p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = bounds[(corner >> k) & 1][k];
    most = std::max(most, length(cross(axis, minus(p, about))));
  }
  const BodySurface* body = surface_of(collider);
  return most + collider.offset + (body ? body->travel(0, 1e9) : 0);
}

Nearest nearest_at(const Shape& shape, double time, const Vec3& p) {
  if (const MeshBody* body = std::get_if<MeshBody>(&shape)) return nearest_of(*body, time, p);
  return std::visit([&](const auto& s) { return nearest_of(s, p); }, shape);
}

}  // namespace physics

}  // namespace weft
