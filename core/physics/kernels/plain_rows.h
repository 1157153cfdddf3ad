// The six families of a plain cloth in one pass over the rows: every constraint is evaluated once, in
// the row of its near end, and what it does to the rows below is carried along, so that a row is
// finished, and moved in place, as soon as its own constraints are done.
//
// A `Law` says what a constraint does to its ends and how a finished row moves:
//
//   Law::Rows                                     the kernel's argument, a PlainRows
//   Law::kTorn                                    whether constraints may have died (PlainRows::alive)
//   Law::kRates                                   whether pulls depend on velocities
//   Law::quotient<F>(rows, block, length)         of family F: by the one division it needs
//   Law::pull<F>(rows, block, edge, quotient, edge·velocity)
//                                                 on the near end; the far end gets its negative
//   Law::finish(rows, sum, lane)                  moves a block by the sum of its pulls
#pragma once

#include <cstddef>

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

// Squared length below which two particles count as coincident: no direction, no force.
inline constexpr float kTiny = 1e-30f;

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

enum PlainFamily { kRight, kDown, kDiagonal, kAntidiagonal, kRight2, kDown2, kFamilies };
static_assert(kFamilies == physics::kPlainFamilies);

// Where a block of lanes lies: the offsets of its first lane in the arrays, in the same column one
// and two rows below, and in the row.
struct Block {
  std::ptrdiff_t here, below, below2;
  int i;
  int parity;                // of the row: which of the two carries from two rows above
  std::ptrdiff_t constants;  // number of the row's first family
};

// The first block of row j. Rows past the last stand for themselves; their springs have no stiffness.
WEFT_INLINE Block first_block(const physics::PlainRows& s, int j) {
  const std::ptrdiff_t here = std::ptrdiff_t(j) * s.stride;
  const std::ptrdiff_t last = std::ptrdiff_t(s.rows - 1) * s.stride;
  const std::ptrdiff_t below = here + s.stride, below2 = below + s.stride;
  return {here,  below < last ? below : last,  below2 < last ? below2 : last, 0,
          j % 2, std::ptrdiff_t(j) * kFamilies};
}

WEFT_INLINE void advance(Block& b) {
  b.here += kLanes;
  b.below += kLanes;
  b.below2 += kLanes;
  b.i += kLanes;
}

// The fused kernel works block by block, row after row. Each of the six springs of a block passes
// four stations: square (edge and squared length), root, quotient (for a spring k l/|e|) and pull.
// Stations of different springs are interleaved, with pull four springs behind square, so that the
// divider always has work and nothing waits for it: the order of the statements is the schedule.
//
// The delays need no reset between rows: past a row's last spring they hold zeros.
template <class Law>
struct Pipeline {
  using Rows = typename Law::Rows;

  Wide3 edge[kFamilies];
  Wide length[kFamilies];  // squared length, then length, then the quotient
  Wide rate[kFamilies];    // edge · its ends' difference in velocity
  Wide3 own, below;        // pull on the block in `pull`, and on the row below it (negated)
  Delay3<1> right, diagonal, antidiagonal;
  Delay3<2> right2;

  template <PlainFamily F>
  WEFT_INLINE void square(const Rows& s, const Block& b) {
    const std::ptrdiff_t near = F == kAntidiagonal ? b.here + 1 : b.here;
    std::ptrdiff_t far = b.below;  // kDown, kAntidiagonal
    if constexpr (F == kRight) far = b.here + 1;
    if constexpr (F == kRight2) far = b.here + 2;
    if constexpr (F == kDiagonal) far = b.below + 1;
    if constexpr (F == kDown2) far = b.below2;
    edge[F] = load3(s.x, far) - load3(s.x, near);
    length[F] = max(dot(edge[F], edge[F]), wide(kTiny));
    pin_order(length[F]);
    if constexpr (Law::kRates) rate[F] = dot(edge[F], load3(s.v, far) - load3(s.v, near));
  }
  template <PlainFamily F>
  WEFT_INLINE void root() {
    length[F] = sqrt(length[F]);
    pin_order(length[F]);
  }
  template <PlainFamily F>
  WEFT_INLINE void quotient(const Rows& s, const Block& b) {
    length[F] = Law::template quotient<F>(s, b, length[F]);
    pin_order(length[F]);
  }
  // Pull of family F on its near end; lanes past the last constraint of the row are zero.
  template <PlainFamily F, bool kLast>
  WEFT_INLINE Wide3 pull(const Rows& s, const Block& b) const {
    Wide3 f = Law::template pull<F>(s, b, edge[F], length[F], rate[F]);
    if constexpr (Law::kTorn) f = select(lanes_at(s.alive[F] + b.here), f, Wide3{});
    if constexpr (!kLast || F == kDown || F == kDown2) return f;
    return select(lanes_below(s.columns - (F == kRight2 ? 2 : 1) - b.i), f, Wide3{});
  }

  template <bool kLast>
  WEFT_INLINE void pull_right(const Rows& s, const Block& b) {
    const Wide3 f = pull<kRight, kLast>(s, b);
    own = f - right.next(f);
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void pull_right2(const Rows& s, const Block& b) {
    const Wide3 f = pull<kRight2, kLast>(s, b);
    own = own + (f - right2.next(f));
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void pull_down(const Rows& s, const Block& b) {
    below = pull<kDown, kLast>(s, b);
    own = own + below;
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void pull_diagonal(const Rows& s, const Block& b) {
    const Wide3 f = pull<kDiagonal, kLast>(s, b);
    own = own + f;
    below = below + diagonal.next(f);
    pin_order(own);
    pin_order(below);
  }
  template <bool kLast>
  WEFT_INLINE void pull_antidiagonal(const Rows& s, const Block& b) {
    const Wide3 f = pull<kAntidiagonal, kLast>(s, b);
    below = below + f;
    own = own + antidiagonal.next(f) - load3(s.carry[0], b.i);
    store3(s.carry[0], b.i, below);
    pin_order(own);
  }
  template <bool kLast>
  WEFT_INLINE void pull_down2(const Rows& s, const Block& b) {
    const Wide3 f = pull<kDown2, kLast>(s, b);
    own = own + (f - load3(s.carry[1 + b.parity], b.i));
    store3(s.carry[1 + b.parity], b.i, f);
    pin_order(own);
  }
};

// Squares block b and gives it its first two pulls, while the block before, a, gets the other four
// and moves. a_last and b_last: the row's last spring to the right lies in or before the block.
template <bool kA, bool kALast, bool kB, bool kBLast, class Law>
WEFT_INLINE void turn(Pipeline<Law>& p, const typename Law::Rows& s, const Block& a,
                      const Block& b) {
  if constexpr (kA) p.template quotient<kDiagonal>(s, a);
  if constexpr (kB) p.template square<kRight>(s, b);
  if constexpr (kA) p.template root<kDown2>();
  if constexpr (kA) p.template pull_down<kALast>(s, a);
  if constexpr (kA) p.template quotient<kAntidiagonal>(s, a);
  if constexpr (kB) p.template square<kRight2>(s, b);
  if constexpr (kB) p.template root<kRight>();
  if constexpr (kA) p.template pull_diagonal<kALast>(s, a);
  if constexpr (kA) p.template quotient<kDown2>(s, a);
  if constexpr (kB) p.template square<kDown>(s, b);
  if constexpr (kB) p.template root<kRight2>();
  if constexpr (kA) p.template pull_antidiagonal<kALast>(s, a);
  if constexpr (kB) p.template quotient<kRight>(s, b);
  if constexpr (kB) p.template square<kDiagonal>(s, b);
  if constexpr (kB) p.template root<kDown>();
  if constexpr (kA) p.template pull_down2<kALast>(s, a);
  if constexpr (kA) Law::finish(s, p.own, a.here);
  if constexpr (kB) p.template quotient<kRight2>(s, b);
  if constexpr (kB) p.template square<kAntidiagonal>(s, b);
  if constexpr (kB) p.template root<kDiagonal>();
  if constexpr (kB) p.template pull_right<kBLast>(s, b);
  if constexpr (kB) p.template quotient<kDown>(s, b);
  if constexpr (kB) p.template square<kDown2>(s, b);
  if constexpr (kB) p.template root<kAntidiagonal>();
  if constexpr (kB) p.template pull_right2<kBLast>(s, b);
}

template <class Law>
WEFT_INLINE void plain_rows(const typename Law::Rows& given) {
  const typename Law::Rows s = given;
  // A block is whole when all its constraints two to the right exist.
  const auto last = [&](const Block& b) { return b.i + kLanes + 2 > s.columns; };
  Pipeline<Law> p{};
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

}  // namespace weft::WEFT_KERNELS
