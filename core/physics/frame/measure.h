// What a run is measured by: the report, the hash.
#pragma once

#include "physics/frame/state.h"
#include "weft/report.h"

namespace weft::physics {

Report measure(const Simulation::State& state, bool contacts);
std::uint64_t state_hash(const Simulation::State& state);

// Over all cloths: the largest, and the mean weighted by constraints.
Strain strain_of(const Cloths& cloths);

}  // namespace weft::physics
