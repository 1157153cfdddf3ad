// What of a cloth lies inside a collider when the two meet (start_inside.h).
#include "physics/contact/start_inside.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/triangle_shape.h"
#include "physics/model/path.h"

namespace weft::physics {
namespace {

void find_triangles_inside(const ClothParts& parts, const Collider& collider, StartInside& found) {
  if (!caught_by_triangles(parts.cloth, collider)) return;
  const Particles& l = parts.particles;
  const double edge = longest_edge(parts.cloth.grid);
  const Upright upright(collider.shape);
  const Vec3 place = collider.keys.empty()
                         ? std::visit([](const auto& s) { return place_of(s); }, collider.shape)
                         : position_at(collider.keys, found.time);
  // The stage keeps triangles beside tears out as well.
  const SurfaceMesh mesh = parts.model.whole_surface();
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    Corners c{};
    bool moves = false;
    for (int k = 0; k < 3; ++k) {
      const auto [j, i] = l.place(triangle[std::size_t(k)]);
      c.x[k] = upright.into(minus(l.position(j, i), place));
      moves |= l.w(j, i) > 0;
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
  }
  if (found.triangles == 0) found.deepest_triangle = 0;
}

}  // namespace

StartInside start_inside(const ClothParts& parts, const Collider& collider, double time) {
  StartInside found;
  found.time = time;
  if (collider.cuts) return found;
  const Particles& l = parts.particles;
  l.for_each([&](int j, int i) {
    const double distance = signed_distance(collider, time, l.position(j, i));
    const double depth = l.w(j, i) > 0 ? collider.offset - distance : 0;
    found.deepest_particle = std::max(found.deepest_particle, depth);
    found.particles += depth > kTouchingStart;
  });
  if (found.particles == 0) found.deepest_particle = 0;
  find_triangles_inside(parts, collider, found);
  return found;
}

}  // namespace weft::physics
