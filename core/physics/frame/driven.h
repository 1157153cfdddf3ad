// What moves cloths besides gravity and their own constraints, as far as scene and models tell.
#pragma once

#include "physics/frame/cloth_step.h"

namespace weft::physics {

// Whether pins or bodies move, wind blows, gravity changes, seams draw their ends together, or a load changes.
bool is_driven(const Scene& scene, const Cloths& cloths);

// Whether anything but gravity that stays the same and pins, whether they move or not, can do work: wind,
// bodies, seams, loads.
bool is_acted_on(const Scene& scene, const Cloths& cloths);

}  // namespace weft::physics
