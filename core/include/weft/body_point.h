// Points that go with the surface of a body, however it turns, bends and grows.
#pragma once

#include <array>

#include "weft/scene.h"

namespace weft {

// A point beside a triangle of a body.
struct BodyPoint {
  int triangle = 0;
  std::array<double, 3> weights{1, 0, 0};  // of the triangle's corners: its own nearest point
  Vec3 off{};  // from there, along the triangle's first edge, across that, and along its normal [m]
};

// A place beside a collider, which is a mesh and read, by the point of its surface that is nearest at a time [s].
BodyPoint body_point(const Collider& collider, double time, const Vec3& place);

// Where such a point is at another time [m]: beside the same point of the triangle, as far off, turned with it.
Vec3 position_of(const Collider& collider, double time, const BodyPoint& point);

}  // namespace weft
