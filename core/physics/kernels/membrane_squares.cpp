// What line sweeps hold of a membrane (membrane_line.cpp) is a sum of squares of single lengths. Its energy
// also joins lengths of a cell: the shear both diagonals, the coupling edges along and across. Such a product
// is taken with its partner as it lies before the sweeps, and with what makes up for that:
//
//   (P - Q)²/2 = P² + Q² - (P + Q)²/2,   P = |p|² - d²,  Q = |q|² - d²
//
// The last term is concave, so that its tangent lies above it: sweeps that lower P² + Q² and the tangent lower
// the energy, however stiff it is. With the stiffness of P² + Q² that is a spring on each diagonal towards the
// mean of both squares, which a pure shear leaves as it is. Likewise
//
//   C12 e f = |C12| ((e ± f)² - e² - f²)/2  <=  |C12| (e - e°)²/2 + C12 e f° + …
//
// stiffens both edges by |C12| towards where they lie, and pulls them by what the other strain was.
//
// Damping puts (1 + rate) (e - ρ e_before) in the place of e, ρ = rate/(1 + rate): squares are to be others, by
// stiffnesses that are 1 + rate times as great.
#include "physics/kernels/membrane.h"
#include "physics/kernels/membrane_cells.h"
#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

using physics::MembraneSquares;

namespace {

// The cells between a row and the next, from lane i on, that have both diagonals, and those that have all.
struct There {
  WideInt sheared, whole;
  WEFT_INLINE There(const MembraneSquares& r, int row, int i) {
    sheared = whole = row >= 0 && row + 1 < r.rows ? lanes_below(r.columns - 1 - i) : WideInt{};
    if (!r.alive[0]) return;
    const std::ptrdiff_t lane = std::ptrdiff_t(greatest(row, 0)) * r.stride + i;
    const std::ptrdiff_t below = row + 1 < r.rows ? lane + r.stride : lane;
    const auto alive = [&](int stencil, std::ptrdiff_t at) {
      return lanes_at(r.alive[stencil] + at);
    };
    sheared = sheared & alive(2, lane) & alive(3, lane);
    whole = sheared & alive(0, lane) & alive(0, below) & alive(1, lane) & alive(1, lane + 1);
  }
  WEFT_INLINE static int greatest(int a, int b) { return a > b ? a : b; }
};

// What the edges of a block of cells are beyond their rest lengths, in the mean of two each.
struct Beyond {
  Wide above, under, sides;  // across from the row before and to the next; along
  // Cells between the row before and this, and between this and the next, and which of them are whole.
  WEFT_INLINE Beyond(const MembraneSquares& r, const Cells& before, WideInt whole_before,
                     const Cells& cells, WideInt whole) {
    const auto beyond = [](Wide3 one, Wide3 other, float rest, WideInt there) {
      const Wide both = squared_length(one) + squared_length(other);
      return select(there, fma(both, wide(0.5f), wide(-rest)), Wide{});
    };
    above = beyond(before.b, before.b_right, r.square_v, whole_before);
    under = beyond(cells.b, cells.b_right, r.square_v, whole);
    sides = beyond(cells.a, cells.a_below, r.square_u, whole);
  }
  WEFT_INLINE void take_off(const Beyond& other, float share) {
    above = fnma(wide(share), other.above, above);
    under = fnma(wide(share), other.under, under);
    sides = fnma(wide(share), other.sides, sides);
  }
};

template <bool kEdges, bool kDamped>
void one_row(const MembraneSquares& r, int j) {
  const std::ptrdiff_t start = std::ptrdiff_t(j) * r.stride;
  const std::ptrdiff_t next = j + 1 < r.rows ? start + r.stride : start;
  const std::ptrdiff_t last = j > 0 ? start - r.stride : start;
  const auto of = [](ConstRow3 at, std::ptrdiff_t row, std::ptrdiff_t below) {
    return Cells(at.x + row, at.x + below, at.y - at.x);
  };
  const auto between = [&](std::ptrdiff_t row, std::ptrdiff_t below) {
    return r.u.x ? of(r.x, row, below) + of(r.u, row, below) : of(r.x, row, below);
  };
  const auto before_between = [&](std::ptrdiff_t row, std::ptrdiff_t below) {
    return r.start.previous.x ? of(r.start.previous, row, below)
                              : of(r.x, row, below) + of(r.start.v, row, below) * wide(-r.start.dt);
  };
  Delay<1> coupled;
  for (int i = 0; i < r.columns; i += kLanes) {
    const Cells cells = between(start + i, next + i);
    const There there(r, j, i);
    const Wide mean = (squared_length(cells.p) + squared_length(cells.q)) * 0.5f;
    if (r.sheared) put_lanes(r.sheared + start + i, there.sheared);
    Wide was{};
    if constexpr (kDamped) {
      const Cells at_start = before_between(start + i, next + i);
      was = (squared_length(at_start.p) - squared_length(at_start.q)) * (0.5f * r.rate);
      store(r.antidiagonals + start + i, mean - was);
    }
    store(r.diagonals + start + i, kDamped ? mean + was : mean);
    if constexpr (kEdges) {
      const auto kept = [](Wide3 edge, float rest, float keep) {
        return fma(squared_length(edge) - rest, wide(keep), wide(rest));
      };
      const There there_before(r, j - 1, i);
      Beyond beyond(r, between(last + i, start + i), there_before.whole, cells, there.whole);
      Wide own_u = kept(cells.a, r.square_u, r.keep_u), own_v = kept(cells.b, r.square_v, r.keep_v);
      if constexpr (kDamped) {
        const Cells at_start = before_between(start + i, next + i);
        beyond.take_off(
            {r, before_between(last + i, start + i), there_before.whole, at_start, there.whole},
            r.rate);
        own_u = own_u + (squared_length(at_start.a) - r.square_u) * (r.rate * (1 - r.keep_u));
        own_v = own_v + (squared_length(at_start.b) - r.square_v) * (r.rate * (1 - r.keep_v));
      }
      const MembraneSquares::Coupling c = r.coupling[j];
      store(r.along + start + i,
            fnma(beyond.above, wide(c.before), fnma(beyond.under, wide(c.after), own_u)));
      const Wide both = (beyond.sides + coupled.next(beyond.sides)) * load(r.share + i);
      store(r.across + start + i, fnma(both, wide(c.across), own_v));
    }
  }
}

}  // namespace

void membrane_squares(const MembraneSquares& given) {
  const MembraneSquares r = given;
  for (int j = r.begin; j < r.end; ++j) {
    if (r.rate > 0)
      one_row<true, true>(r, j);
    else if (r.along)
      one_row<true, false>(r, j);
    else
      one_row<false, false>(r, j);
  }
}

}  // namespace weft::WEFT_KERNELS
