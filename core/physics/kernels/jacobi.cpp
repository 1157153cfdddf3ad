// Jacobi: the corrections of all constraints from the same positions, added up and relaxed.
//
//   x_i <- x_i + w_i Σ ± Δλ e/|e|,  Δλ = (|e| - l + α̃ λ)/((w_a + w_b)/ω + α̃),  λ <- λ - Δλ
//
// with ω the relaxation (model/lattice/sweeps.cpp), e = x_b - x_a, α̃ = 1/(k dt²).
#include "physics/kernels/kept.h"
#include "physics/kernels/plain_rows.h"
#include "physics/kernels/projection.h"

namespace weft::WEFT_KERNELS {
namespace {

// kAlike: all particles have one mass, but for columns at the sides where kSides is set, which stand for half.
template <bool kMayTear, bool kAlike, bool kSides>
struct JacobiLaw {
  using Rows = physics::JacobiRows;
  using Constants = physics::JacobiConstants;
  using Block = WEFT_KERNELS::Block<JacobiLaw>;
  static constexpr bool kRates = false, kTorn = kMayTear, kWatched = false;
  // Between particles of one inverse mass w: Δλ/|e| = κ - κ l/|e|, κ = 1/(2w/ω + α̃).
  template <PlainStencil F>
  WEFT_INLINE static Wide scale(const Rows& r, const Block& b, Wide reciprocal, Wide) {
    const Constants& c = b.constants[F];
    if constexpr (kAlike) {
      const Wide inner = fnma(wide(c.kl), reciprocal, wide(c.k));
      if constexpr (!kSides) return inner;
      // Along columns at the sides inverse masses and compliance are twice as much.
      if constexpr (along_column(F)) return inner * Block::of_columns(r.width, r, b);
      return at_sides<F>(r, b, inner);
    }
    constexpr bool kNextNear = F == kAntidiagonal, kNextFar = F == kRight || F == kDiagonal;
    const float* const far = F == kRight || F == kRight2 ? b.x : F == kDown2 ? b.below2 : b.below;
    const Wide wa = load(r.w + (b.x - r.x.x) + (kNextNear ? 1 : 0));
    const Wide wb = load(r.w + (far - r.x.x) + (kNextFar ? 1 : F == kRight2 ? 2 : 0));
    Wide compliance = wide(c.compliance);
    if constexpr (kSides && along_column(F))
      compliance = compliance * Block::of_columns(r.inverse_width, r, b);
    const Wide inertia = (wa + wb) * r.weight + compliance;
    // Two pinned ends of a rigid constraint have nothing to move.
    return select(inertia > 0.0f, fnma(wide(r.rest[F]), reciprocal, wide(1)) / inertia, Wide{});
  }
  // The first and the last constraint of a row have an end at a side.
  template <PlainStencil F>
  WEFT_INLINE static Wide at_sides(const Rows& r, const Block& b, Wide inner) {
    const Constants& c = b.constants[F];
    const int last = b.left - (F == kRight2 ? 3 : 2);
    if (b.left != r.columns && last >= kLanes) return inner;
    const WideInt first_lane = lane_numbers() == b.left - r.columns;
    const WideInt last_lane = lane_numbers() == last;
    return inner * select(first_lane & last_lane, wide(c.both_sides),
                          select(first_lane | last_lane, wide(c.one_side), wide(1)));
  }
  WEFT_INLINE static Wide inverse_mass(const Rows& r, const Block& b) {
    if constexpr (!kAlike) return load(r.w + (b.x - r.x.x));
    return kSides ? Block::of_columns(r.inverse_width, r, b) * r.alike : wide(r.alike);
  }
  WEFT_INLINE static void finish(const Rows& r, const Block& b, Wide3 sum) {
    const std::ptrdiff_t lane = b.x - r.x.x, plane = r.x.y - r.x.x;
    Wide3 change = sum * inverse_mass(r, b);
    if constexpr (kAlike) change = select(lanes_below(b.left), change, Wide3{});
    if (r.left.x.x) {
      Kept x = kept_at<true>(r.x, r.left.x, lane), v = kept_at<true>(r.v, r.left.v, lane);
      x.move<true>(change);
      v.move<true>(change * wide(r.inverse_dt));
      return store_kept<true>(r.x, r.v, r.left, lane, x, v);
    }
    store_planes(b.x, plane, load_planes(b.x, plane) + change);
    float* const v = r.v.x + lane;
    store_planes(v, plane, fma(change, wide(r.inverse_dt), load_planes(v, plane)));
  }
};

template <bool kMayTear, bool kAlike>
void jacobi_rows_of(const physics::JacobiRows& r) {
  r.sides ? plain_rows<JacobiLaw<kMayTear, kAlike, true>>(r)
          : plain_rows<JacobiLaw<kMayTear, kAlike, false>>(r);
}

// The corrections of a block of constraints by unit inverse mass.
template <bool Multipliers>
WEFT_INLINE Wide3 correction(const ProjectRows& p, const ProjectedRow& near,
                             const ProjectedRow& far, int j, int a) {
  Wide compliance = wide(p.compliance ? p.compliance[j] : 0);
  if (p.inverse_width) compliance = compliance * load(p.inverse_width + a);
  const Wide3 e = position(far, a) - position(near, a);
  const Wide length = sqrt(squared_length(e));
  const Wide inertia = (load(near.w + a) + load(far.w + a)) * p.weight + compliance;
  Wide violation = length - p.rest;
  float* const at = p.lambda + std::ptrdiff_t(j) * p.stride + a;
  Wide lambda{};
  if constexpr (Multipliers) {
    lambda = load(at);
    violation = fma(compliance, lambda, violation);
  }
  WideInt active = lanes_below(p.count - a) & (inertia > 0.0f);
  if (p.alive) active = active & alive_lanes(p, j, a);
  const Wide scale = select(active, violation / (inertia * length), Wide{});
  if constexpr (Multipliers) store(at, fnma(scale, length, lambda));
  return e * scale;
}

template <bool Multipliers, class DelayType>
WEFT_INLINE void sum_along(const ProjectRows& p, int j, Row3 sum, DelayType delay) {
  const ProjectedRow near = projected_row(p, j, 0), far = projected_row(p, j, p.far);
  for (int a = 0; a < padded(p.count + p.far); a += kLanes) {
    const Wide3 c = correction<Multipliers>(p, near, far, j, a);
    store3(sum, a, load3(sum, a) + (c - delay.next(c)));
  }
}

template <bool Multipliers>
void sum_stencil(const ProjectRows& p, int j, Row3 sum, Row3 sum_far) {
  if (p.dj == 0) {
    if (p.far == 1) return sum_along<Multipliers>(p, j, sum, Delay3<1>{});
    if (p.far == 2) return sum_along<Multipliers>(p, j, sum, Delay3<2>{});
    return sum_along<Multipliers>(p, j, sum, LongDelay3(p.far));
  }
  const ProjectedRow near = projected_row(p, j, p.near), far = projected_row(p, j + p.dj, p.far);
  for (int a = 0; a < padded(p.count); a += kLanes) {
    const Wide3 c = correction<Multipliers>(p, near, far, j, a);
    store3(sum, a + p.near, load3(sum, a + p.near) + c);
    store3(sum_far, a + p.far, load3(sum_far, a + p.far) - c);
  }
}

}  // namespace

void jacobi_rows(const physics::JacobiRows& r) {
  if (r.alive[0])
    r.alike > 0 ? jacobi_rows_of<true, true>(r) : jacobi_rows_of<true, false>(r);
  else
    r.alike > 0 ? jacobi_rows_of<false, true>(r) : jacobi_rows_of<false, false>(r);
}

void jacobi_stencil(const ProjectRows& p, int j, Row3 sum, Row3 sum_far) {
  if (p.lambda) return sum_stencil<true>(p, j, sum, sum_far);
  sum_stencil<false>(p, j, sum, sum_far);
}

}  // namespace weft::WEFT_KERNELS
