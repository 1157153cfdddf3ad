// The six stencils of a plain cloth in one pass over the rows: every constraint is evaluated once, in
// the row of its near end, and what it does to the rows below is carried along, so that a row is
// finished, and moved in place, as soon as its own constraints are done.
//
// A `Law` says what a constraint does to its ends and how a finished row moves:
//
//   Law::Rows                                     the kernel's argument, a PlainRows
//   Law::Constants                                of a row's stencil, as in Rows::constants
//   Law::kTorn                                    whether constraints may have died (PlainRows::alive)
//   Law::kWatched                                 whether the law asks for constraints that are too long
//   Law::kRates                                   whether pulls depend on velocities
//   Law::scale<F>(rows, block, 1/length, edge·velocity)
//                                                 of stencil F: edge times it pulls the near end, and
//                                                 its negative the far end
//   Law::too_long<F>(rows, block, 1/length)       of kWatched laws: which are
//   Law::tell(rows, row)                          that some of a row are, of those that are alive
//   Law::finish(rows, block, sum)                 moves a block by the sum of its pulls; what it does in
//                                                 lanes past the row's last particle must stay finite
#pragma once

#include <cstddef>

#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

enum PlainStencil { kRight, kDown, kDiagonal, kAntidiagonal, kRight2, kDown2, kStencils };
static_assert(kStencils == physics::kPlainStencils);
constexpr bool along_column(PlainStencil f) {
  return f == kDown || f == kDown2;
}

// A block of lanes: its first lane in component x of the positions, and of the same column one and two
// rows below; what earlier rows do to it; the constants of its row's first stencil; and how many columns
// are left from its first lane on.
template <class Law>
struct Block {
  using Rows = typename Law::Rows;
  float* x;
  const float *below, *below2;
  float* carry;
  const typename Law::Constants* constants;
  int left;

  // The first block of row j. Rows past the last stand for themselves; their constraints do nothing.
  WEFT_INLINE static Block first(const Rows& s, int j) {
    float* const x = s.x.x + std::ptrdiff_t(j) * s.stride;
    const float* const last = s.x.x + std::ptrdiff_t(s.rows - 1) * s.stride;
    return {x,
            j + 1 < s.rows ? x + s.stride : last,
            j + 2 < s.rows ? x + 2 * std::ptrdiff_t(s.stride) : last,
            s.carry,
            s.constants + std::ptrdiff_t(j) * kStencils,
            s.columns};
  }
  // Of the columns of rows like these.
  WEFT_INLINE static Wide of_columns(const float* values, const Rows& s, const Block& b) {
    return load(values + (s.columns - b.left));
  }
  // The block to the right.
  WEFT_INLINE Block next() const {
    return {x + kLanes,         below + kLanes, below2 + kLanes,
            carry + 6 * kLanes, constants,      left - kLanes};
  }
  // What the rows before do to the block, and after that what this row and they do to the block below;
  // what the row before does to the block below, and after that this row to the block below that.
  WEFT_INLINE float* sum() const { return carry; }
  WEFT_INLINE float* sum2() const { return carry + 3 * kLanes; }
};

// The fused kernel works block by block, row after row. Each of the six constraints of a block passes
// four stations: its edge is squared, the reciprocal root drawn in two steps, and its ends are pulled.
// While one constraint is squared, those before it are at later stations, so that none waits for
// another's result. The order of the statements is the schedule.
//
// All constraints but the last take their reciprocal roots from the divider, which keeps up with the
// multipliers that far; the last takes it by multiplications (root.h).
//
// What goes to the next lane of the block's own row is summed up before it is shifted: hence the order
// of the stencils.
//
// Lanes past a row's last constraint pull nothing: their scale is zero. So the delays need no reset
// between rows, and one loop goes over the blocks of all rows. Such a zero has a sign, which depends on
// the padding: sums begin with a zero that is positive, and so never show it.
inline constexpr PlainStencil kOrder[] = {kRight, kAntidiagonal, kDown, kDiagonal, kRight2, kDown2};
constexpr bool divided(PlainStencil f) {
  return f != kDown2;
}

// How many constraints after the first station the others lie: as measured.
inline constexpr int kStations[] = {0, kLanes == 16 ? 1 : 2, kLanes == 16 ? 2 : 4,
                                    kLanes == 16 ? 3 : 5};

template <class Law>
struct Pipeline {
  using Rows = typename Law::Rows;
  using Block = WEFT_KERNELS::Block<Law>;

  std::ptrdiff_t plane;  // floats from one component to the next
  Wide3 edge[kStencils];
  Wide length[kStencils];  // squared length, then length, then its reciprocal, of those divided
  ReciprocalRoot root[kStencils];
  Wide rate[kStencils];  // edge · its ends' difference in velocity
  Wide3 own, below;      // pull on the block in `pull`, and on the row below it (negated)
  WideInt overlong;      // lanes of constraints too long in this row
  Delay3<1> to_right, diagonal;
  Delay3<2> right2;

  WEFT_INLINE Wide3 velocity(const Rows& s, const float* x) const {
    return load_planes(s.v.x + (x - s.x.x), plane);
  }

  template <PlainStencil F>
  WEFT_INLINE void square(const Rows& s, const Block& b) {
    const float* const near = F == kAntidiagonal ? b.x + 1 : b.x;
    const float* const far = F == kRight      ? b.x + 1
                             : F == kRight2   ? b.x + 2
                             : F == kDiagonal ? b.below + 1
                             : F == kDown2    ? b.below2
                                              : b.below;
    const Wide3 e = load_planes(far, plane) - load_planes(near, plane);
    edge[F] = e;
    length[F] = squared_length(e);
    if constexpr (Law::kRates) rate[F] = dot(e, velocity(s, far) - velocity(s, near));
  }

  template <PlainStencil F>
  WEFT_INLINE void begin_root() {
    if constexpr (divided(F))
      length[F] = sqrt(length[F]);
    else
      root[F].guess(length[F]);
  }
  template <PlainStencil F>
  WEFT_INLINE void end_root() {
    if constexpr (divided(F))
      length[F] = 1.0f / length[F];
    else
      root[F].refine();
  }
  // What stencil F does to the block, to its right and below.
  template <PlainStencil F>
  WEFT_INLINE void pull(const Rows& s, const Block& b) {
    const Wide3 e = edge[F];
    const Wide reciprocal = divided(F) ? length[F] : root[F].result();
    Wide scale = Law::template scale<F>(s, b, reciprocal, rate[F]);
    constexpr int across = F == kRight2 ? 2 : F == kDown || F == kDown2 ? 0 : 1;
    scale = select(lane_numbers() + across < b.left, scale, Wide{});
    if constexpr (Law::kTorn) {
      const WideInt alive = lanes_at(s.alive[F] + (b.x - s.x.x));
      scale = select(alive, scale, Wide{});
      if constexpr (Law::kWatched) overlong |= alive & Law::template too_long<F>(s, b, reciprocal);
    }
    if constexpr (F == kRight) {
      own = fma(e, scale, Wide3{});
    } else if constexpr (F == kAntidiagonal) {
      own = own + to_right.next(fms(e, scale, own));
      below = fma(e, scale, load_planes(b.sum2(), kLanes));
    } else if constexpr (F == kDown) {
      own = fma(e, scale, own);
      below = fma(e, scale, below);
    } else if constexpr (F == kDiagonal) {
      const Wide3 f = e * scale;
      own = own + f - load_planes(b.sum(), kLanes);
      store_planes(b.sum(), kLanes, below + diagonal.next(f));
    } else if constexpr (F == kRight2) {
      const Wide3 f = e * scale;
      own = own + (f - right2.next(f));
    } else {
      const Wide3 f = e * scale;
      own = own + f;
      store_planes(b.sum2(), kLanes, f);
    }
  }

  // Squares constraint number N of block b while earlier ones, of it or of the block before, go on. A
  // block that has all its pulls moves. kA, kB: whether there is such a block.
  template <int N, bool kA, bool kB>
  WEFT_INLINE void step(const Rows& s, const Block& a, const Block& b) {
    constexpr auto at = [](int station) { return kOrder[(N + 6 - kStations[station]) % 6]; };
    constexpr auto any_at = [](int station) { return N >= kStations[station] ? kB : kA; };
    const Block& pulled = N >= kStations[3] ? b : a;
    if constexpr (kB) square<at(0)>(s, b);
    if constexpr (any_at(1)) begin_root<at(1)>();
    if constexpr (any_at(2)) end_root<at(2)>();
    if constexpr (any_at(3)) pull<at(3)>(s, pulled);
    if constexpr (any_at(3) && at(3) == kDown2) {
      Law::finish(s, pulled, own);
      if constexpr (Law::kWatched)
        if (any(overlong)) {
          Law::tell(s, (pulled.constants - s.constants) / kStencils);
          overlong = WideInt{};
        }
    }
  }

  // Squares block b and gives it its first pulls, while the block before, a, gets its last ones and
  // moves.
  template <bool kA, bool kB>
  WEFT_INLINE void turn(const Rows& s, const Block& a, const Block& b) {
    step<0, kA, kB>(s, a, b);
    step<1, kA, kB>(s, a, b);
    step<2, kA, kB>(s, a, b);
    step<3, kA, kB>(s, a, b);
    step<4, kA, kB>(s, a, b);
    step<5, kA, kB>(s, a, b);
  }
};

template <class Law>
WEFT_INLINE void plain_rows(const typename Law::Rows& given) {
  const typename Law::Rows s = given;
  Pipeline<Law> p{};
  p.plane = s.x.y - s.x.x;
  auto b = Block<Law>::first(s, s.begin);
  p.template turn<false, true>(s, b, b);
  for (int j = s.begin;;) {
    const auto a = b;
    b = b.next();
    if (b.left <= 0) {
      if (++j == s.end) return p.template turn<true, false>(s, a, a);
      b = Block<Law>::first(s, j);
    }
    p.template turn<true, true>(s, a, b);
  }
}

}  // namespace weft::WEFT_KERNELS
