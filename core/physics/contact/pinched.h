// Cloth that two bodies leave too little room.
#pragma once

#include <vector>

#include "physics/contact/triangle_shape.h"
#include "physics/model/cloth_model.h"
#include "physics/model/placement.h"

namespace weft::physics {

struct Pinched {
  double missing = 0;         // m, of the room that two offsets ask for, where most is
  int colliders[2] = {0, 0};  // which, by their numbers in the scene
};

class PinchedSearch {
 public:
  explicit PinchedSearch(const Scene& scene);
  // Looks at all particles of a cloth of the scene that can move, at a time [s]. Nothing to do where the scene has
  // fewer than two bodies. Allocates nothing.
  Pinched look(const ClothParts& parts, double time);

 private:
  // A collider at a time, to be asked for many points.
  struct Body {
    int number;
    double offset;
    Placement placement;
    Upright upright;
    // m; how deep a point lies in it and its offset.
    double depth_of(const Vec3& point) const;
  };
  std::vector<Body> bodies_;
};

}  // namespace weft::physics
