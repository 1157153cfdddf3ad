// Colliders as geometry: for drawing them, and for asking how far a point is from one.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include "weft/scene.h"
#include "weft/turn.h"

namespace weft {

// Triangles of a closed surface (a plane: of a square about its point; a mesh: its own, open or closed),
// counter-clockwise seen from outside, in the scene's coordinates without the collider's keys and rotation.
struct ShapeMesh {
  std::vector<Vec3> positions;  // m
  std::vector<Vec3> normals;    // unit, outward, one for each position
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
ShapeMesh triangulate(const Shape& shape);

// Calls visit(key, value, ShapeValue) for each value of a shape (weft/shapes/value.h).
template <class AnyShape, class Visit>
void for_each_value(AnyShape& shape, Visit&& visit) {
  std::visit([&](auto& one) { std::decay_t<decltype(one)>::values(one, visit); }, shape);
}

// One of each shape that does not come from a file, about the origin, `size` [m] across.
std::vector<Shape> shapes_of_size(double size);

// The point that a collider's keys move: ShapeValue::place.
Vec3 place_of(const Shape& shape);
// The corners of the least box about the shape [m]; none of a plane.
std::optional<std::array<Vec3, 2>> bounds_of(const Shape& shape);
// The shape moved by so much [m].
Shape moved(Shape shape, const Vec3& by);

// The shape turned about a point [m].
Shape turned(Shape shape, const Matrix& turn, const Vec3& about);

// The shape as it is at a time [s] by its animation, where it has one.
Shape at_time(Shape shape, double time);
// The shape of a collider as it stands at a time [s]: animated, turned and moved.
Shape shape_at(const Collider& collider, double time);

// How far the place of a collider has moved by its rotation and its keys at `time` [m].
Vec3 displacement(const Collider& collider, double time);

// Whether the mesh of a cloth, at rest, is fine enough for a collider's features. Where it is not, the collider
// could slip through between particles, and triangles are kept out of it as well.
bool resolves(const Cloth& cloth, const Collider& collider);

// Signed distance of a point from a collider's surface at `time` [m], negative inside (never of an open
// mesh); without the collider's offset.
double signed_distance(const Collider& collider, double time, const Vec3& point);

}  // namespace weft
