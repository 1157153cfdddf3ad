// How far colliders take the pins that follow them.
#pragma once

#include <functional>
#include <map>
#include <vector>

#include "physics/model/placement.h"
#include "weft/body_point.h"

namespace weft::physics {

class Followed {
 public:
  // `start`: where a pin of the cloth starts. The scene, which may lack the colliders that pins follow until one is
  // asked about, outlives this.
  Followed(const Scene& scene, const Cloth& cloth, const std::function<Vec3(const Pin&)>& start);

  // Where a pin of the cloth, which follows a collider and would be at `alone`, is by what it has been taken along
  // since the start [m]: moved and turned as the collider, or, by one with an animation, moved as the point of its
  // surface that was nearest then.
  Vec3 taken_along(const Pin& pin, const Vec3& alone, double time) const;

 private:
  struct Beside {
    BodyPoint point;
    Vec3 start;  // m
  };

  const Scene& scene_;
  std::vector<Placement> first_;                  // of colliders
  std::map<std::pair<int, int>, Beside> beside_;  // of pins, by what they hold
};

}  // namespace weft::physics
