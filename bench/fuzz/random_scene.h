// Valid scenes from a number: features together at random.
#pragma once

#include "draw.h"

namespace fuzz {

// About how much a substep costs: in particles that plain springs are worked out for.
double work_of_substep(const weft::Scene& scene);

// The scene of a seed. validate() accepts it, and a frame of it is little work.
weft::Scene random_scene(std::uint64_t seed);

// The scene with a few of its values drawn anew; grids stay. validate() accepts it.
weft::Scene changed_scene(const weft::Scene& scene, Draw& draw);

// A point near a cloth of the scene [m].
Vec3 point_near(const weft::Scene& scene, Draw& draw);

}  // namespace fuzz
