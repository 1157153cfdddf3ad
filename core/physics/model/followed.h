// How far colliders take the pins that follow them.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "weft/body_point.h"

namespace weft::physics {

class Followed {
 public:
  // `start`: where a pin of the cloth starts. The scene, which may lack the colliders that pins follow until one is
  // asked about, outlives this.
  Followed(const Scene& scene, const Cloth& cloth, const std::function<Vec3(const Pin&)>& start);

  // By how much a pin of the cloth, which follows a collider, has been taken along since the start [m]: as far as the
  // collider has moved along its keys, or, by one with an animation, as the point of its surface that was nearest
  // then.
  Vec3 way(const Pin& pin, double time) const;

 private:
  struct Beside {
    BodyPoint point;
    Vec3 start;  // m
  };

  const Scene& scene_;
  std::vector<Vec3> first_moves_;                 // of colliders
  std::map<std::pair<int, int>, Beside> beside_;  // of pins, by what they hold
};

}  // namespace weft::physics
