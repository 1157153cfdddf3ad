// Velocities between substeps (velocities.h).
#include "physics/frame/velocities.h"

#include "physics/model/path.h"

namespace weft::physics {

void accelerations_now(const ClothStep& cloth, double time, const Lag& lag, std::vector<Vec3>& a) {
  const Scene& scene = cloth.parts().scene;
  cloth.model().accelerations(gravity_at(scene, time), a);
  if (const Load* load = cloth.model().load()) load->add_accelerations(time, a);
  support(scene, cloth.cloth(), time, lag, cloth.particles(), a);
}

std::vector<Vec3> velocities_now(const ClothStep& cloth, double time, const TimeStep& step) {
  std::vector<Vec3> v = cloth.particles().gather(cloth.particles().v);
  if (!is_explicit(step.method)) return v;
  std::vector<Vec3> a;
  accelerations_now(cloth, time, {step.dt, step.lag}, a);
  for (std::size_t p = 0; p < v.size(); ++p)
    for (int k = 0; k < 3; ++k) v[p][k] += a[p][k] * step.lag;
  return v;
}

void stagger(ClothStep& cloth, double time, double dt, double by, std::span<const double> all) {
  Particles& p = cloth.particles();
  std::vector<Vec3> a;
  accelerations_now(cloth, time, {dt, 0}, a);
  std::size_t n = 0;
  p.for_each([&](int j, int i) {
    for (int c = 0; c < 3; ++c, ++n) {
      float& v = p.v.at(c, j, i);
      const double start = !all.empty() && p.w(j, i) > 0 ? all[n] : v;
      v = float(start - a[std::size_t(p.number(j, i))][c] * by);
    }
  });
}

}  // namespace weft::physics
