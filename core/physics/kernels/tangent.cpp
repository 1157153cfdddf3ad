// The tangent stiffness of springs, for the stability limit (stability.h).
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

// A far end is pulled first: in a row of its own, a particle's spring from before comes before the one
// after it, at every width.
void tangent(const physics::TangentRow& given) {
  const physics::TangentRow r = given;
  for (int a = 0; a < r.count; a += kLanes) {
    WideInt there = lanes_below(r.count - a);
    if (r.alive) there = there & lanes_at(r.alive + a);
    const Wide3 e = load3(r.far, a) - load3(r.near, a);
    const Wide3 u = load3(r.u_near, a) - load3(r.u_far, a);
    const Wide squared = 1e-30f + e.x * e.x + e.y * e.y + e.z * e.z;
    const Wide along = e.x * u.x + e.y * u.y + e.z * u.z;
    const Wide stiffness = r.factor ? load(r.factor + a) * r.stiffness : wide(r.stiffness);
    const Wide side = r.sideways ? stiffness * max(Wide{}, 1.0f - r.rest / sqrt(squared)) : Wide{};
    const Wide share = (stiffness - side) * along / squared;
    const Wide3 pull = select(there, e * share + u * side, Wide3{});
    store3(r.pull_far, a, load3(r.pull_far, a) - pull);
    store3(r.pull_near, a, load3(r.pull_near, a) + pull);
  }
}

}  // namespace weft::WEFT_KERNELS
