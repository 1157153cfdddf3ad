// How forces on particles that have just been moved, and corrections of their positions, reach velocities.
#pragma once

#include "physics/model/cloth_model.h"

namespace weft::physics {

// The share of the substep over which constraint forces act.
double implicit_share(const Solver& solver);

// Where velocities get what the sweeps did from: from how far particles were moved, or, where rounding
// of positions over dt would show, from every correction as it is computed (which costs a line sweep a
// fourth more). Coloured sweeps never take the positions.
bool velocity_from_positions(const Solver& solver, double dt);
// 1/s; what stages that move particles multiply corrections by to get their velocity: 0 = nothing.
float velocity_gain(const Solver& solver, double dt);

// How a force pushes particles that have just been moved (by springs or predict): as constraints do,
// for the same share of the substep, and on velocities where these do not get it from positions.
struct Push {
  double dt;        // s, for which it acts
  bool velocities;  // they gain it at once
};
Push push_of(const ClothParts& parts, double dt);

// Constants of the leapfrog move over one substep.
Advance advance_of(const ClothParts& parts, const Substep& substep);

}  // namespace weft::physics
