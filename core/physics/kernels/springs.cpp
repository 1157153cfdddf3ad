// Springs as forces and the leapfrog step, one row at a time.
//
//   force on particle a from spring ab:  f = k (|e| - l) e/|e| = e (k - k l/|e|),  e = x_b - x_a
//   step:                                v <- c v + dt (f/m + g),   x <- x + dt v
//
// (seed 000, "Spring or Physical constraint" and "Verlet's Step", with the velocity kept in place of
// the previous position: the same method, without the rounding of x - x_previous.)
#include <cstddef>

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

enum Family { kRight, kDown, kDiagonal, kAntidiagonal, kRight2, kDown2, kFamilies };
static_assert(kFamilies == physics::kPlainFamilies);

// Where a block of lanes lies: the offsets of its first lane in the arrays, in the same column one
// and two rows below, and in the row.
struct Block {
  std::ptrdiff_t here, below, below2;
  int i;
  int parity;  // of the row: which of the two carries from two rows above
  const SpringConstants* springs;
};

// The first block of row j. Rows past the last stand for themselves; their springs have no stiffness.
WEFT_INLINE Block first_block(const SpringRows& s, int j) {
  const std::ptrdiff_t here = std::ptrdiff_t(j) * s.stride;
  const std::ptrdiff_t last = std::ptrdiff_t(s.rows - 1) * s.stride;
  const std::ptrdiff_t below = here + s.stride, below2 = below + s.stride;
  return {here,  below < last ? below : last, below2 < last ? below2 : last, 0, j % 2,
          s.springs + std::ptrdiff_t(j) * kFamilies};
}

WEFT_INLINE void advance(Block& b) {
  b.here += kLanes;
  b.below += kLanes;
  b.below2 += kLanes;
  b.i += kLanes;
}

// The fused kernel works block by block, row after row. Each of the six springs of a block passes
// four stations: square (edge and squared length), root, quotient (k l/|e|) and force. Stations of
// different springs are interleaved, with force four springs behind square, so that the divider
// always has work and nothing waits for it: the order of the statements is the schedule.
//
// The delays need no reset between rows: past a row's last spring they hold zeros.
struct Pipeline {
  Wide3 edge[kFamilies];
  Wide length[kFamilies];  // squared length, then length, then k l/|e|
  Wide3 own, below;        // force on the block in `force`, and on the row below it (negated)
  Delay3<1> right, diagonal, antidiagonal;
  Delay3<2> right2;

  template <Family F>
  WEFT_INLINE void square(const SpringRows& s, const Block& b) {
    const Wide3 near = load3(s.x, F == kAntidiagonal ? b.here + 1 : b.here);
    Wide3 far;
    if constexpr (F == kRight) far = load3(s.x, b.here + 1);
    if constexpr (F == kRight2) far = load3(s.x, b.here + 2);
    if constexpr (F == kDown || F == kAntidiagonal) far = load3(s.x, b.below);
    if constexpr (F == kDiagonal) far = load3(s.x, b.below + 1);
    if constexpr (F == kDown2) far = load3(s.x, b.below2);
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
  WEFT_INLINE void quotient(const Block& b) {
    length[F] = b.springs[F].kl / length[F];
    pin_order(length[F]);
  }
  // Force of family F on its near end; lanes past the last spring of the row are zero.
  template <Family F, bool kLast>
  WEFT_INLINE Wide3 spring(const SpringRows& s, const Block& b) const {
    const Wide3 f = edge[F] * (b.springs[F].k - length[F]);
    if constexpr (!kLast || F == kDown || F == kDown2) return f;
    return select(lanes_below(s.columns - (F == kRight2 ? 2 : 1) - b.i), f, Wide3{});
  }

  template <bool kLast>
  WEFT_INLINE void force_right(const SpringRows& s, const Block& b) {
    const Wide3 f = spring<kRight, kLast>(s, b);
    own = f - right.next(f);
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void force_right2(const SpringRows& s, const Block& b) {
    const Wide3 f = spring<kRight2, kLast>(s, b);
    own = own + (f - right2.next(f));
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void force_down(const SpringRows& s, const Block& b) {
    below = spring<kDown, kLast>(s, b);
    own = own + below;
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void force_diagonal(const SpringRows& s, const Block& b) {
    const Wide3 f = spring<kDiagonal, kLast>(s, b);
    own = own + f;
    below = below + diagonal.next(f);
    pin_order(own);
    pin_order(below);
  }
  template <bool kLast>
  WEFT_INLINE void force_antidiagonal(const SpringRows& s, const Block& b) {
    const Wide3 f = spring<kAntidiagonal, kLast>(s, b);
    below = below + f;
    own = own + antidiagonal.next(f) - load3(s.carry[0], b.i);
    store3(s.carry[0], b.i, below);
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void force_down2(const SpringRows& s, const Block& b) {
    const Wide3 f = spring<kDown2, kLast>(s, b);
    own = own + (f - load3(s.carry[1 + b.parity], b.i));
    store3(s.carry[1 + b.parity], b.i, f);
    pin_order(own);
  }
};

// Squares block b and gives it its first two forces, while the block before, a, gets the other four
// and moves. a_last and b_last: the row's last spring to the right lies in or before the block.
template <bool kA, bool kALast, bool kB, bool kBLast>
WEFT_INLINE void turn(Pipeline& p, const SpringRows& s, const Block& a, const Block& b) {
  if constexpr (kA) p.quotient<kDiagonal>(a);
  if constexpr (kB) p.square<kRight>(s, b);
  if constexpr (kA) p.root<kDown2>();
  if constexpr (kA) p.force_down<kALast>(s, a);
  if constexpr (kA) p.quotient<kAntidiagonal>(a);
  if constexpr (kB) p.square<kRight2>(s, b);
  if constexpr (kB) p.root<kRight>();
  if constexpr (kA) p.force_diagonal<kALast>(s, a);
  if constexpr (kA) p.quotient<kDown2>(a);
  if constexpr (kB) p.square<kDown>(s, b);
  if constexpr (kB) p.root<kRight2>();
  if constexpr (kA) p.force_antidiagonal<kALast>(s, a);
  if constexpr (kB) p.quotient<kRight>(b);
  if constexpr (kB) p.square<kDiagonal>(s, b);
  if constexpr (kB) p.root<kDown>();
  if constexpr (kA) p.force_down2<kALast>(s, a);
  if constexpr (kA) move(s.x, s.v, s.w, p.own, s.advance, a.here);
  if constexpr (kB) p.quotient<kRight2>(b);
  if constexpr (kB) p.square<kAntidiagonal>(s, b);
  if constexpr (kB) p.root<kDiagonal>();
  if constexpr (kB) p.force_right<kBLast>(s, b);
  if constexpr (kB) p.quotient<kDown>(b);
  if constexpr (kB) p.square<kDown2>(s, b);
  if constexpr (kB) p.root<kAntidiagonal>();
  if constexpr (kB) p.force_right2<kBLast>(s, b);
}

}  // namespace

void spring_rows(const SpringRows& given) {
  const SpringRows s = given;
  // A block is whole when all its springs two to the right exist.
  const auto last = [&](const Block& b) { return b.i + kLanes + 2 > s.columns; };
  Pipeline p{};
  Block a = first_block(s, s.begin), b = a;
  if (last(a))
    turn<false, false, true, true>(p, s, a, a);
  else
    turn<false, false, true, false>(p, s, a, a);
  advance(b);
  for (int j = s.begin; j < s.end; ++j) {
    if (j > s.begin) b = first_block(s, j);
    for (; b.i < s.columns; advance(b)) {
      if (last(b)) {
        if (last(a))
          turn<true, true, true, true>(p, s, a, b);
        else
          turn<true, false, true, true>(p, s, a, b);
      } else if (last(a)) {
        turn<true, true, true, false>(p, s, a, b);
      } else {
        turn<true, false, true, false>(p, s, a, b);
      }
      a = b;
    }
  }
  turn<true, true, false, false>(p, s, a, a);
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
