// What follows from a cloth: how many particles it has, how far apart and how heavy they are (scene.h).
#include "weft/mesh.h"

namespace weft {
namespace {

// What a line of particles on the border stands for, of what an inner one does.
double border_share(int line, int lines) {
  return line == 0 || line == lines - 1 ? 0.5 : 1;
}

}  // namespace

int particle_count(const Cloth& cloth) {
  if (!cloth.mesh.given()) return cloth.grid.nx * cloth.grid.ny;
  return cloth.mesh.shape ? int(cloth.mesh.shape->vertices.size()) : 0;
}

double spacing_u(const Grid& grid) {
  return hypot(grid.u) / (grid.nx - 1);
}

double spacing_v(const Grid& grid) {
  return hypot(grid.v) / (grid.ny - 1);
}

Vec3 place_on(const Grid& grid, int i, int j) {
  return plus(grid.origin,
              plus(times(grid.u, i / double(grid.nx - 1)), times(grid.v, j / double(grid.ny - 1))));
}

double particle_mass(const Cloth& cloth, int i, int j) {
  const Grid& grid = cloth.grid;
  if (!cloth.masses.empty())
    return cloth.masses[static_cast<std::size_t>(j) * static_cast<std::size_t>(grid.nx) +
                        static_cast<std::size_t>(i)];
  if (cloth.particle_mass > 0) return cloth.particle_mass;
  const double mass = cloth.density * hypot(cross(grid.u, grid.v));
  if (!lumps_by_area(cloth)) return mass / grid.nx / grid.ny;
  return mass / ((grid.nx - 1.0) * (grid.ny - 1.0)) * border_share(i, grid.nx) *
         border_share(j, grid.ny);
}

double area_density(const Cloth& cloth) {
  if (cloth.mesh.given() || (cloth.particle_mass == 0 && cloth.masses.empty()))
    return cloth.density;
  return particle_mass(cloth, cloth.grid.nx / 2, cloth.grid.ny / 2) /
         (spacing_u(cloth.grid) * spacing_v(cloth.grid));
}

bool lumps_by_area(const Cloth& cloth) {
  if (cloth.lumping != Lumping::automatic) return cloth.lumping == Lumping::area;
  return cloth.masses.empty() && cloth.particle_mass == 0;
}

double width_share(const Cloth& cloth, int i, int j, int di, int dj) {
  if ((di != 0 && dj != 0) || !lumps_by_area(cloth)) return 1;
  return dj == 0 ? border_share(j, cloth.grid.ny) : border_share(i, cloth.grid.nx);
}

}  // namespace weft
