// Energy of a cloth (energy_now.h).
#include "physics/frame/energy_now.h"

#include "physics/frame/velocities.h"
#include "physics/model/path.h"

namespace weft::physics {

std::vector<Vec3> measured_velocities(const ClothStep& cloth, double time, const TimeStep& step) {
  if (cloth.cloth().strain_limit > 0) return cloth.particles().gather(cloth.particles().v);
  return velocities_now(cloth, time, step);
}

EnergyNow energy_now(const ClothStep& cloth, std::span<const float> inverse_mass,
                     std::span<const Vec3> v, double time, const Vec3& origin) {
  const Particles& particles = cloth.particles();
  const Vec3 gravity = gravity_at(cloth.parts().scene, time);
  EnergyNow energy;
  energy.elastic = cloth.model().elastic_energy();
  if (const Load* load = cloth.model().load()) energy.load = load->energy(time);
  const std::vector<Vec3> x = particles.gather(particles.x);
  for (std::size_t p = 0; p < x.size(); ++p) {
    if (inverse_mass[particles.lane(int(p))] == 0) continue;
    const double m = cloth.model().mass(int(p));
    energy.kinetic += 0.5 * m * dot(v[p], v[p]);
    energy.gravity -= m * dot(gravity, plus(x[p], origin));
  }
  return energy;
}

}  // namespace weft::physics
