// What of a cloth lies inside a collider, when the two meet and later.
#pragma once

#include <span>

#include "physics/contact/moving_collider.h"

namespace weft::physics {

// Sheets that lie on a surface start no deeper [m].
inline constexpr double kTouchingStart = 1e-4;

// Particles, and triangles where those catch the collider, at a time [s].
StartInside start_inside(const ClothParts& parts, const Collider& collider, double time);

// How deep the deepest point of a cloth lies below the surface of a collider at a time [s], its offset left
// aside; 0 where all are out of it [m]. Points within triangles count where they lie deeper than the cloth's
// mesh lets triangles lie (AllowedDepth) by more than a fiftieth of an edge at rest.
double deepest_in(const Cloth& cloth, const Collider& collider, double time,
                  std::span<const Vec3> x, std::span<const std::array<std::int32_t, 3>> triangles);

}  // namespace weft::physics
