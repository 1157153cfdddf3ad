// Constraints by projection: position based dynamics and its compliant form (XPBD).
//
//   C = |e| - l,  n = e/|e|,  Δλ = -(C + α̃ λ)/(w_a + w_b + α̃),  α̃ = 1/(k dt²)
//   x_a <- x_a - w_a Δλ n,  x_b <- x_b + w_b Δλ n
//
// (Macklin, Müller, Chentanez 2016, "XPBD"; with α̃ = 0 seed 000's positional constraint for unequal
// masses. Gauss–Seidel takes one colour of one family at a time, all of whose constraints are
// disjoint; Jacobi adds up the corrections of all families and applies them at the end of a sweep.)
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

constexpr float kTiny = 1e-30f;

struct Correction {
  Wide3 near;  // change of the near end
  Wide3 far;   // the far end's change, negated
};

// The corrections of constraints a … a+kLanes-1, zero outside `active`; updates the multipliers.
WEFT_INLINE Correction solve(const ProjectRow& p, int a, WideInt active) {
  const FamilyRow& r = p.rows;
  const Wide3 e = load3(r.x_far, a + r.far) - load3(r.x, a + r.near);
  const Wide length = sqrt(max(dot(e, e), wide(kTiny)));
  const Wide wa = load(r.w + a + r.near), wb = load(r.w_far + a + r.far);
  const Wide stiffness = (wa + wb) * p.weight + p.compliance;
  Wide violation = length - p.rest;
  if (p.limit > 0) {
    violation = length - p.limit;
    active = active & (violation > 0.0f);
  }
  if (p.lambda) violation = violation + p.compliance * load(p.lambda + a);
  // Two pinned ends have nothing to move; the quotient is replaced, not computed.
  const WideInt movable = stiffness > 0.0f;
  const Wide step = violation / select(movable, stiffness, wide(1));
  const Wide lambda = select(active & movable, step, Wide{});
  if (p.lambda) store(p.lambda + a, load(p.lambda + a) - lambda);
  const Wide3 along = e * (lambda / length);
  return {along * wa, along * wb};
}

WEFT_INLINE void shift(const ProjectRow& p, Row3 x, Row3 v, int i, Wide3 change) {
  store3(x, i, load3(x, i) + change);
  if (p.inverse_dt > 0) store3(v, i, load3(v, i) + change * wide(p.inverse_dt));
}

WEFT_INLINE WideInt any_lane(const std::int32_t* lanes) {
  typedef WideInt Loose __attribute__((aligned(4), may_alias));
  return *reinterpret_cast<const Loose*>(lanes);
}

// The lanes `far` earlier in a row, for any distance up to 16: through a small buffer that holds the
// block before.
class LaneDelay {
 public:
  explicit LaneDelay(int distance) : distance_(distance) {}
  WEFT_INLINE Wide3 next(Wide3 block) {
    store3({x_ + 16, y_ + 16, z_ + 16}, 0, block);
    const int at = 16 - distance_;
    const Wide3 delayed = load3(ConstRow3(x_, y_, z_), at);
    for (int i = 0; i < 16; ++i) {
      x_[i] = x_[i + kLanes];
      y_[i] = y_[i + kLanes];
      z_[i] = z_[i + kLanes];
    }
    return delayed;
  }

 private:
  int distance_;
  alignas(64) float x_[32] = {}, y_[32] = {}, z_[32] = {};
};

template <class DelayType>
WEFT_INLINE void project_in_row(const ProjectRow& p, DelayType delay) {
  const FamilyRow& r = p.rows;
  const int columns = r.count + r.far;
  for (int a = 0; a < padded(columns); a += kLanes) {
    const WideInt active = any_lane(p.lanes + a) & lanes_below(r.count - a);
    const Correction c = solve(p, a, active);
    shift(p, r.x, r.v, a, c.near - delay.next(c.far));
  }
}

}  // namespace

void project(const ProjectRow& p) {
  const FamilyRow& r = p.rows;
  if (r.same_row) {
    if (r.far == 1) return project_in_row(p, Delay3<1>{});
    if (r.far == 2) return project_in_row(p, Delay3<2>{});
    return project_in_row(p, LaneDelay(r.far));
  }
  for (int a = 0; a < padded(r.count); a += kLanes) {
    const Correction c = solve(p, a, lanes_below(r.count - a));
    shift(p, r.x, r.v, a + r.near, c.near);
    shift(p, r.x_far, r.v_far, a + r.far, Wide3{} - c.far);
  }
}

void project_jacobi(const ProjectRow& p) {
  const FamilyRow& r = p.rows;
  if (r.same_row) {
    const int columns = r.count + r.far;
    LaneDelay delay(r.far);
    for (int a = 0; a < padded(columns); a += kLanes) {
      const Correction c = solve(p, a, lanes_below(r.count - a));
      store3(r.f, a, load3(r.f, a) + (c.near - delay.next(c.far)));
    }
    return;
  }
  for (int a = 0; a < padded(r.count); a += kLanes) {
    const Correction c = solve(p, a, lanes_below(r.count - a));
    store3(r.f, a + r.near, load3(r.f, a + r.near) + c.near);
    store3(r.f_far, a + r.far, load3(r.f_far, a + r.far) - c.far);
  }
}

void apply_corrections(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    store3(r.x, i, load3(r.x, i) + load3(r.f, i));
    if (r.inverse_dt > 0) store3(r.v, i, load3(r.v, i) + load3(r.f, i) * wide(r.inverse_dt));
    store3(r.f, i, Wide3{});
  }
}

void predict(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    store3(r.previous, i, load3(r.x, i));
    move(r.x, r.v, r.w, Wide3{}, r.advance, i);
  }
}

void velocity(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes)
    store3(r.v, i, (load3(r.x, i) - load3(r.previous, i)) * wide(r.inverse_dt));
}

}  // namespace weft::WEFT_KERNELS
