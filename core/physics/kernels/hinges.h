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

  // Takes off what jumps are at rest; p and q are the sides from corner 0.
  WEFT_INLINE void take_off_rest(const Wide3& p, const Wide3& q, Wide3 (&jump)[3]) const {
    const Wide3 normal = cross(p, q);
    for (int k = 0; k < 3; ++k) jump[k] = jump[k] - normal * load(b.bow[k] + lane);
  }

  // What moments do to corners by the normal that jumps at rest go along, added to f.
  WEFT_INLINE void turn(const Wide3 (&hinge)[3], const Wide3& p, const Wide3& q,
                        Wide3 (&f)[3]) const {
    Wide3 turning{};
    for (int k = 0; k < 3; ++k) turning = turning + moment(hinge, k) * load(b.bow[k] + lane);
    const Wide3 f1 = cross(q, turning), f2 = cross(turning, p);
    f[1] = f[1] + f1;
    f[2] = f[2] + f2;
    f[0] = f[0] - (f1 + f2);
  }

  WEFT_INLINE Wide3 moment(const Wide3 (&hinge)[3], int k) const {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    return hinge[k] * load(b.moment[k] + lane) + hinge[next] * load(b.moment[3 + k] + lane) +
           hinge[last] * load(b.moment[3 + last] + lane);
  }

  // What moments do to the triangle's own corners, added to f, and to those across its sides.
  WEFT_INLINE void pull(const Wide3 (&hinge)[3], Wide3 (&f)[3], Wide3 (&across)[3]) const {
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      const Wide3 at = moment(hinge, k);
      const Wide3 away = at * load(b.away[k] + lane), own = at * load(b.own[k] + lane);
      const Wide3 far = away * load(b.away_at[k] + lane) + own * load(b.own_at[k] + lane);
      across[k] = Wide3{} - away;
      f[last] = f[last] - own;
      f[next] = f[next] + far;
      f[k] = f[k] + (away + own - far);
    }
  }
};

}  // namespace weft::WEFT_KERNELS
