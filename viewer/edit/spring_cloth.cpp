#include "edit/spring_cloth.h"

#include <algorithm>
#include <cmath>

namespace weft::viewer {
namespace {

Vec3 place_of(const Grid& g, int i, int j) {
  Vec3 at = g.origin;
  for (std::size_t c = 0; c < 3; ++c) at[c] += g.u[c] * i / (g.nx - 1) + g.v[c] * j / (g.ny - 1);
  return at;
}

// Sides of dim - 1 spacings of `offset` about the middle of the upper edge.
Grid resized(const Grid& from, int dim, double offset) {
  Grid grid = from;
  grid.nx = grid.ny = dim;
  const double u = offset * (dim - 1) / (spacing_u(from) * (from.nx - 1)),
               v = offset * (dim - 1) / (spacing_v(from) * (from.ny - 1));
  for (std::size_t c = 0; c < 3; ++c) {
    grid.origin[c] += from.u[c] * (1 - u) / 2;
    grid.u[c] *= u;
    grid.v[c] *= v;
  }
  return grid;
}

// A pin of the old grid on the new one, moved along by as much.
Pin moved_to(const Pin& pin, int i, int j, const Grid& from, const Grid& to) {
  Pin moved = pin;
  moved.i = i;
  moved.j = j;
  const Vec3 before = place_of(from, pin.i, pin.j), now = place_of(to, i, j);
  for (Key& key : moved.keys)
    for (std::size_t c = 0; c < 3; ++c) key.position[c] += now[c] - before[c];
  return moved;
}

// Between pins that were neighbours in a row all are pinned.
std::vector<Pin> resized_pins(const Cloth& cloth, const Grid& to) {
  const Grid& from = cloth.grid;
  const auto along = [](int k, int before, int now) {
    return int(std::lround(double(k) * (now - 1) / (before - 1)));
  };
  std::vector<Pin> old = single_pins(cloth), pins;
  std::sort(old.begin(), old.end(),
            [](const Pin& a, const Pin& b) { return std::pair(a.j, a.i) < std::pair(b.j, b.i); });
  const auto held = [&](int i, int j) {
    return std::any_of(pins.begin(), pins.end(),
                       [&](const Pin& p) { return p.i == i && p.j == j; });
  };
  for (std::size_t n = 0; n < old.size(); ++n) {
    const int j = along(old[n].j, from.ny, to.ny), first = along(old[n].i, from.nx, to.nx);
    const bool joined =
        n + 1 < old.size() && old[n + 1].j == old[n].j && old[n + 1].i == old[n].i + 1;
    const int last = joined ? along(old[n + 1].i, from.nx, to.nx) - 1 : first;
    for (int i = first; i <= std::max(first, last); ++i)
      if (!held(i, j)) pins.push_back(moved_to(old[n], i, j, from, to));
  }
  return pins;
}

bool springs(Method method) {
  return method == Method::spring || method == Method::spring_friction;
}

}  // namespace

bool is_spring_cloth(const Scene& scene) {
  return scene.cloths.size() == 1 && scene.cloths[0].level > 0 && !scene.cloths[0].mesh.given() &&
         scene.cloths[0].grid.nx == scene.cloths[0].grid.ny;
}

SpringCloth spring_cloth_of(const Scene& scene) {
  const Cloth& cloth = scene.cloths[0];
  SpringCloth s;
  s.cloth_dim = cloth.grid.nx;
  s.particle_offset = spacing_u(cloth.grid);
  s.particle_mass = particle_mass(cloth, cloth.grid.nx / 2, cloth.grid.ny / 2);
  s.gravity = scene.gravity[1];
  s.type = scene.solver.method;
  s.k = springs(s.type) ? cloth.stiffness.structural : cloth.positional_k;
  s.u = cloth.spring_damping.structural;
  s.constraint_iterations = scene.solver.iterations;
  s.constraint_level = cloth.level;
  s.collision_iterations = scene.solver.collision_iterations;
  s.offset_multiplier = 1;
  for (const Collider& c : scene.colliders)
    if (const auto* ball = std::get_if<Sphere>(&c.shape))
      s.offset_multiplier = std::max(s.offset_multiplier, 1 + c.offset / ball->radius);
  s.cut_length = cloth.tear_strain > 0 ? 1 + cloth.tear_strain : 0;
  return s;
}

Scene with(Scene scene, const SpringCloth& wanted) {
  const SpringCloth now = spring_cloth_of(scene);
  Cloth& cloth = scene.cloths[0];
  if (wanted.cloth_dim != now.cloth_dim || wanted.particle_offset != now.particle_offset) {
    const Grid grid = resized(cloth.grid, wanted.cloth_dim, wanted.particle_offset);
    cloth.pins = resized_pins(cloth, grid);
    cloth.grid = grid;
    cloth.masses.clear();
  }
  if (wanted.particle_mass != now.particle_mass) {
    cloth.particle_mass = wanted.particle_mass;
    cloth.masses.clear();
  }
  scene.gravity[1] = wanted.gravity;
  if (wanted.type != now.type) {
    scene.solver.method = wanted.type;
    scene.solver.iterate_springs = springs(wanted.type);
    scene.time.substeps = springs(wanted.type) ? kAutoSubsteps : 1;
  } else if (springs(wanted.type)) {
    cloth.stiffness.structural = wanted.k;
  } else {
    cloth.positional_k = wanted.k;
  }
  cloth.spring_damping.structural = wanted.u;
  if (wanted.constraint_iterations != now.constraint_iterations) {
    scene.solver.iterations = wanted.constraint_iterations;
    scene.solver.iterate_springs = springs(wanted.type);
  }
  cloth.level = wanted.constraint_level;
  scene.solver.collision_iterations = wanted.collision_iterations;
  if (wanted.offset_multiplier != now.offset_multiplier)
    for (Collider& c : scene.colliders)
      if (const auto* ball = std::get_if<Sphere>(&c.shape))
        c.offset = ball->radius * (wanted.offset_multiplier - 1);
  if (wanted.cut_length != now.cut_length)
    cloth.tear_strain = wanted.cut_length > 1 ? wanted.cut_length - 1 : 0;
  return scene;
}

std::vector<Document::Change> changes_to(const Scene& scene, const SpringCloth& wanted) {
  return changes_between(scene, with(scene, wanted));
}

}  // namespace weft::viewer
