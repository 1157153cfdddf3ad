// What of a cloth lies inside a collider when the two meet (start_inside.h).
#include "physics/contact/start_inside.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/triangle_shape.h"
#include "physics/model/path.h"

namespace weft::physics {
namespace {

void find_triangles_inside(const Cloth& cloth, const Lattice& l, const Collider& collider,
                           StartInside& found) {
  if (collider.cuts || !caught_by_triangles(cloth, collider)) return;
  const double edge = longest_edge(cloth.grid);
  const Upright upright(collider.shape);
  const Vec3 place = collider.keys.empty()
                         ? std::visit([](const auto& s) { return place_of(s); }, collider.shape)
                         : position_at(collider.keys, found.time);
  const auto look = [&](const std::array<int, 3>& j, const std::array<int, 3>& i) {
    Corners c{};
    bool moves = false;
    for (int k = 0; k < 3; ++k) {
      c.x[k] = minus({l.x.at(0, j[k], i[k]), l.x.at(1, j[k], i[k]), l.x.at(2, j[k], i[k])}, place);
      c.x[k] = upright.into(c.x[k]);
      moves |= l.w(j[k], i[k]) > 0;
    }
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 side = minus(c.x[(k + 1) % 3], c.x[k]);
      longest = std::max(longest, std::sqrt(dot(side, side)));
    }
    const double depth = std::visit(
        [&](const auto& shape) {
          // No point of a triangle is further from a corner than its longest side.
          if (!moves || nearest_of(shape, c.x[0]).distance > collider.offset + longest) return 0.0;
          return collider.offset - deepest_on(shape, c, collider.offset, edge).nearest.distance;
        },
        upright.shape);
    found.deepest_triangle = std::max(found.deepest_triangle, depth);
    found.triangles += depth > kTouchingStart;
  };
  for (int j = 0; j + 1 < l.rows; ++j)
    for (int i = 0; i + 1 < l.columns; ++i) {
      look({j, j, j + 1}, {i, i + 1, i});
      look({j, j + 1, j + 1}, {i + 1, i + 1, i});
    }
  if (found.triangles == 0) found.deepest_triangle = 0;
}

}  // namespace

StartInside start_inside(const Cloth& cloth, const Lattice& l, const Collider& collider,
                         double time) {
  StartInside found;
  found.time = time;
  if (collider.cuts) return found;
  for (int j = 0; j < l.rows; ++j)
    for (int i = 0; i < l.columns; ++i) {
      const Vec3 x{l.x.at(0, j, i), l.x.at(1, j, i), l.x.at(2, j, i)};
      const double depth = l.w(j, i) > 0 ? collider.offset - signed_distance(collider, time, x) : 0;
      found.deepest_particle = std::max(found.deepest_particle, depth);
      found.particles += depth > kTouchingStart;
    }
  if (found.particles == 0) found.deepest_particle = 0;
  find_triangles_inside(cloth, l, collider, found);
  return found;
}

}  // namespace weft::physics
