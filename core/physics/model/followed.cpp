#include "physics/model/followed.h"

namespace weft::physics {

Followed::Followed(const Scene& scene, const Cloth& cloth,
                   const std::function<Vec3(const Pin&)>& start)
    : scene_(scene) {
  for (const Collider& c : scene.colliders) first_.emplace_back(c, 0);
  for (const Pin& pin : cloth.pins) {
    if (pin.follow < 0 || std::size_t(pin.follow) >= scene.colliders.size()) continue;
    const Collider& collider = scene.colliders[std::size_t(pin.follow)];
    const MeshBody* body = std::get_if<MeshBody>(&collider.shape);
    if (!body || !body->motion || !body->surface) continue;
    const Vec3 place = start(pin);
    beside_[{pin.i, pin.j}] = {body_point(collider, 0, place), place};
  }
}

Vec3 Followed::taken_along(const Pin& pin, const Vec3& alone, double time) const {
  const Collider& collider = scene_.colliders[std::size_t(pin.follow)];
  const auto beside = beside_.find({pin.i, pin.j});
  if (beside != beside_.end())
    return plus(alone,
                minus(position_of(collider, time, beside->second.point), beside->second.start));
  const Placement now(collider, time);
  const Placement& first = first_[std::size_t(pin.follow)];
  // Without a turn, whole ways are exact.
  if (!now.turned) return plus(alone, minus(now.place, first.place));
  return now.in_scene(first.seen(alone));
}

}  // namespace weft::physics
