// How forces on particles that have just been moved, and corrections of their positions, reach velocities.
#pragma once

#include "physics/model/cloth_model.h"

namespace weft::physics {

// The share of the substep over which constraint forces act.
double implicit_share(const Solver& solver);

// 1/s; corrections times this are what velocities gain by them.
float velocity_gain(const Solver& solver, double dt);

// s; how long a force acts on particles that have just been moved (by springs or predict): as constraints do, for
// the same share of the substep.
double push_time(const ClothParts& parts, double dt);

// Constants of the leapfrog move over one substep.
Advance advance_of(const ClothParts& parts, const Substep& substep);

}  // namespace weft::physics
