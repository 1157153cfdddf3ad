// Things that move along keys (weft::Key): where they are at a time, and how fast.
#pragma once

#include <vector>

#include "weft/scene.h"

namespace weft::physics {

// Position on the path at `time` [s], linear between keys, held outside them; `keys` is not empty.
inline Vec3 position_at(const std::vector<Key>& keys, double time) {
  if (time <= keys.front().time) return keys.front().position;
  for (std::size_t n = 1; n < keys.size(); ++n) {
    if (time >= keys[n].time) continue;
    const Key &a = keys[n - 1], &b = keys[n];
    const double s = (time - a.time) / (b.time - a.time);
    Vec3 p;
    for (int k = 0; k < 3; ++k) p[k] = a.position[k] + s * (b.position[k] - a.position[k]);
    return p;
  }
  return keys.back().position;
}

// Mean velocity over the substep that ends at `time` [m/s].
inline Vec3 velocity_over(const std::vector<Key>& keys, double time, double dt) {
  const Vec3 a = position_at(keys, time - dt), b = position_at(keys, time);
  return {(b[0] - a[0]) / dt, (b[1] - a[1]) / dt, (b[2] - a[2]) / dt};
}

}  // namespace weft::physics
