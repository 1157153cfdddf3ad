// Particles of a row that lie beside each other.
#pragma once

#include <vector>

#include "physics/model/particles.h"

namespace weft::physics {

// How wide such groups are for a body, of its mean edge: wider ones have longer lists, narrower ones more of them.
inline constexpr double kGroupWidth = 6;

// The lanes of row j, in groups of few that are not far from each other where they are now: no wider than so [m], if
// they are more than one.
std::vector<std::vector<int>> beside_each_other(const Particles& particles, int j, double wide);

}  // namespace weft::physics
