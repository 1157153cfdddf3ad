// The hinges of 16 triangles of a mesh: jumps of slope at their sides, and what moments in proportion to
// these do to the corners (model/mesh/rest_triangles.h).
#pragma once

#include "physics/kernels/mesh.h"
#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

// Lanes from `lane` on of one batch.
struct Hinges {
  const physics::MeshBatch& b;
  int lane;

  // Jumps of slope: of the positions of a triangle's corners and its neighbours', or of velocities.
  WEFT_INLINE void jumps(const Wide3 (&x)[6], Wide3 (&jump)[3]) const {
    for (int k = 0; k < 3; ++k) {
      const Wide3 a = x[k], side = x[(k + 1) % 3] - a;
      jump[k] = (x[3 + k] - a - side * load(b.away_at[k] + lane)) * load(b.away[k] + lane) +
                (x[(k + 2) % 3] - a - side * load(b.own_at[k] + lane)) * load(b.own[k] + lane);
    }
  }

  // What moments do to the triangle's own corners, added to f, and to those across its sides.
  WEFT_INLINE void pull(const Wide3 (&hinge)[3], Wide3 (&f)[3], Wide3 (&across)[3]) const {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      const Wide3 moment = hinge[k] * load(b.moment[k] + lane) +
                           hinge[next] * load(b.moment[3 + k] + lane) +
                           hinge[last] * load(b.moment[3 + last] + lane);
      const Wide3 away = moment * load(b.away[k] + lane), own = moment * load(b.own[k] + lane);
      const Wide3 far = away * load(b.away_at[k] + lane) + own * load(b.own_at[k] + lane);
      across[k] = Wide3{} - away;
      f[last] = f[last] - own;
      f[next] = f[next] + far;
      f[k] = f[k] + (away + own - far);
    }
  }
};

}  // namespace weft::WEFT_KERNELS
