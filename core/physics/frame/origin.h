// What the positions of a simulation are counted from. Single precision is fine near zero and coarse
// far away: where points are 1 cm apart it knows strain to 1e-4 at 10 m from zero, and not at all at
// 10 km. So a scene whose cloths start far away is simulated about a point among them.
#pragma once

#include "weft/scene.h"

namespace weft::physics {

// Zero for cloths near it, else the middle of where they start, in whole meters.
Vec3 origin_of(const Scene& scene);

}  // namespace weft::physics
