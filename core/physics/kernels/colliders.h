// Kernels of colliders. A shape's own file in contact/colliders defines them by WEFT_COLLIDER (collide_faces.h).
#pragma once

#include <cstring>
#include <type_traits>

#include "physics/kernels/rows.h"
#include "weft/scene.h"

namespace weft::physics {

// How a surface lies to the particles of a row, now and before the substep, seen from the collider (contact/body).
struct FoundSurface {
  const float* distance;  // m
  ConstRow3 normal;
  const float* distance_before;
  ConstRow3 normal_before;
  ConstRow3 velocity{};  // m/s; of the nearest point, beside the collider's; null: of none
};

// Constants of a collider's shape, about its place (colliders/).
struct ShapeConstants {
  const FoundSurface* found = nullptr;  // of a mesh
  float radius = 0;                     // by which the core is grown (colliders/shapes.h) [m]
  float thin = 0;                       // Shape::half_thickness() [m]
  // What the shape's own kernel needs besides: a struct of floats that both halves of its file know.
  template <class Own>
  void set(const Own& values) {
    static_assert(std::is_trivially_copyable_v<Own> && sizeof(Own) <= sizeof(own));
    std::memcpy(own, &values, sizeof(Own));
  }
  template <class Own>
  Own get() const {
    Own values;
    std::memcpy(&values, own, sizeof(Own));
    return values;
  }
  float own[13] = {};
};

// One collider and one row: particles below the surface are put onto it, with friction.
struct CollideRow {
  int columns;
  Row3 x, v;
  const float* w;
  float dt, inverse_dt;
  float cx, cy, cz;  // where the shape is at the end of the substep [m]
  float ux, uy, uz;  // velocity of that place [m/s]
  // Whether it turns in this substep: what was p off the place as it began has the mean velocity u + turning p (1/s).
  bool turns;
  float turning[3][3];
  float rim;      // m/s; its surface turns about the place no faster
  float offset;   // kept off the surface [m]
  bool resolved;  // the mesh is fine enough for its features
  float friction_static, friction_dynamic;
  float bias;    // m, off the offset surface: within it sliding is damped
  float damped;  // by this share
  ShapeConstants shape;
};

// The triangles between a row and the next, and one collider. bound[a] becomes a lower bound of the
// distance from the offset surface to the two triangles between lanes a and a+1 [m].
struct FacesRow {
  CollideRow row;
  ConstRow3 x_next, v_next;
  float edge;          // m, longest of a flat triangle
  float slack;         // m; bounds above -slack need not be sharp
  float* bound[2];     // of the first and the second triangle of every square
  std::int32_t* room;  // two for each lane of a row, and 16 more
};

// How a row lies to a collider.
struct RowReach {
  float clearance;  // least distance of a free particle from the offset surface [m]
  float speed;      // greatest speed of a free particle, seen from the collider [m/s]
};

// Shapes and responses, in the order of weft::Shape and weft::FrictionModel.
inline constexpr int kShapes = std::variant_size_v<Shape>, kFrictionModels = 2;

// Of one shape.
struct ColliderKernels {
  RowReach (*collide[kFrictionModels])(const CollideRow&);
  RowReach (*below_faces)(const FacesRow&);     // null of a mesh
  RowReach (*damp_sliding)(const CollideRow&);  // clearance from the layer of the bias
};

}  // namespace weft::physics
