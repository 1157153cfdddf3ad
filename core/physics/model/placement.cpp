#include "physics/model/placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/model/path.h"
#include "weft/shape.h"

namespace weft::physics {

Placement::Placement(const Collider& collider, double time) : place(place_of(collider.shape)) {
  const Rotation& rotation = collider.rotate;
  const Vec3 start = place;
  if (!rotation.keys.empty()) {
    turned = true;
    turn = weft::rotation(rotation.axis, angle_at(rotation, time));
    place = plus(rotation.about, times(turn, minus(start, rotation.about)));
  }
  if (collider.keys.empty()) return;
  const Vec3 path = position_at(collider.keys, time);
  place = turned ? plus(place, minus(path, start)) : path;
}

RigidMotion::RigidMotion(const Collider& collider, double time, double dt) {
  if (collider.rotate.keys.empty()) {
    if (!collider.keys.empty()) velocity = velocity_over(collider.keys, time, dt);
    return;
  }
  const Placement before(collider, time - dt), now(collider, time);
  velocity = times(minus(now.place, before.place), 1 / dt);
  const Rotation& rotation = collider.rotate;
  const double angle = angle_at(rotation, time) - angle_at(rotation, time - dt);
  turns = angle != 0;
  if (!turns) return;
  turning = rotation_less_one(rotation.axis, angle);
  for (Vec3& row : turning) row = times(row, 1 / dt);
  spin = times(rotation.axis, angle / dt / length(rotation.axis));
  about = times(now.turn, minus(rotation.about, place_of(collider.shape)));
}

Vec3 along_keys(const Collider& collider, double time) {
  if (collider.keys.empty()) return {};
  return minus(position_at(collider.keys, time), place_of(collider.shape));
}

double fastest_turn(const Rotation& rotation, double from, double to) {
  double most = 0;
  for (std::size_t n = 1; n < rotation.keys.size(); ++n) {
    const Angle &a = rotation.keys[n - 1], &b = rotation.keys[n];
    if (b.time <= from || a.time >= to) continue;
    most = std::max(most, std::abs(b.degrees - a.degrees) / (b.time - a.time));
  }
  return most * std::numbers::pi / 180;
}

}  // namespace weft::physics
