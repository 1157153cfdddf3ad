// The second-order substep: BDF2, the two-step backward differentiation formula.
//
//   x* = (4 x_n - x_{n-1})/3,   v* = (4 v_n - v_{n-1})/3
//   predict x* + ⅔h v',  v' = (v* + ⅔h g)/(1 + ⅔h c)         (c: drag)
//   constraints with (⅔h)² in the place of h²
//   v_{n+1} = 3 (x_{n+1} - x*)/(2h)                           v' and the corrections over ⅔h
//
// (Hairer, Wanner, "Solving Ordinary Differential Equations II", V.1.) A particle whose
// velocity is no longer what the substep before left, because a body or a limit has changed it,
// has no smooth past to extrapolate: it takes this substep by implicit Euler, x* = x_n, with h² for
// its share of every correction. Both kinds go through the same sweeps: the constraints are solved with ⅔h and inverse
// masses scaled by 1/(1 + ⅔h c), or by 9/4/(1 + h c). Zeros become positive, as in advance.cpp.
//
// All particles take the first substep, and the first after a change of h, by implicit Euler: the error of a single one
// is of order h², and so leaves the second order as it is. x* is such that without constraints they move by the mean of
// the velocities before and after, which is exact in free flight.
//
// In fine substeps what rounding leaves of a step goes into the next (kept.h): else velocities would tell of a motion
// that is not there.
#include "physics/kernels/second_order.h"

#include "physics/kernels/kept.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

using physics::SecondOrderRow;

namespace {

constexpr float kThird = 1.0f / 3.0f, kTwoThirds = 2.0f / 3.0f;

WEFT_INLINE WideInt equal(Wide3 a, Wide3 b) {
  return (a.x == b.x) & (a.y == b.y) & (a.z == b.z);
}

// What corrections are scaled by in a smooth step, and in one of implicit Euler; and what velocities lose by drag, which
// in fine substeps is too little to be told by what is left of 1.
struct Slowed {
  float smooth, euler, smooth_lost, euler_lost;
  explicit Slowed(const SecondOrderRow& r)
      : smooth(1.0f / (1.0f + r.dt * kTwoThirds * r.drag)),
        euler(1.0f / (1.0f + r.dt * r.drag)),
        smooth_lost(r.dt * kTwoThirds * r.drag * smooth),
        euler_lost(r.dt * r.drag * euler) {}
};

// Takes the corrections that sweeps have gathered. Velocities have them over ⅔h until then; those of an Euler step
// belong over h. Which kind the substep was its inverse masses tell.
template <bool kFine>
WEFT_INLINE void take(const SecondOrderRow& r, const Slowed& slowed, Wide mass, int i, Kept& x,
                      Kept& v) {
  if (r.u.x) {
    const Wide3 by = positive_zeros(load3(r.u, i));
    x.move<kFine>(by);
    v.move<kFine>(by * wide(1.5f / r.dt));
    store3(r.u, i, Wide3{});  // for the next sweeps
  }
  const WideInt euler = load(r.w + i) > mass * slowed.smooth;
  v.value = v.value * select(euler, wide(kTwoThirds), wide(1));
}

// kKnown: x and v are what they are; else they lack the corrections, and nobody else has touched them.
template <bool kKnown, bool kFine>
WEFT_INLINE void predict(const SecondOrderRow& given) {
  const SecondOrderRow r = given;
  const float h = r.dt, h2 = h * kTwoThirds;
  const Slowed slowed(r);
  const Wide3 g{wide(r.gx), wide(r.gy), wide(r.gz)};
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Kept x = kept_at<kFine>(r.x, r.left, i), v = kept_at<kFine>(r.v, r.v_left, i);
    const Wide mass = load(r.mass + i);
    const WideInt free = mass > 0.0f;
    // Of the others that are free, too; those that are not are held in the end.
    WideInt smooth = ~WideInt{};
    if constexpr (kKnown) {
      smooth = r.fresh ? WideInt{} : free & equal(v.value, load3(r.v_end, i));
    } else {
      take<kFine>(r, slowed, mass, i, x, v);
    }
    const auto either = [&](auto if_smooth, auto if_euler) {
      return kKnown ? select(smooth, if_smooth, if_euler) : if_smooth;
    };
    // In the substep before.
    const Wide3 by_x = x.value - load3(r.previous, i), by_v = v.value - load3(r.v_before, i);
    store3(r.previous, i, x.value);
    store3(r.v_before, i, v.value);
    const Wide step = either(wide(h2), wide(h));
    const Wide lost = either(wide(slowed.smooth_lost), wide(slowed.euler_lost));
    Kept to = x, velocity = v;
    const Wide3 gain = fma(g, step, either(by_v * wide(kThird), Wide3{}));
    velocity.move<kFine>(gain - (v.value + gain) * lost);
    const Wide3 back = r.fresh ? (v.value - velocity.value) * wide(0.5f * h) : Wide3{};
    to.move<kFine>(fma(velocity.value, step, either(by_x * wide(kThird), back)));
    store3(r.x, i, select(free, to.value, x.value));
    // Corrections will be added to v over ⅔h; an Euler step's belong over h.
    store3(r.v, i, select(free, velocity.value * either(wide(1), wide(1.5f)), v.value));
    if constexpr (kFine) {
      store3(r.left, i, select(free, to.left, Wide3{}));
      store3(r.v_left, i, select(free, velocity.left, Wide3{}));
    }
    store(r.w + i, mass * either(wide(slowed.smooth), wide(slowed.euler * 2.25f)));
  }
}

template <bool kFine>
WEFT_INLINE void find_velocity(const SecondOrderRow& given) {
  const SecondOrderRow r = given;
  const Slowed slowed(r);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide mass = load(r.mass + i);
    Kept x = kept_at<kFine>(r.x, r.left, i), v = kept_at<kFine>(r.v, r.v_left, i);
    take<kFine>(r, slowed, mass, i, x, v);
    store3(r.x, i, x.value);
    store3(r.v, i, v.value);
    if constexpr (kFine) {
      store3(r.left, i, x.left);
      store3(r.v_left, i, v.left);
    }
    store3(r.v_end, i, v.value);
    store(r.w + i, mass);
  }
}

}  // namespace

void predict_second_order(const SecondOrderRow& r) {
  if (r.left.x)
    r.v_waits ? predict<false, true>(r) : predict<true, true>(r);
  else
    r.v_waits ? predict<false, false>(r) : predict<true, false>(r);
}

void velocity_second_order(const SecondOrderRow& r) {
  r.left.x ? find_velocity<true>(r) : find_velocity<false>(r);
}

}  // namespace weft::WEFT_KERNELS
