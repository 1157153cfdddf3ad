// Springs as forces and the leapfrog step, one row at a time.
//
//   force on particle a from spring ab:  f = k (|e| - l) e/|e| = e (k - k l/|e|),  e = x_b - x_a
//   its damping:                         f_d = k_d (ê·(v_b - v_a)) ê   (seed 000, "Spring and Friction")
//   step:                                v <- c v + kick (f/m + g),   x <- x + dt v
//
// (seed 000, "Spring or Physical constraint" and "Verlet's Step", with the velocity kept in place of
// the previous position: the same method, without the rounding of x - x_previous.)
#include "physics/kernels/leapfrog.h"
#include "physics/kernels/plain_rows.h"

namespace weft::WEFT_KERNELS {
namespace {

enum class Tear { never, torn, watched };

// kSides: columns at the sides stand for half.
template <bool kDamped, Tear kTear, bool kSides, bool kAlike = false>
struct SpringLaw {
  using Rows = SpringRows;
  using Constants = SpringConstants;
  using Block = WEFT_KERNELS::Block<SpringLaw>;
  static constexpr bool kRates = kDamped, kTorn = kTear != Tear::never,
                        kWatched = kTear == Tear::watched;
  template <PlainStencil F>
  WEFT_INLINE static Wide scale(const Rows& r, const Block& b, Wide reciprocal, Wide rate) {
    const SpringConstants& c = b.constants[F];
    Wide spring = fnma(wide(c.kl), reciprocal, wide(c.k));
    if constexpr (kDamped) spring = fma(c.damping * rate, reciprocal * reciprocal, spring);
    if constexpr (kSides && along_column(F)) spring = spring * Block::of_columns(r.width, r, b);
    return spring;
  }
  template <PlainStencil F>
  WEFT_INLINE static WideInt too_long(const Rows&, const Block& b, Wide reciprocal) {
    return reciprocal < b.constants[F].taut;
  }
  WEFT_INLINE static void tell(const Rows& r, std::ptrdiff_t row) { r.overlong[row] = 1; }
  WEFT_INLINE static void finish(const Rows& r, const Block& b, Wide3 force) {
    leapfrog<kSides, kAlike>(r, b.x, b.left, force);
  }
};

template <bool kDamped, bool kSides>
void spring_rows_of(const SpringRows& r) {
  if (!r.alive[0])
    return r.alike > 0 ? plain_rows<SpringLaw<kDamped, Tear::never, kSides, true>>(r)
                       : plain_rows<SpringLaw<kDamped, Tear::never, kSides>>(r);
  if (!r.overlong) return plain_rows<SpringLaw<kDamped, Tear::torn, kSides>>(r);
  plain_rows<SpringLaw<kDamped, Tear::watched, kSides>>(r);
}
template <bool kDamped>
void spring_rows_of(const SpringRows& r) {
  r.sides ? spring_rows_of<kDamped, true>(r) : spring_rows_of<kDamped, false>(r);
}

// f_near += F, f_far -= F for every spring of the stencil. Within one row the difference of
// neighbouring springs is taken first, so that the sum has the same order at every width.
template <bool kDamped, bool kTorn>
WEFT_INLINE void add_stencil(const StencilRow& r) {
  const SpringConstants& c = r.spring;
  const Row3 scratch{r.scratch, r.scratch + r.stride, r.scratch + 2 * r.stride};
  for (int a = 0; a < padded(r.count); a += kLanes) {
    const Wide3 e = load3(r.x_far, a + r.far) - load3(r.x, a + r.near);
    const Wide reciprocal = reciprocal_root(squared_length(e));
    Wide scale = fnma(wide(c.kl), reciprocal, wide(c.k));
    if constexpr (kDamped) {
      const Wide3 dv = load3(r.v_far, a + r.far) - load3(r.v, a + r.near);
      scale = fma(c.damping * dot(e, dv), reciprocal * reciprocal, scale);
    }
    if (r.factor) scale = scale * load(r.factor + a);
    WideInt active = lanes_below(r.count - a);
    if constexpr (kTorn) active = active & lanes_at(r.alive + a);
    const Wide3 f = select(active, e * scale, Wide3{});
    if (r.same_row) {
      store3(scratch, a, f);
    } else {
      store3(r.f, a + r.near, load3(r.f, a + r.near) + f);
      store3(r.f_far, a + r.far, load3(r.f_far, a + r.far) - f);
    }
  }
  if (!r.same_row) return;
  const int columns = r.count + r.far;
  for (int a = padded(r.count); a < padded(columns); a += kLanes) store3(scratch, a, Wide3{});
  for (int a = 0; a < padded(columns); a += kLanes)
    store3(r.f, a, load3(r.f, a) + (load3(scratch, a) - load3(scratch, a - r.far)));
}

}  // namespace

void spring_rows(const SpringRows& r) {
  r.damped ? spring_rows_of<true>(r) : spring_rows_of<false>(r);
}
void spring_stencil(const StencilRow& r) {
  if (r.alive) return add_stencil<false, true>(r);
  add_stencil<false, false>(r);
}
void damped_spring_stencil(const StencilRow& r) {
  if (r.alive) return add_stencil<true, true>(r);
  add_stencil<true, false>(r);
}

void integrate(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    move(r.x, r.v, r.left, r.w, load3(r.f, i), r.advance, i);
    store3(r.f, i, Wide3{});
  }
}

}  // namespace weft::WEFT_KERNELS
