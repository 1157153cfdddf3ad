// The second-order substep: BDF2, the two-step backward differentiation formula.
//
//   x* = (4 x_n - x_{n-1})/3,   v* = (4 v_n - v_{n-1})/3
//   predict x* + ⅔h v',  v' = (v* + ⅔h g)/(1 + ⅔h c)         (c: drag)
//   constraints with (⅔h)² in the place of h²
//   v_{n+1} = 3 (x_{n+1} - x*)/(2h)                           (v' and the corrections over ⅔h)
//
// (Hairer, Wanner, "Solving Ordinary Differential Equations II", V.1.) A particle whose
// velocity is no longer what the substep before left, because contact or a limit has changed it,
// has no smooth past to extrapolate: it takes this substep by implicit Euler, x* = x_n, with h² for
// its share of every correction. That is also the first substep of all, and the first
// after a change of h. Both kinds go through the same sweeps: the constraints are solved with ⅔h
// and inverse masses scaled by 1/(1 + ⅔h c), or by 9/4/(1 + h c).
#include "physics/kernels/second_order.h"

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

using physics::SecondOrderRow;

namespace {

WEFT_INLINE WideInt equal(Wide3 a, Wide3 b) {
  return (a.x == b.x) & (a.y == b.y) & (a.z == b.z);
}

}  // namespace

void predict_second_order(const SecondOrderRow& given) {
  const SecondOrderRow r = given;
  const float h = r.dt, h2 = h * (2.0f / 3.0f), third = 1.0f / 3.0f;
  const float slow = 1.0f / (1.0f + h * r.drag), slow2 = 1.0f / (1.0f + h2 * r.drag);
  const Wide3 g{wide(r.gx), wide(r.gy), wide(r.gz)};
  const WideInt known = r.fresh ? WideInt{} : ~WideInt{};
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 x = load3(r.x, i), v = load3(r.v, i);
    const Wide mass = load(r.mass + i);
    const WideInt free = mass > 0.0f;
    const WideInt smooth = known & free & equal(v, load3(r.v_end, i));
    const Wide3 x_star = x + (x - load3(r.previous, i)) * wide(third);
    const Wide3 v_star = v + (v - load3(r.v_before, i)) * wide(third);
    const Wide step = select(smooth, wide(h2), wide(h));
    const Wide slowed = select(smooth, wide(slow2), wide(slow));
    const Wide3 velocity = (select(smooth, v_star, v) + g * step) * slowed;
    store3(r.previous, i, x);
    store3(r.v_before, i, v);
    const Wide3 star = select(smooth, x_star, x);
    if (r.from_star) store3(r.star, i, star);
    store3(r.x, i, select(free, star + velocity * step, x));
    // Corrections will be added to v over ⅔h; an Euler step's belong over h.
    if (!r.from_star)
      store3(r.v, i, select(free, velocity * select(smooth, wide(1), wide(1.5f)), v));
    store(r.w + i, mass * select(smooth, wide(slow2), wide(slow * 2.25f)));
  }
}

void velocity_second_order(const SecondOrderRow& given) {
  const SecondOrderRow r = given;
  const float slow2 = 1.0f / (1.0f + r.dt * (2.0f / 3.0f) * r.drag);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide mass = load(r.mass + i);
    const WideInt euler = load(r.w + i) > mass * slow2;
    Wide3 v;
    if (!r.from_star)
      v = load3(r.v, i) * select(euler, wide(2.0f / 3.0f), wide(1));
    else
      v = (load3(r.x, i) - load3(r.star, i)) * select(euler, wide(1 / r.dt), wide(1.5f / r.dt));
    store3(r.v, i, v);
    store3(r.v_end, i, v);
    store(r.w + i, mass);
  }
}

}  // namespace weft::WEFT_KERNELS
