// What of a cloth lies inside a collider when the two meet.
#pragma once

#include "physics/contact/moving_collider.h"

namespace weft::physics {

// Sheets that lie on a surface start no deeper [m].
inline constexpr double kTouchingStart = 1e-4;

// Particles, and triangles where those catch the collider, at a time [s].
StartInside start_inside(const ClothParts& parts, const Collider& collider, double time);

}  // namespace weft::physics
