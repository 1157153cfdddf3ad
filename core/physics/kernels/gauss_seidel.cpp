// Gauss–Seidel: constraints by projection, one colour of one stencil at a time, all of whose
// constraints are disjoint. Position based dynamics and its compliant form (XPBD):
//
//   C = |e| - l,  Δλ = (C + α̃ λ)/(w_a + w_b + α̃),  α̃ = 1/(k dt²),  λ <- λ - Δλ
//   x_a <- x_a + w_a Δλ e/|e|,  x_b <- x_b - w_b Δλ e/|e|,  e = x_b - x_a
//
// (Macklin, Müller, Chentanez 2016, "XPBD"; with α̃ = 0 seed 000's positional constraint for unequal
// masses.)
//
// A strain limit that holds has forces f >= 0 for multipliers, which last from substep to substep. Sweep
// `carry` pulls by f dt². Sweeps `hold` see to it that nothing longer than the length held, l, grows, and that
// what is beyond the limit L at the substep's start, l₀, becomes shorter by Δ (Baumgarte 1972),
//
//   f <- max(0, f + ω (|e| - max(l, l₀ - Δ))/((w_a + w_b) dt²)),   Δ = min(β max(0, l₀ - L), rate dt l)
//
// and `settle` takes back a share of what is too long all the same, in positions alone, so that it makes no
// speed. (Sequential impulses with a warm start: Catto 2005; positions apart: Bridson et al. 2002.) No force
// that lasts is stronger than F, or than what would bring the ends together within a substep: where pins leave
// no room for the limit, forces would grow without end, and where substeps are long, sweeps cannot balance them.
#include "physics/kernels/alike_rows.h"

namespace weft::WEFT_KERNELS {
namespace {

WEFT_INLINE Wide compliance_of(const ProjectRows& p, int j, int a) {
  if (!p.compliance) return Wide{};
  return p.inverse_width ? load(p.inverse_width + a) * p.compliance[j] : wide(p.compliance[j]);
}

// The correction of constraints a … of row j by unit inverse mass, zero outside `active`.
template <Rule R>
WEFT_INLINE Wide3 solve(const ProjectRows& p, Wide3 e, Wide wa, Wide wb, int j, int a, Wide& lambda,
                        WideInt active) {
  const Wide length = sqrt(squared_length(e));
  Wide violation = length - p.rest, inertia = (wa + wb) * p.weight;
  const Wide compliance = compliance_of(p, j, a);
  if constexpr (R == Rule::compliant || R == Rule::multipliers)
    inertia = inertia + compliance;
  else
    active = active & (inertia > 0.0f);  // two pinned ends have nothing to move
  if constexpr (R == Rule::limit) active = active & (violation > 0.0f);
  if constexpr (R == Rule::multipliers) violation = fma(compliance, lambda, violation);
  const Wide scale = select(active, violation / (inertia * length), Wide{});
  if constexpr (R == Rule::multipliers) lambda = fnma(scale, length, lambda);
  return e * scale;
}

// Relaxation of the forces of a limit, and the share of what is too long that one sweep takes back. Forces
// meet the change of a load sooner with more than 1; with 2 they would never come to rest. What is taken back
// at once leaves neighbours slack, whose forces are then lost.
constexpr float kHoldRelaxation = 1.5f, kSettled = 0.3f;
// Share of what is too long that is taken back as speed, and how fast at most [1/s]. Without it a sheet that
// bodies push into stretches to many times its limit; with a share of 0.1 to four times, with 0.3 to two. Any
// faster, and what pins draw apart is thrown about.
constexpr float kTakenBack = 0.3f, kFastest = 5;

// Of the ends that lie at lane i.
WEFT_INLINE Wide3 velocity(const ProjectRows& p, const ProjectedRow& r, int i) {
  return load_planes(p.v.x + (r.x + i - p.x.x), r.plane);
}

// The correction of a limit's constraints a … of row j by unit inverse mass.
template <Rule R>
WEFT_INLINE Wide3 limit_block(const ProjectRows& p, const ProjectedRow& near,
                              const ProjectedRow& far, Wide wa, Wide wb, int j, int a,
                              WideInt active) {
  const Wide3 e = position(far, a) - position(near, a);
  const Wide square = dot(e, e), inertia = wa + wb, dt2 = wide(p.dt * p.dt);
  float* const forces = p.lambda + std::ptrdiff_t(j) * p.stride + a;
  Wide force = load(forces);
  active = active & (inertia > 0.0f) & (square > 0.0f);
  const WideInt longer = square > p.rest * p.rest, pulls = force > 0.0f;
  active = active & (R == Rule::carry ? pulls : R == Rule::hold ? pulls | longer : longer);
  if (!any(active)) return Wide3{};
  const Wide length = sqrt(square);
  if constexpr (R == Rule::carry) {
    const Wide most = min(wide(p.strongest), wide(p.rest) / (inertia * dt2));
    force = select(active, min(force, most), force);
    store(forces, force);
    return e * select(active, force * dt2 / length, Wide{});
  }
  if constexpr (R == Rule::settle)
    return e * select(active, (length - p.rest) * kSettled / (inertia * length), Wide{});
  const Wide start =
      sqrt(squared_length(e - (velocity(p, far, a) - velocity(p, near, a)) * wide(p.dt)));
  const Wide beyond = max(start - wide(p.most), Wide{});
  const Wide back = min(beyond * kTakenBack, wide(kFastest * p.rest * p.dt));
  const Wide allowed = max(start - back, wide(p.rest));
  const Wide asked = force + (length - allowed) * kHoldRelaxation / (inertia * dt2);
  const Wide held = select(active, select(asked > 0.0f, asked, Wide{}), force);
  store(forces, held);
  return e * select(active, (held - force) * dt2 / length, Wide{});
}

// Ends constraints past their tear length, each as long as in the mean of before and after its own correction c.
// Where sweeps are few, constraints solved last are at rest and others have all that these have lost: so long they
// all are at some time in the sweep, and the sheet is in the mean.
WEFT_INLINE void tear_overlong(const ProjectRows& p, Wide3 e, Wide3 c, Wide inertia, int j, int a,
                               WideInt active) {
  const WideInt over = active & (squared_length(fnma(c, inertia * 0.5f, e)) > p.longest_square);
  if (!any(over)) return;
  std::int32_t* const alive = p.alive + std::ptrdiff_t(j) * p.stride + a;
  put_lanes(alive, lanes_at(alive) & ~over);
  p.ended[j] += __builtin_popcount(bits(over));
}

// The same for constraints a … a+kLanes-1 between the lanes of two rows.
template <Rule R, bool kTorn>
WEFT_INLINE Wide3 solve_block(const ProjectRows& p, const ProjectedRow& near,
                              const ProjectedRow& far, Wide wa, Wide wb, int j, int a,
                              WideInt active) {
  if constexpr (limits(R) && R != Rule::limit)
    return limit_block<R>(p, near, far, wa, wb, j, a, active);
  const Wide3 e =
      limits(R) ? position(far, a) - position(near, a) : corrected(far, a) - corrected(near, a);
  if constexpr (R == Rule::limit) {
    // Most blocks have nothing too long: the root is not worth taking there. Each lane is asked, so that
    // it does not matter which others are in its block.
    active = active & (dot(e, e) > p.rest * p.rest);
    if (!any(active)) return Wide3{};
  }
  Wide lambda{};
  float* at = nullptr;
  if constexpr (R == Rule::multipliers) {
    at = p.lambda + std::ptrdiff_t(j) * p.stride + a;
    lambda = load(at);
  }
  const Wide3 c = solve<R>(p, e, wa, wb, j, a, lambda, active);
  if constexpr (R == Rule::multipliers) store(at, lambda);
  if constexpr (kTorn && !limits(R))
    if (p.longest_square > 0) tear_overlong(p, e, c, wa + wb, j, a, active);
  return c;
}

// The strain limit changes positions and velocities together, but where it settles, and seldom anything at
// all.
template <Rule R>
WEFT_INLINE void move_end(const ProjectRows& p, const ProjectedRow& r, int i, Wide3 change) {
  if constexpr (limits(R)) {
    const WideInt some = (change.x != 0.0f) | (change.y != 0.0f) | (change.z != 0.0f);
    if (!any(some)) return;
    // Adding zero would make +0 of -0 in lanes that only their block brings here.
    float* const v = p.v.x + (r.x + i - p.x.x);
    const Wide3 v0 = load_planes(v, r.plane), x0 = load_planes(r.x + i, r.plane);
    if constexpr (R != Rule::settle)
      store_planes(v, r.plane, select(some, v0 + change * wide(p.inverse_dt), v0));
    store_planes(r.x + i, r.plane, select(some, x0 + change, x0));
  } else {
    gather(r, i, change);
  }
}

// One colour along row j, whatever the offset: the lanes of the other colour stand by.
template <Rule R, bool kTorn>
WEFT_INLINE void along_row(const ProjectRows& p, int j, int colour) {
  const ProjectedRow near = projected_row(p, j, 0), far = projected_row(p, j, p.far);
  const std::int32_t* const lanes = p.lanes + std::ptrdiff_t(colour) * p.stride;
  LongDelay3 delay(p.far);
  for (int a = 0; a < p.count + p.far; a += kLanes) {
    const Wide wa = load(near.w + a), wb = load(far.w + a);
    WideInt active = lanes_at(lanes + a);
    if constexpr (kTorn) active = active & alive_lanes(p, j, a);
    const Wide3 c = solve_block<R, kTorn>(p, near, far, wa, wb, j, a, active);
    move_end<R>(p, near, a, c * wa - delay.next(c * wb));
  }
}

// The constraints between rows j and j+dj.
template <Rule R, bool kTorn>
WEFT_INLINE void between_rows(const ProjectRows& p, int j) {
  const ProjectedRow near = projected_row(p, j, p.near), far = projected_row(p, j + p.dj, p.far);
  for (int a = 0; a < p.count; a += kLanes) {
    const Wide wa = load(near.w + a), wb = load(far.w + a);
    WideInt active = lanes_below(p.count - a);
    if constexpr (kTorn) active = active & alive_lanes(p, j, a);
    const Wide3 c = solve_block<R, kTorn>(p, near, far, wa, wb, j, a, active);
    move_end<R>(p, near, a, c * wa);
    move_end<R>(p, far, a, Wide3{} - c * wb);
  }
}

// Whether any constraint of row j is longer than its rest length, or pulls already. Rows where none does,
// most of them, have nothing to do for the strain limit.
template <Rule R, bool kTorn>
WEFT_INLINE bool any_to_limit(const ProjectRows& p, int j) {
  const ProjectedRow near = projected_row(p, j, p.near), far = projected_row(p, j + p.dj, p.far);
  WideInt over{};
  for (int a = 0; a < p.count; a += kLanes) {
    const Wide3 e = position(far, a) - position(near, a);
    WideInt longer = dot(e, e) > p.rest * p.rest;
    if constexpr (R == Rule::carry || R == Rule::hold)
      longer = longer | (load(p.lambda + std::ptrdiff_t(j) * p.stride + a) > 0.0f);
    if (a + kLanes > p.count) longer = longer & lanes_below(p.count - a);
    if constexpr (kTorn) longer = longer & alive_lanes(p, j, a);
    over = over | longer;
  }
  return any(over);
}

template <Rule R, bool kTorn>
void sweep_stencil(const ProjectRows& stencil, const physics::Projection& given) {
  const ProjectRows p = stencil;  // a copy that no store can alias
  const int end = given.end, colour = given.colour;
  Alike constants{};
  for (int j = given.begin; j < end; ++j) {
    if (p.dj > 0 && (j / p.dj % 2 != colour || j + p.dj >= p.rows)) continue;
    if constexpr (limits(R)) {
      if (!any_to_limit<R, kTorn>(p, j)) continue;
    } else if constexpr (!kTorn) {
      const float w = p.row_w ? p.row_w[j] : 0;
      if (w > 0 && w == p.row_w[j + p.dj]) {
        // A division is long to wait for, and mostly the row before has had the same.
        if (w != constants.w || compliance_at(p, j) != constants.compliance)
          constants = alike(p, j, w);
        if (j + 1 < end && two_rows_alike<R>(p, j, constants))
          ++j;
        else
          row_alike<R>(p, j, constants);
        continue;
      }
    }
    if (p.dj > 0) {
      between_rows<R, kTorn>(p, j);
    } else {
      for (int c = 0; c < 2; ++c) along_row<R, kTorn>(p, j, c);
    }
  }
}

template <Rule R, bool kTorn>
void sweep(const physics::Projection& p) {
  for (int f = 0; f < p.count; ++f) sweep_stencil<R, kTorn>(p.stencils[f], p);
}

template <bool kTorn>
void sweep_by_rule(const physics::Projection& p) {
  const ProjectRows& f = p.stencils[0];
  switch (f.limit) {
    case physics::LimitSweep::none:
      break;
    case physics::LimitSweep::once:
      return sweep<Rule::limit, kTorn>(p);
    case physics::LimitSweep::carry:
      return sweep<Rule::carry, kTorn>(p);
    case physics::LimitSweep::hold:
      return sweep<Rule::hold, kTorn>(p);
    case physics::LimitSweep::settle:
      return sweep<Rule::settle, kTorn>(p);
  }
  if (f.lambda) return sweep<Rule::multipliers, kTorn>(p);
  if (f.compliance) return sweep<Rule::compliant, kTorn>(p);
  sweep<Rule::rigid, kTorn>(p);
}

}  // namespace

void project(const physics::Projection& p) {
  if (p.stencils[0].alive) return sweep_by_rule<true>(p);
  sweep_by_rule<false>(p);
}

}  // namespace weft::WEFT_KERNELS
