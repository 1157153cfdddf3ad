// Gauss–Seidel over the cells of a grid's membrane (membrane.cpp). Each strain of a cell is a constraint of its own:
// those of its edges, its angle γ, and where warp and weft are coupled the sum and the differences that are left when
// the coupling is told by squares, with a² = √(C11/C22) and the sign of C12:
//
//   C12 mean(e11) mean(e22) = ½ |C12| [(a mean(e11) ± mean(e22)/a)² + a² d1² + d2²/a²
//                                      - a² mean(e11²) - mean(e22²)/a²]
//
// d1, d2: half of what e11, e22 of a cell's two edges differ by. So edges have the stiffness C11 - a² |C12| and
// C22 - |C12|/a², which is positive wherever the energy is. Multipliers are stresses s:
//
//   r = e + s/k,  Δs = r/(A + 1/k),  s <- s - Δs
//   A = h² area Σ w_n |∂e/∂x_n|²,   x_n <- x_n - h² area w_n ∂e/∂x_n Δs
//
// (Macklin, Müller, Chentanez 2016). Taken together, three strains of the mean of a cell's edges and their two
// differences leave a sweep with complex eigenvalues, and substeps of the second order gain energy.
//
// Damping is a sweep of its own before these, over how strains grow by the way that particles are about to go:
//
//   r = rate (e - e_before) + s/k,  Δs = r/(rate A + 1/k),  s <- s - Δs
//
// Within the others it would ask them to hold strains where they were. In long substeps a single sweep cannot, and
// neither stretches what falls as it should nor takes back what is stretched.
//
// Rows and columns have two colours each. The cells of one colour fill every second lane: those of two rows, j and
// j+2, are parted from each other's neighbours, solved without a lane idle, and woven together again.
#include <tuple>
#include <utility>

#include "physics/kernels/membrane.h"
#include "physics/kernels/parting.h"
#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::MembraneSweep;

// Where blocks of cells lie: so many floats from row 0 to the first cell of row j, and on to that of row j+2; 0: there
// is no such row. Lane by lane, near and far ends are neighbours.
struct Place {
  std::ptrdiff_t at, on;
  WEFT_INLINE std::ptrdiff_t second() const { return at + (kLanes == 1 ? 1 : on); }
  // Of one array: what lies at the cells' first columns and at their second ones.
  WEFT_INLINE Parting<1> load_from(const float* from) const {
    return {load(from + at), load(from + second())};
  }
  WEFT_INLINE void add_to(float* to, Wide near, Wide far) const {
    Parting<1> ends;
    ends.near = near;
    ends.far = far;
    store(to + at, load(to + at) + ends.first());
    store(to + second(), load(to + second()) + ends.second());
  }
  // One value for each cell, in the lane of its first column.
  WEFT_INLINE void store_to(float* to, Wide value) const {
    Parting<1> all = load_from(to);
    all.near = value;
    store(to + at, all.first());
    if (kLanes > 1 && on > 0) store(to + second(), all.second());
  }
  WEFT_INLINE Place below(int stride) const { return {at + stride, on}; }
};

// Corners 0 (i, j), 1 (i+1, j), 2 (i, j+1), 3 (i+1, j+1).
struct Corners {
  Wide3 of[4];
};

// Constraints that are there, in the lanes of cells.
struct There {
  WideInt along[2], across[2], diagonal[2];
};

// kDamps: the sweep of damping.
template <bool kMultipliers, bool kDamps, bool kTorn>
class CellBlock {
 public:
  // `row`, `second_row`: of which the cells are, in the first half of the lanes and in the others.
  WEFT_INLINE CellBlock(const MembraneSweep& p, Place place, int row, int second_row,
                        WideInt active)
      : p_(p), place_(place), row_(row), second_row_(second_row), active_(active) {
    const float second = p.scale[kLanes == 1 ? row : second_row];
    scale_ = select(lanes_below((kLanes + 1) / 2), wide(p.scale[row]), wide(second));
    inertia_ = kDamps ? scale_ * p.rate : scale_;
    load_row(place, 0);
    load_row(place.below(p.stride), 2);
    if constexpr (kTorn) find_links();
  }

  WEFT_INLINE void solve() {
    const Corners before = x_;
    solve_edges<false>();
    solve_edges<true>();
    solve_shear();
    if (p_.sum[0] != 0) {
      solve_sum();
      solve_difference<false>();
      solve_difference<true>();
    }
    if constexpr (kTorn && !kDamps)
      if (p_.longest_square[0] > 0) end_overlong(before);
    const auto add = [&](Place at, int k) {
      const Wide3 near = moved_.of[k], far = moved_.of[k + 1];
      at.add_to(p_.u.x, near.x, far.x);
      at.add_to(p_.u.y, near.y, far.y);
      at.add_to(p_.u.z, near.z, far.z);
    };
    add(place_, 0);
    add(place_.below(p_.stride), 2);
  }

 private:
  enum Slot { kEdges = 0, kShear = 4, kSum = 5, kDifferences = 6 };  // of multipliers

  WEFT_INLINE void load_row(Place at, int k) {
    const auto part = [&](auto value) {
      const Parting<1> x(value(0, at.at), value(0, at.second()));
      const Parting<1> y(value(1, at.at), value(1, at.second()));
      const Parting<1> z(value(2, at.at), value(2, at.second()));
      return std::pair(Wide3{x.near, y.near, z.near}, Wide3{x.far, y.far, z.far});
    };
    const ConstRow3 previous = p_.start.previous, v = p_.start.v;
    const std::ptrdiff_t plane = p_.x.y - p_.x.x, before = previous.y - previous.x;
    std::tie(x_.of[k], x_.of[k + 1]) = part([&](int c, std::ptrdiff_t i) {
      return load(p_.x.x + c * plane + i) + load(p_.u.x + c * plane + i);
    });
    if constexpr (kDamps)
      std::tie(way_.of[k], way_.of[k + 1]) = part([&](int c, std::ptrdiff_t i) {
        const Wide predicted =
            previous.x ? load(p_.x.x + c * plane + i) - load(previous.x + c * before + i)
                       : load(v.x + c * plane + i) * p_.start.dt;
        return predicted + load(p_.u.x + c * plane + i);
      });
    const Parting<1> w = at.load_from(p_.w);
    w_[k] = w.near;
    w_[k + 1] = w.far;
  }

  // The corners of edge n along or across: of the row and the next, or at the left and the right.
  template <bool kAcross>
  static constexpr int from(int n) {
    return kAcross ? n : 2 * n;
  }
  template <bool kAcross>
  static constexpr int to(int n) {
    return kAcross ? n + 2 : 2 * n + 1;
  }
  // Of its rest length.
  template <bool kAcross>
  WEFT_INLINE Wide3 edge(const Corners& x, int n) const {
    return (x.of[to<kAcross>(n)] - x.of[from<kAcross>(n)]) * wide(kAcross ? p_.per_v : p_.per_u);
  }
  // The strain of an edge, or how much of it damping counts: the rate times what it has grown by.
  template <bool kAcross>
  WEFT_INLINE Wide strain(Wide3 e, Wide square, int n) const {
    if constexpr (!kDamps) return 0.5f * (square - 1.0f);
    const Wide3 by = edge<kAcross>(way_, n);
    return p_.rate * dot(e - by * wide(0.5f), by);
  }
  // Δs; what is pressed together has small derivatives, and takes a step as if it were not.
  WEFT_INLINE Wide step(Wide r, Wide a, Wide at_rest, Wide give, WideInt which, int slot) const {
    Wide held{};
    if constexpr (kMultipliers) {
      held = place_.load_from(stress(slot)).near;
      r = r + give * held;
    }
    const Wide by = select(which, r / (inertia_ * max(a, at_rest) + give), Wide{});
    if constexpr (kMultipliers) place_.store_to(stress(slot), held - by);
    return by;
  }

  // Both edges along or across, each by itself.
  template <bool kAcross>
  WEFT_INLINE void solve_edges() {
    const float per = kAcross ? p_.per_v : p_.per_u;
    Wide give = wide(p_.give_edge[kAcross]);
    if constexpr (kTorn) give = select(whole_, give, wide(p_.give_torn[kAcross]));
    for (int n = 0; n < 2; ++n) {
      const Wide3 e = edge<kAcross>(x_, n);
      const Wide square = squared_length(e);
      const Wide weight = (w_[from<kAcross>(n)] + w_[to<kAcross>(n)]) * (per * per);
      const WideInt which = kTorn ? kAcross ? there_.across[n] : there_.along[n] : active_;
      const Wide by = step(strain<kAcross>(e, square, n), weight * square, weight, give, which,
                           kEdges + 2 * kAcross + n);
      const Wide3 pull = e * (scale_ * per * by);
      move(from<kAcross>(n), pull);
      move(to<kAcross>(n), Wide3{} - pull);
    }
  }

  // Half of what the strains of both edges differ by.
  template <bool kAcross>
  WEFT_INLINE void solve_difference() {
    const float per = 0.5f * (kAcross ? p_.per_v : p_.per_u);
    Wide3 e[2];
    Wide half[2], a{}, at_rest{};
    for (int n = 0; n < 2; ++n) {
      e[n] = edge<kAcross>(x_, n);
      const Wide square = squared_length(e[n]);
      half[n] = 0.5f * strain<kAcross>(e[n], square, n);
      const Wide weight = (w_[from<kAcross>(n)] + w_[to<kAcross>(n)]) * (per * per);
      a = a + weight * square;
      at_rest = at_rest + weight;
    }
    const Wide by = step(half[0] - half[1], a, at_rest, wide(p_.give_difference[kAcross]),
                         kTorn ? whole_ : active_, kDifferences + kAcross);
    const Wide scale = scale_ * per * by;
    for (int n = 0; n < 2; ++n) {
      const Wide3 pull = e[n] * (n == 0 ? scale : -scale);
      move(from<kAcross>(n), pull);
      move(to<kAcross>(n), Wide3{} - pull);
    }
  }

  // The sum of strains along and across, p_.sum times each.
  WEFT_INLINE void solve_sum() {
    Wide r{};
    Wide3 pull[4] = {};
    for (int n = 0; n < 2; ++n) {
      const Wide3 along = edge<false>(x_, n), across = edge<true>(x_, n);
      r = r + p_.sum[0] * strain<false>(along, squared_length(along), n) +
          p_.sum[1] * strain<true>(across, squared_length(across), n);
      const Wide3 u = along * wide(p_.sum[0] * p_.per_u), v = across * wide(p_.sum[1] * p_.per_v);
      pull[from<false>(n)] = pull[from<false>(n)] + u;
      pull[to<false>(n)] = pull[to<false>(n)] - u;
      pull[from<true>(n)] = pull[from<true>(n)] + v;
      pull[to<true>(n)] = pull[to<true>(n)] - v;
    }
    const float u = p_.sum[0] * p_.per_u, v = p_.sum[1] * p_.per_v;
    const Wide at_rest = ((w_[0] + w_[1]) + (w_[2] + w_[3])) * (u * u + v * v);
    solve_all(r, pull, at_rest, wide(p_.give_sum), kTorn ? whole_ : active_, kSum);
  }

  WEFT_INLINE void solve_shear() {
    const auto sums = [&](const Corners& x) {
      return std::pair(edge<false>(x, 0) + edge<false>(x, 1), edge<true>(x, 0) + edge<true>(x, 1));
    };
    const auto [u, v] = sums(x_);
    Wide r = dot(u, v) * 0.25f;
    if constexpr (kDamps) {
      const auto [du, dv] = sums(way_);
      r = p_.rate * (dot(u, dv) + dot(v, du) - dot(du, dv)) * 0.25f;
    }
    const Wide3 su = u * wide(0.25f * p_.per_v), sv = v * wide(0.25f * p_.per_u);
    const Wide3 one = su + sv, other = su - sv;
    const Wide3 pull[4] = {one, other, Wide3{} - other, Wide3{} - one};
    const Wide at_rest =
        ((w_[0] + w_[1]) + (w_[2] + w_[3])) * (0.25f * (p_.per_u * p_.per_u + p_.per_v * p_.per_v));
    const WideInt which = kTorn ? there_.diagonal[0] & there_.diagonal[1] : active_;
    solve_all(r, pull, at_rest, wide(p_.give_shear), which, kShear);
  }

  // A strain that all corners change by `pull`, taken off.
  WEFT_INLINE void solve_all(Wide r, const Wide3 (&pull)[4], Wide at_rest, Wide give, WideInt which,
                             Slot slot) {
    Wide a{};
    for (int k = 0; k < 4; ++k) a = a + w_[k] * squared_length(pull[k]);
    const Wide by = scale_ * step(r, a, at_rest, give, which, slot);
    for (int k = 0; k < 4; ++k) move(k, pull[k] * by);
  }

  WEFT_INLINE void move(int corner, Wide3 by) {
    by = by * w_[corner];
    x_.of[corner] = x_.of[corner] + by;
    moved_.of[corner] = moved_.of[corner] + by;
    if constexpr (kDamps) way_.of[corner] = way_.of[corner] + by;
  }

  WEFT_INLINE float* stress(int n) const { return p_.stress + n * p_.stress_plane; }

  // Which constraints of the cells are left; of stencils right, down, diagonal, antidiagonal.
  WEFT_INLINE void find_links() {
    const auto alive = [&](int stencil, Place at) {
      return at.load_from(reinterpret_cast<const float*>(p_.alive[stencil]));
    };
    const auto lanes = [&](Wide v) { return active_ & (WideInt)v; };
    const Parting<1> sides = alive(1, place_);
    there_ = {{lanes(alive(0, place_).near), lanes(alive(0, place_.below(p_.stride)).near)},
              {lanes(sides.near), lanes(sides.far)},
              {lanes(alive(2, place_).near), lanes(alive(3, place_).near)}};
    whole_ = there_.along[0] & there_.along[1] & there_.across[0] & there_.across[1] &
             there_.diagonal[0] & there_.diagonal[1];
  }

  // Ends constraints past their tear length, each as long as in the mean of before and after the cell's correction
  // (gauss_seidel.cpp).
  WEFT_INLINE void end_overlong(const Corners& before) {
    Wide3 midst[4];
    for (int k = 0; k < 4; ++k) midst[k] = (before.of[k] + x_.of[k]) * wide(0.5f);
    const auto over = [&](int stencil, WideInt there, int from, int to) {
      return there & (squared_length(midst[to] - midst[from]) > wide(p_.longest_square[stencil]));
    };
    const auto end = [&](int stencil, Place at, int below, WideInt near, WideInt far) {
      if (!any(near | far)) return;
      Parting<1> ends;
      ends.near = (Wide)near;
      ends.far = (Wide)far;
      std::int32_t* const alive = p_.alive[stencil];
      put_lanes(alive + at.at, lanes_at(alive + at.at) & ~(WideInt)ends.first());
      put_lanes(alive + at.second(), lanes_at(alive + at.second()) & ~(WideInt)ends.second());
      const WideInt first_row = lanes_below((kLanes + 1) / 2);
      const auto count = [&](WideInt rows) {
        return __builtin_popcount(bits(near & rows)) + __builtin_popcount(bits(far & rows));
      };
      p_.ended[row_ + below] += count(first_row);
      if (place_.on > 0) p_.ended[second_row_ + below] += count(~first_row);
    };
    const Place below = place_.below(p_.stride);
    end(0, place_, 0, over(0, there_.along[0], 0, 1), WideInt{});
    end(0, below, 1, over(0, there_.along[1], 2, 3), WideInt{});
    end(1, place_, 0, over(1, there_.across[0], 0, 2), over(1, there_.across[1], 1, 3));
    end(2, place_, 0, over(2, there_.diagonal[0], 0, 3), WideInt{});
    end(3, place_, 0, over(3, there_.diagonal[1], 1, 2), WideInt{});
  }

  const MembraneSweep& p_;
  const Place place_;
  const int row_, second_row_;
  const WideInt active_;
  Wide scale_, inertia_, w_[4];  // what stresses move, and what they change the residual by
  Corners x_, way_;              // where corners are, and how far they have gone in this substep
  Corners moved_{};
  There there_;
  WideInt whole_;
};

// The cells below row j, and below row j+2 if that is asked for.
template <bool kMultipliers, bool kDamps, bool kTorn>
WEFT_INLINE void solve_rows(const MembraneSweep& p, int j, bool two) {
  constexpr int kCells = kLanes == 1 ? 1 : kLanes / 2;  // of a row in a block
  const std::ptrdiff_t row = std::ptrdiff_t(j) * p.stride;
  const WideInt number = lane_numbers();
  const WideInt first_row = lanes_below(kCells);
  const WideInt rows = two || kLanes == 1 ? ~WideInt{} : first_row;
  const WideInt column = Parting<1>::place(select(first_row, number, number - kCells));
  for (int colour = 0; colour < 2; ++colour)
    for (int i = colour; i + 1 < p.columns; i += 2 * kCells)
      CellBlock<kMultipliers, kDamps, kTorn>(p, {row + i, two ? 2 * std::ptrdiff_t(p.stride) : 0},
                                             j, two ? j + 2 : j,
                                             rows & (column < p.columns - 1 - i))
          .solve();
}

template <bool kMultipliers, bool kDamps, bool kTorn>
void sweep(const MembraneSweep& given) {
  const MembraneSweep p = given;  // a copy that no store can alias
  const int last = (p.end < p.rows - 1 ? p.end : p.rows - 1) - 1;
  for (int j = p.begin + (p.begin % 2 != p.colour); j <= last;) {
    const bool two = kLanes > 1 && j + 2 <= last;
    solve_rows<kMultipliers, kDamps, kTorn>(p, j, two);
    j += two ? 4 : 2;
  }
}

template <bool kMultipliers, bool kDamps>
void sweep_what_is_left(const MembraneSweep& p) {
  p.alive[0] ? sweep<kMultipliers, kDamps, true>(p) : sweep<kMultipliers, kDamps, false>(p);
}

}  // namespace

void sweep_membrane(const MembraneSweep& p) {
  if (p.rate > 0)
    return p.stress ? sweep_what_is_left<true, true>(p) : sweep_what_is_left<false, true>(p);
  p.stress ? sweep_what_is_left<true, false>(p) : sweep_what_is_left<false, false>(p);
}

}  // namespace weft::WEFT_KERNELS
