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
//   Law::scale<F>(rows, block, 1/length, edge·velocity)
//                                                 of family F: edge times it pulls the near end, and
//                                                 its negative the far end
//   Law::too_long<F>(rows, block, 1/length)       of kWatched laws: which are
//   Law::tell(rows, row)                          that some of a row are, of those that are alive
//   Law::finish<kLast>(rows, block, sum)          moves a block by the sum of its pulls; kLast: lanes
//                                                 past the row's last particle may be among it
#pragma once

#include <cstddef>

#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

enum PlainFamily { kRight, kDown, kDiagonal, kAntidiagonal, kRight2, kDown2, kFamilies };
static_assert(kFamilies == physics::kPlainFamilies);

// Where a block of lanes lies: its first lane in component x of the positions, of the same column
// one and two rows below, and of what earlier rows do to it and to the row below (carry2_below: what the
// row above does to that).
struct Block {
  float* x;
  const float *below, *below2;
  float *carry, *carry2;
  const float* carry2_below;
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
          s.carry[2 - j % 2].x,
          0,
          std::ptrdiff_t(j) * kFamilies};
}

template <int N>
WEFT_INLINE Block blocks_on(Block b) {
  constexpr int lanes = N * kLanes;
  return {b.x + lanes,      b.below + lanes,        b.below2 + lanes, b.carry + lanes,
          b.carry2 + lanes, b.carry2_below + lanes, b.i + lanes,      b.constants};
}
WEFT_INLINE Block before(const Block& b) {
  return blocks_on<-1>(b);
}
WEFT_INLINE Block after(const Block& b) {
  return blocks_on<1>(b);
}

// The fused kernel works block by block, row after row. Each of the six constraints of a block passes
// four stations: its edge is squared, the reciprocal root drawn in two steps, and its ends are pulled.
// While one constraint is squared, those before it are at later stations, so that none waits for
// another's result. The order of the statements is the schedule.
//
// Every other constraint takes its reciprocal root from the divider, the others by multiplications
// (root.h): so both work at the same time.
//
// What goes to the next lane of the block's own row is summed up before it is shifted: hence the order
// of the families.
//
// The delays need no reset between rows: past a row's last constraint they hold zeros.
inline constexpr PlainFamily kOrder[] = {kRight, kAntidiagonal, kDown, kDiagonal, kRight2, kDown2};
constexpr bool divided(PlainFamily f) {
  return f == kRight || f == kDown || f == kRight2;
}

// How many constraints after the first station the others lie: as far as registers last.
inline constexpr int kStations[] = {0, 1, kLanes == 16 ? 3 : 2, kLanes == 16 ? 4 : 2};

template <class Law>
struct Pipeline {
  using Rows = typename Law::Rows;

  std::ptrdiff_t plane, carry_plane;  // floats from one component to the next
  Wide3 edge[kFamilies];
  Wide length[kFamilies];  // squared length, then length, then its reciprocal, of those divided
  ReciprocalRoot root[kFamilies];
  Wide rate[kFamilies];  // edge · its ends' difference in velocity
  Wide3 own, below;      // pull on the block in `pull`, and on the row below it (negated)
  WideInt overlong;      // lanes of constraints too long in this row
  Delay3<1> to_right, diagonal;
  Delay3<2> right2;

  WEFT_INLINE Wide3 velocity(const Rows& s, const float* x) const {
    return load_planes(s.v.x + (x - s.x.x), plane);
  }

  // The lanes of constraints.
  template <PlainFamily F>
  WEFT_INLINE static WideInt existing(const Rows& s, const Block& b) {
    return lanes_below(s.columns - (F == kRight2 ? 2 : F == kDown || F == kDown2 ? 0 : 1) - b.i);
  }

  // kLast: past the last constraint of the row, edges and pulls are zero.
  template <PlainFamily F, bool kLast>
  WEFT_INLINE void square(const Rows& s, const Block& b) {
    const float* const near = F == kAntidiagonal ? b.x + 1 : b.x;
    const float* const far = F == kRight      ? b.x + 1
                             : F == kRight2   ? b.x + 2
                             : F == kDiagonal ? b.below + 1
                             : F == kDown2    ? b.below2
                                              : b.below;
    Wide3 e = load_planes(far, plane) - load_planes(near, plane);
    if constexpr (kLast) e = select(existing<F>(s, b), e, Wide3{});
    edge[F] = e;
    length[F] = squared_length(e);
    if constexpr (Law::kRates) rate[F] = dot(e, velocity(s, far) - velocity(s, near));
  }

  template <PlainFamily F>
  WEFT_INLINE void begin_root() {
    if constexpr (divided(F))
      length[F] = sqrt(length[F]);
    else
      root[F].guess(length[F]);
  }
  template <PlainFamily F>
  WEFT_INLINE void end_root() {
    if constexpr (divided(F))
      length[F] = 1.0f / length[F];
    else
      root[F].refine();
  }
  // What family F does to the block, to its right and below.
  template <PlainFamily F, bool kLast>
  WEFT_INLINE void pull(const Rows& s, const Block& b) {
    const Wide3 e = edge[F];
    const Wide reciprocal = divided(F) ? length[F] : root[F].result();
    Wide scale = Law::template scale<F>(s, b, reciprocal, rate[F]);
    if constexpr (kLast) scale = select(existing<F>(s, b), scale, Wide{});
    if constexpr (Law::kTorn) {
      const WideInt alive = lanes_at(s.alive[F] + (b.x - s.x.x));
      scale = select(alive, scale, Wide{});
      if constexpr (Law::kWatched) overlong |= alive & Law::template too_long<F>(s, b, reciprocal);
    }
    if constexpr (F == kRight) {
      own = e * scale;
    } else if constexpr (F == kAntidiagonal) {
      own = own + to_right.next(fms(e, scale, own));
      below = fma(e, scale, load_planes(b.carry2_below, carry_plane));
    } else if constexpr (F == kDown) {
      own = fma(e, scale, own);
      below = fma(e, scale, below);
    } else if constexpr (F == kDiagonal) {
      const Wide3 f = e * scale;
      own = own + f - load_planes(b.carry, carry_plane);
      store_planes(b.carry, carry_plane, below + diagonal.next(f));
    } else if constexpr (F == kRight2) {
      const Wide3 f = e * scale;
      own = own + (f - right2.next(f));
    } else {
      const Wide3 f = e * scale;
      own = own + f;
      store_planes(b.carry2, carry_plane, f);
    }
  }

  // Squares constraint number N of block b while earlier ones, of it or of the block before, go on. A
  // block that has all its pulls moves. kALast, kBLast: the row's last constraint two to the right lies
  // in or before the block.
  template <int N, bool kA, bool kALast, bool kB, bool kBLast>
  WEFT_INLINE void step(const Rows& s, const Block& a, const Block& b) {
    constexpr auto at = [](int station) { return kOrder[(N + 6 - kStations[station]) % 6]; };
    constexpr auto any_at = [](int station) { return N >= kStations[station] ? kB : kA; };
    constexpr bool kOfB = N >= kStations[3], kThatLast = kOfB ? kBLast : kALast;
    if constexpr (kB) square<at(0), kBLast>(s, b);
    if constexpr (any_at(1)) begin_root<at(1)>();
    if constexpr (any_at(2)) end_root<at(2)>();
    if constexpr (any_at(3)) pull<at(3), kThatLast>(s, kOfB ? b : a);
    if constexpr (any_at(3) && at(3) == kDown2) {
      Law::template finish<kThatLast>(s, kOfB ? b : a, own);
      if constexpr (Law::kWatched && kThatLast)
        if (any(overlong)) {
          Law::tell(s, (kOfB ? b : a).constants / kFamilies);
          overlong = WideInt{};
        }
    }
  }

  // Squares block b and gives it its first pulls, while the block before, a, gets its last ones and
  // moves.
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
