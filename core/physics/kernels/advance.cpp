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

namespace {

// The velocity of free particles with what they were moved by since they were predicted. That is small
// against their way in a substep: rounding of positions far from zero does not get into it.
WEFT_INLINE Wide3 gained(const AdvanceRow& r, Wide3 x, int i) {
  const Wide3 moved_by = x - load3(r.predicted, i);
  return load3(r.v, i) + moved_by * select(load(r.w + i) > 0.0f, wide(r.inverse_dt), Wide{});
}

}  // namespace

void predict(const AdvanceRow& given) {
  const AdvanceRow r = given;  // a copy that no store can alias
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Wide3 x = positive_zeros(load3(r.x, i)), before = load3(r.v, i);
    if (r.f.x) {
      const Wide3 change = positive_zeros(load3(r.f, i));
      x = x + change;
      before = before + change * wide(r.inverse_dt);
      store3(r.f, i, Wide3{});  // for the next sweeps
    } else if (r.inverse_dt > 0) {
      before = gained(r, x, i);
    }
    const Wide3 v = moved(before, load(r.w + i), Wide3{}, r.advance);
    const Wide3 there = x + v * wide(r.advance.dt);
    store3(r.v, i, v);
    store3(r.x, i, there);
    if (r.predicted.x) store3(r.predicted, i, there);
  }
}

void velocity(const AdvanceRow& given) {
  const AdvanceRow r = given;
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 x = positive_zeros(load3(r.x, i));
    store3(r.v, i, gained(r, x, i));
    store3(r.x, i, x);
  }
}

}  // namespace weft::WEFT_KERNELS
