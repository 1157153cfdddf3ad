// Velocities that lie behind the positions (TimeStep::lag): told where the positions are, and taken there.
#pragma once

#include <span>
#include <vector>

#include "physics/contact/contact_reaction.h"
#include "physics/frame/cloth_step.h"
#include "physics/frame/time_step.h"

namespace weft::physics {

// What a cloth's particles are accelerated by as they lie at `time` [s], loads and bodies that they touch
// included [m/s²].
void accelerations_now(const ClothStep& cloth, double time, const Lag& lag, std::vector<Vec3>& a);

// m/s; at the time of the positions, `time` [s].
std::vector<Vec3> velocities_now(const ClothStep& cloth, double time, const TimeStep& step);

// v <- v - a by: velocities that are those of the positions, at `time` [s] in substeps of `dt` [s], are taken so
// far behind them [s]. `all`: the velocities in double precision in place of v, so that what velocities_now()
// told comes back exactly; or none.
void stagger(ClothStep& cloth, double time, double dt, double by, std::span<const double> all = {});

}  // namespace weft::physics
