// Things that move along keys (weft::Key): where they are at a time, and how fast.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "weft/scene.h"
#include "weft/vec3.h"

namespace weft::physics {

// Mean velocity over the substep that ends at `time` [m/s].
inline Vec3 velocity_over(const std::vector<Key>& keys, double time, double dt) {
  const Vec3 a = position_at(keys, time - dt), b = position_at(keys, time);
  return {(b[0] - a[0]) / dt, (b[1] - a[1]) / dt, (b[2] - a[2]) / dt};
}

// What keys add up to from time 0 on: the way of something with such velocities.
inline Vec3 integral_of(const std::vector<Key>& keys, double time) {
  Vec3 sum{}, last = position_at(keys, 0);
  double from = 0;
  const auto add = [&](double to) {
    const Vec3 now = position_at(keys, to);
    sum = plus(sum, times(plus(last, now), (to - from) / 2));
    from = to;
    last = now;
  };
  for (const Key& key : keys)
    if (key.time > from && key.time < time) add(key.time);
  add(time);
  return sum;
}

inline double greatest_of(const std::vector<Key>& keys) {
  double square = 0;
  for (const Key& key : keys) square = std::max(square, dot(key.position, key.position));
  return std::sqrt(square);
}

// Gravity at a time, and the greatest that there ever is [m/s²].
inline Vec3 gravity_at(const Scene& scene, double time) {
  return scene.gravity_keys.empty() ? scene.gravity : position_at(scene.gravity_keys, time);
}
inline double greatest_gravity(const Scene& scene) {
  if (!scene.gravity_keys.empty()) return greatest_of(scene.gravity_keys);
  return length(scene.gravity);
}

// Of the air at a time, and the greatest speed [m/s].
inline Vec3 wind_at(const Wind& wind, double time) {
  return wind.velocity_keys.empty() ? wind.velocity : position_at(wind.velocity_keys, time);
}
inline double greatest_wind(const Wind& wind) {
  if (!wind.velocity_keys.empty()) return greatest_of(wind.velocity_keys);
  return length(wind.velocity);
}

// By how much it has turned at a time [rad].
inline double angle_at(const Rotation& rotation, double time) {
  std::vector<Angle>::const_iterator next = rotation.keys.begin();
  while (next != rotation.keys.end() && next->time <= time) ++next;
  double degrees = 0;
  if (next == rotation.keys.begin()) {
    if (next != rotation.keys.end()) degrees = next->degrees;
  } else if (next == rotation.keys.end()) {
    degrees = rotation.keys.back().degrees;
  } else {
    const Angle &a = *(next - 1), &b = *next;
    degrees = a.degrees + (time - a.time) / (b.time - a.time) * (b.degrees - a.degrees);
  }
  return degrees * std::numbers::pi / 180;
}

// A point that turns (Rodrigues).
inline Vec3 turned(const Rotation& rotation, const Vec3& point, double time) {
  const double angle = angle_at(rotation, time), c = std::cos(angle), s = std::sin(angle);
  const Vec3 n = times(rotation.axis, 1 / length(rotation.axis));
  const Vec3 r = minus(point, rotation.about);
  return plus(rotation.about,
              plus(times(r, c), plus(times(cross(n, r), s), times(n, dot(n, r) * (1 - c)))));
}

// Where a pin is at a time whose particle starts at `place`; but for what it follows.
inline Vec3 pin_alone_at(const Pin& pin, const Vec3& place, double time) {
  const Vec3 base = pin.keys.empty() ? place : position_at(pin.keys, time);
  return pin.rotate.keys.empty() ? base : turned(pin.rotate, base, time);
}
// Where the particle of a pin of one starts.
inline Vec3 start_of(const Cloth& cloth, const Pin& pin) {
  return cloth.mesh.given() ? placed_vertex(cloth.mesh, pin.i) : place_on(cloth.grid, pin.i, pin.j);
}
inline Vec3 pin_alone_at(const Cloth& cloth, const Pin& pin, double time) {
  return pin_alone_at(pin, start_of(cloth, pin), time);
}

}  // namespace weft::physics
