// Springs as forces and the leapfrog step, one row at a time.
//
//   force on particle a from spring ab:  f = k (|e| - l) e/|e| = e (k - k l/|e|),  e = x_b - x_a
//   step:                                v <- c v + dt (f/m + g),   x <- x + dt v
//
// (seed 000, "Spring or Physical constraint" and "Verlet's Step", with the velocity kept in place of
// the previous position: the same method, without the rounding of x - x_previous.)
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

// Squared length below which two particles count as coincident: no direction, no force.
constexpr float kTiny = 1e-30f;

// Keeps the compiler from moving or merging the computation of a value: the order below is the
// point of this kernel.
WEFT_INLINE void pin_order(Wide& v) {
#if WEFT_LANES == 16
  asm volatile("" : "+v"(v));
#else
  (void)v;
#endif
}
WEFT_INLINE void pin_order(Wide3& v) {
  pin_order(v.x);
  pin_order(v.y);
  pin_order(v.z);
}

enum Family { kRight, kRight2, kDown, kDiagonal, kAntidiagonal, kDown2, kFamilies };

// The state of the fused kernel for one block of lanes. Each of the six springs passes four
// stations: square (edge and squared length), root, reciprocal, force. Stations of different springs
// are interleaved, and force runs one block behind square, so that the divider always has work and
// no result is waited for.
struct Pipeline {
  const SpringRow& row;
  Wide3 edge[kFamilies];
  Wide length[kFamilies];  // squared length, then length, then its reciprocal
  Wide3 own, below;        // force on row j, and on row j+1 (negated), of the block in `force`
  Delay3<1> right, diagonal, antidiagonal;
  Delay3<2> right2;

  template <Family F>
  WEFT_INLINE void square(int i) {
    const SpringRow& r = row;
    const Wide3 near = load3(r.x, F == kAntidiagonal ? i + 1 : i);
    Wide3 far;
    if constexpr (F == kRight) far = load3(r.x, i + 1);
    if constexpr (F == kRight2) far = load3(r.x, i + 2);
    if constexpr (F == kDown || F == kAntidiagonal) far = load3(r.below, i);
    if constexpr (F == kDiagonal) far = load3(r.below, i + 1);
    if constexpr (F == kDown2) far = load3(r.below2, i);
    edge[F] = far - near;
    length[F] = max(dot(edge[F], edge[F]), wide(kTiny));
    pin_order(length[F]);
  }
  template <Family F>
  WEFT_INLINE void root() {
    length[F] = sqrt(length[F]);
    pin_order(length[F]);
  }
  template <Family F>
  WEFT_INLINE void reciprocal() {
    length[F] = 1.0f / length[F];
    pin_order(length[F]);
  }
  // Force of family F on its near end; lanes past the last spring of the row are zero.
  template <Family F, bool kLast>
  WEFT_INLINE Wide3 spring(int i) const {
    const SpringRow& r = row;
    const SpringConstants& c = F == kRight      ? r.right
                               : F == kRight2   ? r.right2
                               : F == kDown     ? r.down
                               : F == kDiagonal ? r.diagonal
                               : F == kDown2    ? r.down2
                                                : r.antidiagonal;
    const Wide3 f = edge[F] * (c.k - c.kl * length[F]);
    if constexpr (!kLast || F == kDown || F == kDown2) return f;
    return select(lanes_below(r.columns - (F == kRight2 ? 2 : 1) - i), f, Wide3{});
  }

  template <bool kLast>
  WEFT_INLINE void force_right(int i) {
    const Wide3 f = spring<kRight, kLast>(i);
    own = f - right.next(f);
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void force_right2(int i) {
    const Wide3 f = spring<kRight2, kLast>(i);
    own = own + (f - right2.next(f));
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void force_down(int i) {
    below = spring<kDown, kLast>(i);
    own = own + below;
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void force_diagonal(int i) {
    const Wide3 f = spring<kDiagonal, kLast>(i);
    own = own + f;
    below = below + diagonal.next(f);
    pin_order(own);
    pin_order(below);
  }
  template <bool kLast>
  WEFT_INLINE void force_antidiagonal(int i) {
    const Wide3 f = spring<kAntidiagonal, kLast>(i);
    below = below + f;
    own = own + antidiagonal.next(f) - load3(row.carry, i);
    store3(row.carry, i, below);
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void force_down2(int i) {
    const Wide3 f = spring<kDown2, kLast>(i);
    own = own + (f - load3(row.carry2, i));
    store3(row.carry2, i, f);
    pin_order(own);
  }

  // Squares block i while block i - kLanes gets its forces and moves.
  template <bool kBefore, bool kLast>
  WEFT_INLINE void turn(int i) {
    const int h = i - kLanes;
    if constexpr (kBefore) force_right<kLast>(h);
    square<kRight>(i);
    if constexpr (kBefore) reciprocal<kAntidiagonal>();
    if constexpr (kBefore) force_right2<kLast>(h);
    square<kRight2>(i);
    root<kRight>();
    if constexpr (kBefore) reciprocal<kDown2>();
    if constexpr (kBefore) force_down<kLast>(h);
    square<kDown>(i);
    root<kRight2>();
    reciprocal<kRight>();
    if constexpr (kBefore) force_diagonal<kLast>(h);
    square<kDiagonal>(i);
    root<kDown>();
    reciprocal<kRight2>();
    if constexpr (kBefore) force_antidiagonal<kLast>(h);
    square<kAntidiagonal>(i);
    root<kDiagonal>();
    reciprocal<kDown>();
    if constexpr (kBefore) force_down2<kLast>(h);
    const Wide3 f = own;
    square<kDown2>(i);
    root<kAntidiagonal>();
    reciprocal<kDiagonal>();
    if constexpr (kBefore) move(row.x, row.v, row.w, f, row.advance, h);
    root<kDown2>();
  }

  WEFT_INLINE void finish(int h) {
    reciprocal<kAntidiagonal>();
    reciprocal<kDown2>();
    force_right<true>(h);
    force_right2<true>(h);
    force_down<true>(h);
    force_diagonal<true>(h);
    force_antidiagonal<true>(h);
    force_down2<true>(h);
    move(row.x, row.v, row.w, own, row.advance, h);
  }
};

}  // namespace

void spring_row(const SpringRow& given) {
  const SpringRow row = given;
  Pipeline p{row, {}, {}, {}, {}, {}, {}, {}, {}};
  p.turn<false, false>(0);
  int i = kLanes;
  // A block is whole when its springs two to the right all exist.
  for (; i + 2 <= row.columns; i += kLanes) p.turn<true, false>(i);
  for (; i < row.columns; i += kLanes) p.turn<true, true>(i);
  p.finish(i - kLanes);
}

namespace {

// f_near += F, f_far -= F for every spring of the family. Within one row the difference of
// neighbouring springs is taken first, so that the sum has the same order at every width.
template <bool kDamped>
WEFT_INLINE void add_family(const FamilyRow& r) {
  const SpringConstants& c = r.spring;
  const Row3 scratch{r.scratch, r.scratch + r.stride, r.scratch + 2 * r.stride};
  for (int a = 0; a < padded(r.count); a += kLanes) {
    const Wide3 e = load3(r.x_far, a + r.far) - load3(r.x, a + r.near);
    const Wide squared = max(dot(e, e), wide(kTiny));
    const Wide reciprocal = 1.0f / sqrt(squared);
    Wide scale = c.k - c.kl * reciprocal;
    if constexpr (kDamped) {
      // f_d = k_d (ê·(v_b - v_a)) ê   (seed 000, "Spring and Friction")
      const Wide3 dv = load3(r.v_far, a + r.far) - load3(r.v, a + r.near);
      scale = scale + c.damping * (dot(e, dv) * (reciprocal * reciprocal));
    }
    const Wide3 f = select(lanes_below(r.count - a), e * scale, Wide3{});
    if (r.same_row) {
      store3(scratch, a, f);
    } else {
      store3(r.f, a + r.near, load3(r.f, a + r.near) + f);
      store3(r.f_far, a + r.far, load3(r.f_far, a + r.far) - f);
    }
  }
  if (!r.same_row) return;
  const int columns = r.count + r.far;
  for (int a = padded(r.count); a < padded(columns); a += kLanes)
    store3(scratch, a, Wide3{});
  for (int a = 0; a < padded(columns); a += kLanes)
    store3(r.f, a, load3(r.f, a) + (load3(scratch, a) - load3(scratch, a - r.far)));
}

}  // namespace

void spring_family(const FamilyRow& r) { add_family<false>(r); }
void damped_spring_family(const FamilyRow& r) { add_family<true>(r); }

void integrate(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    move(r.x, r.v, r.w, load3(r.f, i), r.advance, i);
    store3(r.f, i, Wide3{});
  }
}

}  // namespace weft::WEFT_KERNELS
