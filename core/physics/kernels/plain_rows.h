// The six families of a plain cloth in one pass over the rows: every constraint is evaluated once, in
// the row of its near end, and what it does to the rows below is carried along, so that a row is
// finished, and moved in place, as soon as its own constraints are done.
//
// A `Law` says what a constraint does to its ends and how a finished row moves:
//
//   Law::Rows                                     the kernel's argument, a PlainRows
//   Law::kTorn                                    whether constraints may have died (PlainRows::alive)
//   Law::kWatched                                 whether the law asks for constraints that are too long
//   Law::kRates                                   whether pulls depend on velocities
//   Law::quotient<F>(rows, block, length)         of family F: by the one division it needs
//   Law::pull<F>(rows, block, edge, quotient, edge·velocity)
//                                                 on the near end; the far end gets its negative
//   Law::too_long<F>(rows, block, quotient)       of kWatched laws: which are
//   Law::tell(rows, row)                          that some of a row are, of those that are alive
//   Law::finish(rows, block, sum)                 moves a block by the sum of its pulls
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

// Where a block of lanes lies: its first lane in component x of the positions, of the same column
// one and two rows below, and of what the rows one and two above do to it.
struct Block {
  float* x;
  const float *below, *below2;
  float *carry, *carry2;
  int i;                     // the lane in the row
  std::ptrdiff_t constants;  // number of the row's first family
};

// The first block of row j. Rows past the last stand for themselves; their springs have no stiffness.
WEFT_INLINE Block first_block(const physics::PlainRows& s, int j) {
  float* const x = s.x.x + std::ptrdiff_t(j) * s.stride;
  const float* const last = s.x.x + std::ptrdiff_t(s.rows - 1) * s.stride;
  const bool has_below = j + 1 < s.rows, has_below2 = j + 2 < s.rows;
  return {x,
          has_below ? x + s.stride : last,
          has_below2 ? x + 2 * std::ptrdiff_t(s.stride) : last,
          s.carry[0].x,
          s.carry[1 + j % 2].x,
          0,
          std::ptrdiff_t(j) * kFamilies};
}

template <int N>
WEFT_INLINE Block blocks_on(Block b) {
  constexpr int lanes = N * kLanes;
  return {b.x + lanes,      b.below + lanes, b.below2 + lanes, b.carry + lanes,
          b.carry2 + lanes, b.i + lanes,     b.constants};
}
WEFT_INLINE Block before(const Block& b) {
  return blocks_on<-1>(b);
}
WEFT_INLINE Block after(const Block& b) {
  return blocks_on<1>(b);
}

// The fused kernel works block by block, row after row. Each of the six springs of a block passes
// four stations: square (edge and squared length), root, quotient (for a spring k l/|e|) and pull.
// While one spring is squared, the root of the one before is drawn, and the one before that gets its
// quotient and pulls: so the divider always has work and little waits for it. The order of the
// statements is the schedule.
//
// What goes to the next lane of the block's own row is summed up before it is shifted: hence the order
// of the springs.
//
// The delays need no reset between rows: past a row's last spring they hold zeros.
inline constexpr PlainFamily kOrder[] = {kRight, kAntidiagonal, kDown, kDiagonal, kRight2, kDown2};

template <class Law>
struct Pipeline {
  using Rows = typename Law::Rows;

  std::ptrdiff_t plane, carry_plane;  // floats from one component to the next
  Wide3 edge[kFamilies];
  Wide length[kFamilies];  // squared length, then length, then the quotient
  Wide rate[kFamilies];    // edge · its ends' difference in velocity
  Wide3 own, below;        // pull on the block in `pull`, and on the row below it (negated)
  WideInt overlong;        // lanes of constraints too long in this row
  Delay3<1> to_right, diagonal;
  Delay3<2> right2;

  WEFT_INLINE Wide3 velocity(const Rows& s, const float* x) const {
    return load_planes(s.v.x + (x - s.x.x), plane);
  }

  template <PlainFamily F>
  WEFT_INLINE void square(const Rows& s, const Block& b) {
    const float* const near = F == kAntidiagonal ? b.x + 1 : b.x;
    const float* const far = F == kRight      ? b.x + 1
                             : F == kRight2   ? b.x + 2
                             : F == kDiagonal ? b.below + 1
                             : F == kDown2    ? b.below2
                                              : b.below;
    edge[F] = load_planes(far, plane) - load_planes(near, plane);
    length[F] = max(dot(edge[F], edge[F]), wide(kTiny));
    pin_order(length[F]);
    if constexpr (Law::kRates) rate[F] = dot(edge[F], velocity(s, far) - velocity(s, near));
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
  // What family F does to the block, to its right and below. kLast: lanes past the last constraint
  // of the row are zero.
  template <PlainFamily F, bool kLast>
  WEFT_INLINE void pull(const Rows& s, const Block& b) {
    Wide3 f = Law::template pull<F>(s, b, edge[F], length[F], rate[F]);
    if constexpr (Law::kTorn) {
      const WideInt alive = lanes_at(s.alive[F] + (b.x - s.x.x));
      f = select(alive, f, Wide3{});
      if constexpr (Law::kWatched) overlong |= alive & Law::template too_long<F>(s, b, length[F]);
    }
    if constexpr (kLast && F != kDown && F != kDown2)
      f = select(lanes_below(s.columns - (F == kRight2 ? 2 : 1) - b.i), f, Wide3{});
    if constexpr (F == kRight) {
      own = f;
    } else if constexpr (F == kAntidiagonal) {
      own = own + to_right.next(f - own);
      below = f;
    } else if constexpr (F == kDown) {
      own = own + f;
      below = below + f;
    } else if constexpr (F == kDiagonal) {
      own = own + f - load_planes(b.carry, carry_plane);
      store_planes(b.carry, carry_plane, below + diagonal.next(f));
    } else if constexpr (F == kRight2) {
      own = own + (f - right2.next(f));
    } else {
      own = own + (f - load_planes(b.carry2, carry_plane));
      store_planes(b.carry2, carry_plane, f);
    }
    pin_order(own);
    if constexpr (F == kAntidiagonal || F == kDown) pin_order(below);
  }

  // Squares spring number N of block b while earlier ones, of it or of the block before, go on.
  // A block that has all its pulls moves. kALast, kBLast: the row's last constraint two to the right
  // lies in or before the block.
  template <int N, bool kA, bool kALast, bool kB, bool kBLast>
  WEFT_INLINE void step(const Rows& s, const Block& a, const Block& b) {
    constexpr bool kOfA = N < 2;
    constexpr PlainFamily kPulled = kOrder[(N + 4) % 6];
    if constexpr (kOfA ? kA : kB) quotient<kPulled>(s, kOfA ? a : b);
    if constexpr (kB) square<kOrder[N]>(s, b);
    if constexpr (N < 1 ? kA : kB) root<kOrder[(N + 5) % 6]>();
    if constexpr (kOfA ? kA : kB) pull<kPulled, (kOfA ? kALast : kBLast)>(s, kOfA ? a : b);
    if constexpr (kPulled == kDown2 && kA) {
      Law::finish(s, a, own);
      if constexpr (Law::kWatched && kALast)
        if (any(overlong)) {
          Law::tell(s, a.constants / kFamilies);
          overlong = WideInt{};
        }
    }
  }

  // Squares block b and gives it its first four pulls, while the block before, a, gets the other two
  // and moves.
  template <bool kA, bool kALast, bool kB, bool kBLast>
  WEFT_INLINE void turn(const Rows& s, const Block& a, const Block& b) {
    step<0, kA, kALast, kB, kBLast>(s, a, b);
    step<1, kA, kALast, kB, kBLast>(s, a, b);
    step<2, kA, kALast, kB, kBLast>(s, a, b);
    step<3, kA, kALast, kB, kBLast>(s, a, b);
    step<4, kA, kALast, kB, kBLast>(s, a, b);
    step<5, kA, kALast, kB, kBLast>(s, a, b);
  }
};

template <class Law>
WEFT_INLINE void plain_rows(const typename Law::Rows& given) {
  const typename Law::Rows s = given;
  // A block is whole when all its constraints two to the right exist.
  const auto last = [&](const Block& b) { return b.i + kLanes + 2 > s.columns; };
  Pipeline<Law> p{};
  p.plane = s.x.y - s.x.x;
  p.carry_plane = s.carry[0].y - s.carry[0].x;
  Block b = first_block(s, s.begin);
  if (last(b))
    p.template turn<false, false, true, true>(s, b, b);
  else
    p.template turn<false, false, true, false>(s, b, b);
  for (int j = s.begin;;) {
    for (b = after(b); !last(b); b = after(b))
      p.template turn<true, false, true, false>(s, before(b), b);
    for (; b.i < s.columns; b = after(b)) {
      if (last(before(b)))
        p.template turn<true, true, true, true>(s, before(b), b);
      else
        p.template turn<true, false, true, true>(s, before(b), b);
    }
    const Block a = before(b);
    if (++j == s.end) {
      p.template turn<true, true, false, false>(s, a, a);
      return;
    }
    b = first_block(s, j);
    if (last(b))
      p.template turn<true, true, true, true>(s, a, b);
    else
      p.template turn<true, true, true, false>(s, a, b);
  }
}

}  // namespace weft::WEFT_KERNELS
