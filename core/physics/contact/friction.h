// The law of friction in double precision; kernels/collide.h has it for rows of particles.
#pragma once

#include <algorithm>

namespace weft::physics {

// The share of a slide along a surface that Coulomb friction takes: all of one that is no longer than static
// friction holds, else what dynamic friction takes of it. `slide` and `pressed`: along the surface and into it, both
// as lengths, speeds or accelerations.
inline double taken_by_friction(double statik, double dynamic, double slide, double pressed) {
  if (slide <= statik * pressed) return 1;
  return std::min(1.0, dynamic * pressed / slide);
}

}  // namespace weft::physics
