// Tethers: a particle farther from its pin p than its rest distance r over the sheet is put back
// onto that distance, x <- p + r (x - p)/|x - p| (Kim, Chentanez, Müller-Fischer 2012, "Long range
// attachments"; pins do not move, so the particle takes the whole correction).
#include "physics/kernels/row_kernels.h"
#include "physics/kernels/second_order.h"

namespace weft::WEFT_KERNELS {

using physics::TetherRow;

void tethers(const TetherRow& given) {
  const TetherRow r = given;
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 pin = load3(r.pin, i), x = load3(r.x, i), e = x - pin;
    const Wide reach = load(r.reach + i), squared = dot(e, e);
    const WideInt beyond = squared > reach * reach;
    if (!any(beyond)) continue;
    const Wide scale = reach / select(beyond, sqrt(squared), wide(1));
    const Wide3 target = pin + e * scale;
    store3(r.x, i, select(beyond, target, x));
    if (r.inverse_dt == 0) continue;
    const Wide3 v = load3(r.v, i);
    store3(r.v, i, select(beyond, v + (target - x) * wide(r.inverse_dt), v));
  }
}

}  // namespace weft::WEFT_KERNELS
