// The particles of a grid at the start (lattice.h).
#include "physics/model/lattice/lattice.h"

#include <cmath>

#include "physics/model/path.h"
#include "weft/random.h"

namespace weft::physics {

Lattice make_lattice(const Cloth& cloth, int cloth_index, std::uint64_t seed, bool keep_previous) {
  const Grid& g = cloth.grid;
  Lattice l(g.nx, g.ny, keep_previous);
  for (int i = 0; i < g.nx; ++i) {
    const double width = width_share(cloth, i, 0, 0, 1);
    l.column_width[static_cast<std::size_t>(i)] = float(width);
    l.inverse_width[static_cast<std::size_t>(i)] = float(1 / width);
  }

  Vec3 normal{g.u[1] * g.v[2] - g.u[2] * g.v[1], g.u[2] * g.v[0] - g.u[0] * g.v[2],
              g.u[0] * g.v[1] - g.u[1] * g.v[0]};
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  for (double& c : normal) c /= length;
  Random random(seed, static_cast<std::uint64_t>(cloth_index));
  for (int j = 0; j < g.ny; ++j) {
    for (int i = 0; i < g.nx; ++i) {
      const double a = i / double(g.nx - 1), b = j / double(g.ny - 1);
      const double off = g.jitter > 0 ? g.jitter * random.symmetric() : 0;
      for (int k = 0; k < 3; ++k)
        l.x.at(k, j, i) = coordinate(g.origin[k] + g.u[k] * a + g.v[k] * b + normal[k] * off);
      l.w(j)[i] = float(1 / particle_mass(cloth, i, j));
    }
  }
  for (const Pin& pin : cloth.pins) {
    l.w(pin.j)[pin.i] = 0;
    if (!pin.moves()) continue;
    const Vec3 start = pin_alone_at(cloth, pin, 0);
    for (int k = 0; k < 3; ++k) l.x.at(k, pin.j, pin.i) = coordinate(start[k]);
  }
  for (int j = 0; j < g.ny; ++j) l.weigh_row(j);
  std::vector<double> masses;
  if (cloth.velocity != Vec3{} || cloth.spin != Vec3{})
    l.for_each([&](int j, int i) { masses.push_back(particle_mass(cloth, i, j)); });
  set_in_motion(l, cloth.velocity, cloth.spin, masses);
  return l;
}

}  // namespace weft::physics
