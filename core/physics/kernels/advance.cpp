// What goes before and after the sweeps of methods that project: prediction, corrections, velocities.
//
// Sweeps compute whole blocks, and so add zeros to lanes that none of their constraints has. Which lanes these are
// depends on the vectors' width, and -0 stays as it is or becomes +0. A correction that underflows leaves -0. So
// here every -0 becomes +0 (adding +0 does that): all widths have the same bits where a substep ends.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

void apply_corrections(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Wide3 change = positive_zeros(load3(r.f, i));
    if (r.w) change = change * load(r.w + i);
    store3(r.x, i, load3(r.x, i) + change);
    store3(r.v, i, load3(r.v, i) + change * wide(r.inverse_dt));
    store3(r.f, i, Wide3{});
  }
}

void predict(const AdvanceRow& given) {
  const AdvanceRow r = given;  // a copy that no store can alias
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Wide3 x = positive_zeros(load3(r.x, i)), before = load3(r.v, i);
    if (r.f.x) {
      const Wide3 change = positive_zeros(load3(r.f, i));
      x = x + change;
      before = before + change * wide(r.inverse_dt);
      store3(r.f, i, Wide3{});  // for the next sweeps
    }
    const Wide3 v = moved(before, load(r.w + i), Wide3{}, r.advance);
    store3(r.v, i, v);
    store3(r.x, i, x + v * wide(r.advance.dt));
  }
}

}  // namespace weft::WEFT_KERNELS
