// Cloth between two bodies (pinched.h).
#include "physics/contact/pinched.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "physics/contact/start_inside.h"

namespace weft::physics {

double PinchedSearch::Body::depth_of(const Vec3& point) const {
  const Vec3 seen = upright.into(placement.seen(point));
  return offset - std::visit([&](const auto& shape) { return nearest_of(shape, seen).distance; },
                             upright.shape);
}

PinchedSearch::PinchedSearch(const Scene& scene) {
  bodies_.reserve(scene.colliders.size());
}

Pinched PinchedSearch::look(const ClothParts& parts, double time) {
  const std::vector<Collider>& colliders = parts.scene.colliders;
  Pinched found;
  if (std::ranges::count(colliders, false, &Collider::cuts) < 2) return found;
  bodies_.clear();
  for (std::size_t k = 0; k < colliders.size(); ++k)
    if (const Collider& c = colliders[k]; !c.cuts)
      bodies_.push_back({int(k), c.offset, Placement(c, time), Upright(at_time(c.shape, time))});
  const Particles& l = parts.particles;
  l.for_each([&](int j, int i) {
    if (!(l.w(j, i) > 0)) return;
    // The two that it lies deepest in, of those that it touches.
    struct Touched {
      double depth = -kTouchingStart;
      int number = -1;
    } first, second;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
      if (k + 1 == bodies_.size() && first.number < 0) return;
      const Touched one{bodies_[k].depth_of(l.position(j, i)), bodies_[k].number};
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
