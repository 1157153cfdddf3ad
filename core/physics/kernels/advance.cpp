// What goes before and after the sweeps of methods that project: prediction, corrections, velocities.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

void apply_corrections(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Wide3 change = load3(r.f, i);
    if (r.w) change = change * load(r.w + i);
    store3(r.x, i, load3(r.x, i) + change);
    if (r.inverse_dt > 0) store3(r.v, i, load3(r.v, i) + change * wide(r.inverse_dt));
    store3(r.f, i, Wide3{});
  }
}

namespace {

void predict_from_positions(const AdvanceRow& given) {
  const AdvanceRow r = given;  // a copy that no store can alias
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 x = load3(r.x, i), v = (x - load3(r.previous, i)) * wide(r.inverse_dt);
    store3(r.previous, i, x);
    store3(r.x, i, x + moved(v, load(r.w + i), Wide3{}, r.advance) * wide(r.advance.dt));
  }
}

}  // namespace

void predict(const AdvanceRow& r) {
  if (r.inverse_dt > 0) return predict_from_positions(r);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    if (r.previous.x) store3(r.previous, i, load3(r.x, i));
    move(r.x, r.v, r.w, Wide3{}, r.advance, i);
  }
}

void velocity(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes)
    store3(r.v, i, (load3(r.x, i) - load3(r.previous, i)) * wide(r.inverse_dt));
}

}  // namespace weft::WEFT_KERNELS
