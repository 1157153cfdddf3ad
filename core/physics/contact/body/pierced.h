// Cloth through which edges of a body pass.
#pragma once

#include "physics/model/cloth_model.h"

namespace weft::physics {

struct Pierced {
  int collider = -1;  // the first of the scene; none: -1
  int places = 0;     // pairs of its edges and triangles of the cloth
};

// Looks at all triangles of a cloth and those edges of closed bodies that are sharper than it is fine, at a time [s],
// a little inside of these.
Pierced pierced(const ClothModel& model, double time);

}  // namespace weft::physics
