// What a cloth holds of energy, by motion and place at one time, in double precision.
#pragma once

#include <span>
#include <vector>

#include "physics/frame/cloth_step.h"
#include "physics/frame/time_step.h"

namespace weft::physics {

// J
struct EnergyNow {
  double kinetic = 0, gravity = 0;  // of particles that nothing holds
  ElasticEnergy elastic;
  double load = 0;  // of what presses on it, as a gas

  double total() const { return kinetic + gravity + elastic.sum() + load; }
};

// m/s; those that energies and momenta are told of. A strain limit takes back much of what springs alone would add in the
// half substep to `time`: with one they are those of half a substep before.
std::vector<Vec3> measured_velocities(const ClothStep& cloth, double time, const TimeStep& step);

// v: velocities [m/s] at `time` [s]; inverse masses, by lanes, are 0 where particles are held; `origin` is added to
// places as the cloth has them [m].
EnergyNow energy_now(const ClothStep& cloth, std::span<const float> inverse_mass,
                     std::span<const Vec3> v, double time, const Vec3& origin);

}  // namespace weft::physics
