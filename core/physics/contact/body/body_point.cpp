#include "weft/body_point.h"

#include "physics/contact/body/body_surface.h"
#include "physics/contact/colliders/shapes.h"
#include "physics/model/placement.h"

namespace weft {

using namespace physics;

namespace {

Vec3 unit_or(const Vec3& v, const Vec3& other) {
  const double size = length(v);
  return size > 0 ? times(v, 1 / size) : other;
}

// Along the first edge, across it, and along the normal; any where the edge has no length, or the triangle no area, as
// between two samples it may.
std::array<Vec3, 3> axes_of(const Triangle& t) {
  const Vec3 along = unit_or(minus(t[1], t[0]), unit_or(minus(t[2], t[0]), {1, 0, 0}));
  const Vec3 up = unit_or(cross(along, minus(t[2], t[0])), across(along)[0]);
  return {along, cross(up, along), up};
}

}  // namespace

BodyPoint body_point(const Collider& collider, double time, const Vec3& place) {
  const BodyMoment moment = surface_of(collider)->at(time);
  const Vec3 p = Placement(collider, time).seen(place);
  const BodyMoment::Point nearest = moment.nearest(p);
  BodyPoint point{nearest.triangle, nearest.weights, {}};
  const Vec3 off = minus(p, moment.on(point.triangle, point.weights));
  const std::array<Vec3, 3> axes = axes_of(moment.corners(point.triangle));
  for (std::size_t k = 0; k < 3; ++k) point.off[k] = dot(off, axes[k]);
  return point;
}

Vec3 position_of(const Collider& collider, double time, const BodyPoint& point) {
  const BodyMoment moment = surface_of(collider)->at(time);
  const std::array<Vec3, 3> axes = axes_of(moment.corners(point.triangle));
  Vec3 p = moment.on(point.triangle, point.weights);
  for (std::size_t k = 0; k < 3; ++k) p = plus(p, times(axes[k], point.off[k]));
  return Placement(collider, time).in_scene(p);
}

}  // namespace weft
