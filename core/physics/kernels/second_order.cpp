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
// its share of every correction. Before the first substep of all, and the first after a change of h, lies
// free flight, x_{n-1} = x_n - h v_n + ½h² a, v_{n-1} = v_n - h a, a = g - c v_n. Both kinds go through the
// same sweeps: the constraints are solved with ⅔h and inverse masses scaled by 1/(1 + ⅔h c), or by
// 9/4/(1 + h c). Zeros become positive, as in advance.cpp.
#include "physics/kernels/second_order.h"

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

using physics::SecondOrderRow;

namespace {

constexpr float kThird = 1.0f / 3.0f, kTwoThirds = 2.0f / 3.0f;

WEFT_INLINE WideInt equal(Wide3 a, Wide3 b) {
  return (a.x == b.x) & (a.y == b.y) & (a.z == b.z);
}

// What corrections are scaled by in a smooth step, and in one of implicit Euler.
struct Slowed {
  float smooth, euler;
  explicit Slowed(const SecondOrderRow& r)
      : smooth(1.0f / (1.0f + r.dt * kTwoThirds * r.drag)), euler(1.0f / (1.0f + r.dt * r.drag)) {}
};

// Takes the corrections that sweeps have gathered. Velocities have them over ⅔h until then; those of an Euler step
// belong over h. Which kind the substep was its inverse masses tell.
WEFT_INLINE void take(const SecondOrderRow& r, const Slowed& slowed, Wide mass, int i, Wide3& x,
                      Wide3& v) {
  if (r.u.x) {
    const Wide3 by = positive_zeros(load3(r.u, i));
    x = x + by;
    v = fma(by, wide(1.5f / r.dt), v);
    store3(r.u, i, Wide3{});  // for the next sweeps
  }
  const WideInt euler = load(r.w + i) > mass * slowed.smooth;
  v = v * select(euler, wide(kTwoThirds), wide(1));
}

// kKnown: x and v are what they are; else they lack the corrections, and nobody else has touched them.
template <bool kKnown>
WEFT_INLINE void predict(const SecondOrderRow& given) {
  const SecondOrderRow r = given;
  const float h = r.dt, h2 = h * kTwoThirds;
  const Slowed slowed(r);
  const Wide3 g{wide(r.gx), wide(r.gy), wide(r.gz)};
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Wide3 x = positive_zeros(load3(r.x, i)), v = positive_zeros(load3(r.v, i));
    const Wide mass = load(r.mass + i);
    const WideInt free = mass > 0.0f;
    // Of the others that are free, too; those that are not are held in the end.
    WideInt smooth = ~WideInt{};
    if constexpr (kKnown) {
      smooth = free;
      if (!r.fresh) smooth = smooth & equal(v, load3(r.v_end, i));
    } else {
      take(r, slowed, mass, i, x, v);
    }
    const auto either = [&](auto if_smooth, auto if_euler) {
      return kKnown ? select(smooth, if_smooth, if_euler) : if_smooth;
    };
    Wide3 by_x, by_v;  // in the substep before
    if (r.fresh) {
      by_v = (g - v * wide(r.drag)) * wide(h);
      by_x = v * wide(h) - by_v * wide(0.5f * h);
    } else {
      by_x = x - load3(r.previous, i);
      by_v = v - load3(r.v_before, i);
    }
    const Wide3 x_star = fma(by_x, wide(kThird), x);
    const Wide3 v_star = fma(by_v, wide(kThird), v);
    const Wide step = either(wide(h2), wide(h));
    const Wide slow = either(wide(slowed.smooth), wide(slowed.euler));
    const Wide3 velocity = fma(g, step, either(v_star, v)) * slow;
    store3(r.previous, i, x);
    store3(r.v_before, i, v);
    store3(r.x, i, select(free, fma(velocity, step, either(x_star, x)), x));
    // Corrections will be added to v over ⅔h; an Euler step's belong over h.
    store3(r.v, i, select(free, velocity * either(wide(1), wide(1.5f)), v));
    store(r.w + i, mass * either(wide(slowed.smooth), wide(slowed.euler * 2.25f)));
  }
}

}  // namespace

void predict_second_order(const SecondOrderRow& r) {
  r.v_waits ? predict<false>(r) : predict<true>(r);
}

void velocity_second_order(const SecondOrderRow& given) {
  const SecondOrderRow r = given;
  const Slowed slowed(r);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide mass = load(r.mass + i);
    Wide3 x = positive_zeros(load3(r.x, i)), v = positive_zeros(load3(r.v, i));
    take(r, slowed, mass, i, x, v);
    store3(r.x, i, x);
    store3(r.v, i, v);
    store3(r.v_end, i, v);
    store(r.w + i, mass);
  }
}

}  // namespace weft::WEFT_KERNELS
