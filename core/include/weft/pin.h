// What a scene holds particles by, and the paths along which things move (weft/scene.h).
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "weft/vec3.h"

namespace weft {

// One point of a path: at `time` [s] the thing is at `position` [m]; linear in between, held
// before the first key and after the last. Times increase strictly.
struct Key {
  double time = 0;
  Vec3 position{};
  friend bool operator==(const Key&, const Key&) = default;
};

// Where the path is at `time` [s]; `keys` is not empty.
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

// One point of a rotation: at `time` [s] it has turned by so many degrees; linear in between, held before
// the first key and after the last. Times increase strictly.
struct Angle {
  double time = 0;
  double degrees = 0;
  friend bool operator==(const Angle&, const Angle&) = default;
};

// A rotation about the line through `about` [m] along `axis` (not zero, any length), right-handed.
struct Rotation {
  Vec3 axis{0, 1, 0};
  Vec3 about{};
  std::vector<Angle> keys;  // none: it does not turn
  friend bool operator==(const Rotation&, const Rotation&) = default;
};

// Two opposite corners of a box along the axes, its faces included [m].
using BoxCorners = std::array<Vec3, 2>;

// A held particle of the grid, or, with j 0, particle i of a mesh. Its place is where it starts or where its keys
// say, turned by its rotation, then moved by as much as the collider that it follows, or the nearest point of an
// animated one, has moved since the start. Several particles held alike: keys say how far they are from their starts.
struct Pin {
  int i = 0;  // column, 0 … nx-1; of a mesh the vertex
  int j = 0;  // row, 0 … ny-1
  std::vector<Key> keys;
  Rotation rotate{};
  int follow = -1;  // number of a collider, or -1: none
  // At most one of these, in place of i and j: particles by their numbers, those of an object or a group of
  // the mesh's file, or all that start within a box.
  std::vector<int> vertices{};
  std::optional<std::string> group{};
  std::optional<BoxCorners> box{};
  bool of_several() const { return !vertices.empty() || group || box; }
  // Whether it moves on its own, whatever a person carries.
  bool moves() const { return !keys.empty() || !rotate.keys.empty() || follow >= 0; }
  friend bool operator==(const Pin&, const Pin&) = default;
};

}  // namespace weft
