// Cloth that two bodies leave too little room.
#pragma once

#include "physics/model/cloth_model.h"

namespace weft::physics {

struct Pinched {
  double missing =
      0;  // m, of the room that two offsets ask for, where most is; 0: no cloth lacks any
  int colliders[2] = {0, 0};  // which, by their numbers in the scene
};

// Looks at all particles that can move, at a time [s]. Nothing to do where the scene has fewer than two bodies.
Pinched pinched_between(const ClothParts& parts, double time);

}  // namespace weft::physics
