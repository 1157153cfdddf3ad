// What bodies do against accelerations into them, for velocities half a substep on: a particle that
// rests on a surface is not as fast as springs and gravity alone would make it.
#pragma once

#include <vector>

#include "physics/lattice.h"
#include "weft/scene.h"

namespace weft::physics {

// Of every particle that rests on a collider at `time` [s], or slides along it, accelerations `a`
// [m/s²] lose what goes into the surface; what goes along it is shortened by friction as if the
// particle moved that way (Coulomb), or by the collider's share (course). Substeps are of `dt` [s].
void support(const Scene& scene, double time, double dt, const Lattice& lattice,
             std::vector<Vec3>& a);

}  // namespace weft::physics
