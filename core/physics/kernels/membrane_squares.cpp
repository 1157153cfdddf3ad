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

template <bool kCoupled>
void one_row(const MembraneSquares& r, int j) {
  const std::ptrdiff_t start = std::ptrdiff_t(j) * r.stride;
  const std::ptrdiff_t next = j + 1 < r.rows ? start + r.stride : start;
  const std::ptrdiff_t last = j > 0 ? start - r.stride : start;
  const auto between = [&](std::ptrdiff_t row, std::ptrdiff_t below) {
    const auto of = [&](ConstRow3 at) { return Cells(at.x + row, at.x + below, at.y - at.x); };
    return r.u.x ? of(r.x) + of(r.u) : of(r.x);
  };
  Delay<1> coupled;
  for (int i = 0; i < r.columns; i += kLanes) {
    const Cells cells = between(start + i, next + i);
    const There there(r, j, i);
    store(r.diagonals + start + i, (squared_length(cells.p) + squared_length(cells.q)) * 0.5f);
    if (r.sheared) put_lanes(r.sheared + start + i, there.sheared);
    if constexpr (kCoupled) {
      const auto beyond = [](Wide3 one, Wide3 other, float rest, WideInt whole) {
        const Wide both = squared_length(one) + squared_length(other);
        return select(whole, fma(both, wide(0.5f), wide(-rest)), Wide{});
      };
      const auto kept = [](Wide3 edge, float rest, float keep) {
        return fma(squared_length(edge) - rest, wide(keep), wide(rest));
      };
      const Cells before = between(last + i, start + i);
      const Wide above = beyond(before.b, before.b_right, r.square_v, There(r, j - 1, i).whole);
      const Wide under = beyond(cells.b, cells.b_right, r.square_v, there.whole);
      const Wide sides = beyond(cells.a, cells.a_below, r.square_u, there.whole);
      const MembraneSquares::Coupling c = r.coupling[j];
      const Wide own_u = kept(cells.a, r.square_u, r.keep_u),
                 own_v = kept(cells.b, r.square_v, r.keep_v);
      store(r.along + start + i, fnma(above, wide(c.before), fnma(under, wide(c.after), own_u)));
      const Wide both = (sides + coupled.next(sides)) * load(r.share + i);
      store(r.across + start + i, fnma(both, wide(c.across), own_v));
    }
  }
}

}  // namespace

void membrane_squares(const MembraneSquares& given) {
  const MembraneSquares r = given;
  for (int j = r.begin; j < r.end; ++j) r.along ? one_row<true>(r, j) : one_row<false>(r, j);
}

}  // namespace weft::WEFT_KERNELS
