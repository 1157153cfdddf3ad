// What bodies do against accelerations into them, for velocities half a substep on: a particle that
// rests on a surface is not as fast as springs and gravity alone would make it.
#pragma once

#include <vector>

#include "physics/model/particles.h"
#include "weft/scene.h"

namespace weft::physics {

// Substeps are of `dt` [s]; velocities lie `behind` the positions by so much: half a substep, or 0 where
// they have been taken to now.
struct Lag {
  double dt, behind;  // s
};

// Of every particle of the cloth that rests on a collider at `time` [s], or slides along it,
// accelerations `a` [m/s²] lose what goes into the surface, but for what keeps it on a curved one that
// the mesh resolves; what goes along it is shortened by friction as if the particle moved that way
// (Coulomb), or by the collider's share (course).
void support(const Scene& scene, const Cloth& cloth, double time, const Lag& lag,
             const Particles& particles, std::vector<Vec3>& a);

}  // namespace weft::physics
