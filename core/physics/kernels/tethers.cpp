// Tethers: a particle farther from its pin p than its rest distance r over the sheet is put back
// onto that distance, x + u <- p + r (x - p)/|x - p| (Kim, Chentanez, Müller-Fischer 2012, "Long range
// attachments"; pins do not move, so the particle takes the whole correction).
#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"
#include "physics/kernels/second_order.h"

namespace weft::WEFT_KERNELS {

using physics::TetherRow;

void tethers(const TetherRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 start = load3(r.x, i);
    Wide3 x = start;
    bool moved = false;
    for (int t = 0; t < r.count; ++t) {
      const Wide3 pin = load3(r.tethers[t].pin, i), e = x - pin;
      const Wide reach = load(r.tethers[t].reach + i), squared = squared_length(e);
      const WideInt beyond = squared > reach * reach;
      if (!any(beyond)) continue;
      moved = true;
      x = select(beyond, fma(e, reach * reciprocal_root(squared), pin), x);
    }
    if (!moved) continue;
    store3(r.u, i, x - start);
  }
}

}  // namespace weft::WEFT_KERNELS
