// The shapes of colliders. Each is one file in this folder with two halves: its wide signed
// distance, built once per instruction set (kernels/collide.h), and what is needed of it elsewhere,
// below. Everything is about the shape's place: the point that its keys move.
#pragma once

#include <cmath>

#include "physics/kernels/colliders.h"
#include "weft/scene.h"
#include "weft/shape.h"
#include "weft/vec3.h"

namespace weft::physics {

// Signed distance [m] (negative inside) and the outward unit normal.
struct Nearest {
  double distance = 0;
  Vec3 normal{0, 1, 0};
};

// How far, and where to, a triangle must move to leave a core that it cuts; no depth when it does
// not.
struct Overlap {
  double depth = 0;  // m
  Vec3 normal{0, 1, 0};
};
using Triangle = std::array<Vec3, 3>;

// The shape as a core that is grown by a radius: its point nearest to p.
struct Core {
  Vec3 nearest{};
  double radius = 0;
};

#define WEFT_SHAPE(Shape, name)                              \
  ShapeConstants constants_of(const Shape& shape);           \
  Nearest nearest_of(const Shape& shape, const Vec3& p);     \
  Core core_of(const Shape& shape, const Vec3& p);           \
  Vec3 support_of(const Shape& shape, const Vec3& way);      \
  Overlap overlap_of(const Shape& shape, const Triangle& t); \
  double feature_of(const Shape& shape);                     \
  ShapeMesh mesh_of(const Shape& shape);
// constants_of: for the kernels; nearest_of, core_of: seen from p, in double; support_of: the point of
// the core that lies furthest along `way`; overlap_of: of the core and a triangle; feature_of: its
// smallest radius of curvature, infinite for a plane [m]; mesh_of: triangles for drawing. A mesh has no
// core: instead of these, its edges and corners are looked at (body/body_triangle.h).
WEFT_SHAPES(WEFT_SHAPE)
#undef WEFT_SHAPE

// Of a mesh at a time [s] of its animation.
Nearest nearest_of(const MeshBody& body, double time, const Vec3& p);

// The box's own axes in the scene: turned about x, then y, then z.
std::array<Vec3, 3> axes_of(const Box& box);

// Where it stands without keys.
template <class One>
Vec3 place_of(const One& shape) {
  Vec3 place{};
  One::values(shape, [&](const char*, const auto& value, ShapeValue is) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Vec3>)
      if (is == ShapeValue::place) place = value;
  });
  return place;
}

// The surface of a collider that is a mesh; null of others.
inline const BodySurface* surface_of(const Collider& collider) {
  const MeshBody* body = std::get_if<MeshBody>(&collider.shape);
  return body ? body->surface.get() : nullptr;
}

// Of a collider, by how its animation has it at a time [s], from p as it sees it (Placement::seen()).
Nearest nearest_at(const Shape& shape, double time, const Vec3& p);

// How far the surface of a collider, without its keys, is from a line along the axis of its rotation at most [m].
// Infinite of a plane, but 0 where the plane goes through itself as it turns.
double lever_of(const Collider& collider, const Vec3& about);

// Whether what is left across an axis, of a way v from a point of it, is rounding alone: no direction.
inline bool is_rounding(const Vec3& across, const Vec3& v) {
  constexpr double kRounding = 1e-24;  // of its square
  return !(dot(across, across) > kRounding * dot(v, v));
}

// Two unit vectors across a unit one; after it they are right-handed.
inline std::array<Vec3, 2> across(const Vec3& axis) {
  const Vec3 other = std::abs(axis[0]) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 0, 1};
  const Vec3 square = minus(other, times(axis, dot(axis, other)));
  const Vec3 aside = times(square, 1 / length(square));
  return {aside, cross(axis, aside)};
}

// Adds a surface of `across` by `along` quads between points point(u, v), 0 <= u, v <= 1, with
// normals normal(u, v); seen from outside, u runs to the right and v up.
template <class Point, class Normal>
void add_patch(ShapeMesh& mesh, int across, int along, Point&& point, Normal&& normal) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (int b = 0; b <= along; ++b)
    for (int a = 0; a <= across; ++a) {
      const double u = double(a) / across, v = double(b) / along;
      mesh.positions.push_back(point(u, v));
      mesh.normals.push_back(normal(u, v));
    }
  const auto row = static_cast<std::uint32_t>(across + 1);
  for (std::uint32_t b = 0; b < std::uint32_t(along); ++b)
    for (std::uint32_t a = 0; a < std::uint32_t(across); ++a) {
      const std::uint32_t p = first + b * row + a;
      mesh.triangles.push_back({p, p + 1, p + row});
      mesh.triangles.push_back({p + 1, p + row + 1, p + row});
    }
}

}  // namespace weft::physics
