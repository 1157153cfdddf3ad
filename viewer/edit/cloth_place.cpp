// One change of place for sheets, meshes and pins: p -> about + factor * turn (p - about) + by.
#include "edit/cloth_place.h"

#include <algorithm>

#include "weft/turn.h"

namespace weft::viewer {

namespace {

struct Placing {
  Matrix turn = rotation(0, 0);
  double factor = 1;
  Vec3 about{}, by{};

  Vec3 direction(const Vec3& d) const {
    const Vec3 t = times(turn, d);
    return {factor * t[0], factor * t[1], factor * t[2]};
  }
  Vec3 point(const Vec3& p) const {
    const Vec3 from = direction({p[0] - about[0], p[1] - about[1], p[2] - about[2]});
    return plus(plus(about, from), by);
  }
};

// What a box holds goes with the cloth; the box, which may be turned, does not.
void name_vertices(Cloth& cloth) {
  for (Pin& pin : cloth.pins)
    if (pin.box) {
      pin.vertices = held_particles(cloth, pin);
      pin.box.reset();
    }
}

Cloth placed(Cloth cloth, const Placing& placing) {
  name_vertices(cloth);
  if (cloth.mesh.given()) {
    MeshSource& mesh = cloth.mesh;
    mesh.translate = placing.point(mesh.translate);
    mesh.rotate = angles_of(times(placing.turn, matrix_of(mesh.rotate)));
    mesh.scale *= placing.factor;
  } else {
    Grid& grid = cloth.grid;
    grid.origin = placing.point(grid.origin);
    grid.u = placing.direction(grid.u);
    grid.v = placing.direction(grid.v);
  }
  for (Pin& pin : cloth.pins) {
    for (Key& key : pin.keys)
      key.position =
          pin.of_several() ? placing.direction(key.position) : placing.point(key.position);
    pin.rotate.about = placing.point(pin.rotate.about);
    pin.rotate.axis = times(placing.turn, pin.rotate.axis);
  }
  return cloth;
}

}  // namespace

Vec3 middle_of(const Cloth& cloth) {
  const Grid& g = cloth.grid;
  const std::vector<Vec3> points =
      cloth.mesh.given() ? placed_vertices(cloth.mesh)
                         : std::vector<Vec3>{g.origin, plus(g.origin, g.u), plus(g.origin, g.v),
                                             plus(plus(g.origin, g.u), g.v)};
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points)
    for (std::size_t k = 0; k < 3; ++k)
      low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
  return {(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, (low[2] + high[2]) / 2};
}

Cloth moved(Cloth cloth, const Vec3& by) {
  return placed(std::move(cloth), {.by = by});
}

Cloth turned(Cloth cloth, std::size_t axis, double angle) {
  const Placing placing{.turn = rotation(axis, angle), .about = middle_of(cloth)};
  return placed(std::move(cloth), placing);
}

Cloth sized(Cloth cloth, double factor) {
  const Placing placing{.factor = factor, .about = middle_of(cloth)};
  return placed(std::move(cloth), placing);
}

bool starts_elsewhere(const Scene& a, const Scene& b) {
  if (a.cloths.size() != b.cloths.size()) return false;
  const auto elsewhere = [](const Cloth& one, const Cloth& other) {
    Grid grid = one.grid;
    grid.nx = other.grid.nx, grid.ny = other.grid.ny;
    return grid != other.grid || one.mesh != other.mesh;
  };
  for (std::size_t c = 0; c < a.cloths.size(); ++c)
    if (particle_count(a.cloths[c]) == particle_count(b.cloths[c]) &&
        elsewhere(a.cloths[c], b.cloths[c]))
      return true;
  return false;
}

}  // namespace weft::viewer
