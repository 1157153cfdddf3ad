// Cloth between two bodies (pinched.h).
#include "physics/contact/pinched.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "physics/contact/start_inside.h"
#include "physics/contact/triangle_shape.h"
#include "physics/model/placement.h"

namespace weft::physics {
namespace {

// A collider at a time, to be asked for many points.
class Posed {
 public:
  Posed(const Collider& collider, double time)
      : offset_(collider.offset),
        placement_(collider, time),
        upright_(at_time(collider.shape, time)) {}
  // m; how deep a point lies in it and its offset.
  double depth_of(const Vec3& point) const {
    const Vec3 seen = upright_.into(placement_.seen(point));
    return offset_ - std::visit([&](const auto& shape) { return nearest_of(shape, seen).distance; },
                                upright_.shape);
  }

 private:
  double offset_;
  Placement placement_;
  Upright upright_;
};

struct Body {
  int number;
  Posed posed;
};

}  // namespace

Pinched pinched_between(const ClothParts& parts, double time) {
  const std::vector<Collider>& colliders = parts.scene.colliders;
  Pinched found;
  if (std::ranges::count(colliders, false, &Collider::cuts) < 2) return found;
  std::vector<Body> bodies;
  for (std::size_t k = 0; k < colliders.size(); ++k)
    if (!colliders[k].cuts) bodies.push_back({int(k), Posed(colliders[k], time)});
  const Particles& l = parts.particles;
  l.for_each([&](int j, int i) {
    if (!(l.w(j, i) > 0)) return;
    // The two that it lies deepest in, of those that it touches.
    struct Touched {
      double depth = -kTouchingStart;
      int number = -1;
    } first, second;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (k + 1 == bodies.size() && first.number < 0) return;
      const Touched one{bodies[k].posed.depth_of(l.position(j, i)), bodies[k].number};
      if (one.depth > first.depth)
        second = std::exchange(first, one);
      else if (one.depth > second.depth)
        second = one;
    }
    if (second.number < 0 || first.depth <= kTouchingStart) return;
    const double missing = first.depth + std::max(0.0, second.depth);
    if (missing > found.missing)
      found = {missing,
               {std::min(first.number, second.number), std::max(first.number, second.number)}};
  });
  return found;
}

}  // namespace weft::physics
