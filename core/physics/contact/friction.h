// The law of friction in double precision; kernels/collide.h has it for rows of particles.
#pragma once

#include <algorithm>

namespace weft::physics {

// The share of a slide along a surface that Coulomb friction takes: all of one that is no longer than static
// friction holds, else what dynamic friction takes of it. `slide` and `pressed`: along the surface and into it, both
// as lengths, speeds or accelerations.
//
// A slide that is hardly longer than static friction holds has not begun yet: it loses what that holds, and less the
// longer it is. Else a particle that is pushed too far once, if only by the rounding of the springs at it, would lose
// its hold, its neighbours would have to carry what it carried, and a sheet would slide that static friction holds.
inline double taken_by_friction(double statik, double dynamic, double slide, double pressed) {
  const double holds = statik * pressed;
  if (slide <= holds) return 1;
  return std::min(1.0, std::max(dynamic * pressed, 2 * holds - slide) / slide);
}

}  // namespace weft::physics
