// What goes before and after the sweeps of methods that project: prediction, corrections, velocities.
//
// Sweeps compute whole blocks, and so add zeros to lanes that none of their constraints has. Which lanes these are
// depends on the vectors' width, and -0 stays as it is or becomes +0. A correction that underflows leaves -0. So
// here every -0 becomes +0 (adding +0 does that): all widths have the same bits where a substep ends.
#include "physics/kernels/kept.h"

namespace weft::WEFT_KERNELS {

namespace {

template <bool kFine>
WEFT_INLINE void correct(Kept& x, Kept& v, Wide3 change, float inverse_dt) {
  x.move<kFine>(change);
  v.move<kFine>(change * wide(inverse_dt));
}

template <bool kFine>
void apply(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Kept x = kept_at<kFine>(r.x, r.left.x, i), v = kept_at<kFine>(r.v, r.left.v, i);
    Wide3 change = positive_zeros(load3(r.f, i));
    if (r.w) change = change * load(r.w + i);
    correct<kFine>(x, v, change, r.inverse_dt);
    store_kept<kFine>(r.x, r.v, r.left, i, x, v);
    store3(r.f, i, Wide3{});
  }
}

template <bool kFine>
void advance(const AdvanceRow& given) {
  const AdvanceRow r = given;  // a copy that no store can alias
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Kept x = kept_at<kFine>(r.x, r.left.x, i), v = kept_at<kFine>(r.v, r.left.v, i);
    if (r.f.x) {
      correct<kFine>(x, v, positive_zeros(load3(r.f, i)), r.inverse_dt);
      store3(r.f, i, Wide3{});  // for the next sweeps
    }
    const WideInt free = load(r.w + i) > 0.0f;
    if constexpr (kFine) {
      drop_where_at_rest(x, v);
      v.move<true>(gained(v.value, free, Wide{}, Wide3{}, r.advance));
    } else {
      v.value = moved(v.value, free, Wide{}, Wide3{}, r.advance);
    }
    x.move<kFine>(v.value * wide(r.advance.dt));
    store_kept<kFine>(r.x, r.v, r.left, i, x, v);
  }
}

}  // namespace

void apply_corrections(const AdvanceRow& r) {
  r.left.x.x ? apply<true>(r) : apply<false>(r);
}

void predict(const AdvanceRow& r) {
  r.left.x.x ? advance<true>(r) : advance<false>(r);
}

}  // namespace weft::WEFT_KERNELS
