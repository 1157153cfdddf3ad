// The origin of a simulation (origin.h), and moving scenes.
#include "physics/frame/origin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "physics/contact/colliders/shapes.h"

namespace weft {

using namespace physics;

Scene moved(Scene scene, const Vec3& by) {
  const auto move = [&](Vec3& p) { p = plus(p, by); };
  for (Cloth& cloth : scene.cloths) {
    move(cloth.grid.origin);
    for (Pin& pin : cloth.pins) {
      for (Key& key : pin.keys) move(key.position);
      if (!pin.rotate.keys.empty()) move(pin.rotate.about);
    }
  }
  for (Collider& collider : scene.colliders) {
    collider.shape = moved(collider.shape, by);
    for (Key& key : collider.keys) move(key.position);
  }
  return scene;
}

namespace physics {

Vec3 origin_of(const Scene& scene) {
  constexpr double kNear = 8;  // m
  Vec3 low, high, middle;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Cloth& cloth : scene.cloths)
    for (const double a : {0, 1})
      for (const double b : {0, 1}) {
        const Grid& g = cloth.grid;
        const Vec3 corner = plus(g.origin, plus(times(g.u, a), times(g.v, b)));
        for (int k = 0; k < 3; ++k) {
          low[k] = std::min(low[k], corner[k]);
          high[k] = std::max(high[k], corner[k]);
        }
      }
  bool near = true;
  for (int k = 0; k < 3; ++k) {
    middle[k] = std::round((low[k] + high[k]) / 2);
    near &= std::abs(middle[k]) <= kNear;
  }
  return near ? Vec3{} : middle;
}

}  // namespace physics
}  // namespace weft
