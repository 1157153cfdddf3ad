// Gauss–Seidel over the cells of a grid's membrane (membrane.cpp). A cell is one constraint of the three rows that
// its strains have in the mean of its edges, with the stiffness C of the material, and two more of one row each, by
// which its edges differ:
//
//   E = ½ h_u h_v (e·C e + C11 d1² + C22 d2²)
//   e = (mean(e11), mean(e22), γ),  d1, d2: half of what e11, e22 of a cell's two edges differ by
//
// which is the same energy, told otherwise. Multipliers are stresses s, as those of triangles (mesh_strains.cpp):
//
//   r = e + rate (e - e_before) + C⁻¹ s,  Δs = ((1 + rate) A + C⁻¹)⁻¹ r,  s <- s - Δs
//   A = h² area Σ w_k ∂e/∂x_k ∂e/∂x_kᵀ,   x_k <- x_k - h² area w_k ∂e/∂x_kᵀ Δs
//
// (Macklin, Müller, Chentanez 2016). Where edges are torn nothing couples those that are left, and each is a row of
// its own, with half of its material's stiffness.
//
// Rows and columns have two colours each. The cells of one colour fill every second lane: those of two rows, j and
// j+2, are parted from each other's neighbours, solved without a lane idle, and woven together again.
#include <tuple>
#include <utility>

#include "physics/kernels/membrane.h"
#include "physics/kernels/parting.h"
#include "physics/kernels/root.h"
#include "physics/kernels/strain_block.h"

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

// Edges along the row and the next, across at the left and the right; of their rest lengths.
struct Edges {
  Wide3 along[2], across[2];
  WEFT_INLINE Edges(const Corners& x, float u, float v)
      : along{(x.of[1] - x.of[0]) * wide(u), (x.of[3] - x.of[2]) * wide(u)},
        across{(x.of[2] - x.of[0]) * wide(v), (x.of[3] - x.of[1]) * wide(v)} {}
  WEFT_INLINE Wide3 twice_along() const { return along[0] + along[1]; }
  WEFT_INLINE Wide3 twice_across() const { return across[0] + across[1]; }
};

WEFT_INLINE Wide half_sum_of_squares(const Wide3 (&e)[2]) {
  return (squared_length(e[0]) + squared_length(e[1])) * 0.5f;
}

// Constraints that are there, in the lanes of cells.
struct There {
  WideInt along[2], across[2], diagonal[2];
};

template <bool kMultipliers, bool kDamped, bool kTorn>
class CellBlock {
 public:
  // `row`, `second_row`: of which the cells are, in the first half of the lanes and in the others.
  WEFT_INLINE CellBlock(const MembraneSweep& p, Place place, int row, int second_row,
                        WideInt active)
      : p_(p), place_(place), row_(row), second_row_(second_row), active_(active) {
    const float second = p.scale[kLanes == 1 ? row : second_row];
    scale_ = select(lanes_below((kLanes + 1) / 2), wide(p.scale[row]), wide(second));
    load_row(place, 0);
    load_row(place.below(p.stride), 2);
    if constexpr (kTorn) find_links();
  }

  WEFT_INLINE void solve() {
    const Corners before = x_;
    const WideInt whole = kTorn ? whole_ : active_;
    solve_means(whole);
    const Wide half = wide(0.5f);
    if constexpr (!kTorn) {
      solve_edges<false>(half, -half, whole, wide(1), 3);
      solve_edges<true>(half, -half, whole, wide(1), 4);
    } else {
      // The edge that comes first, alone, where the cell is not whole.
      const Wide first = select(whole, half, wide(1)), second = select(whole, -half, Wide{});
      const Wide softer = select(whole, wide(1), wide(2));
      const WideInt torn = active_ & ~whole;
      solve_edges<false>(first, second, whole | (torn & there_.along[0]), softer, 3);
      solve_edges<true>(first, second, whole | (torn & there_.across[0]), softer, 4);
      if (any(torn)) {
        solve_edges<false>(Wide{}, wide(1), torn & there_.along[1], softer, 0);
        solve_edges<true>(Wide{}, wide(1), torn & there_.across[1], softer, 1);
        solve_shear(torn & there_.diagonal[0] & there_.diagonal[1]);
      }
      if (p_.longest_square[0] > 0) end_overlong(before);
    }
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
  static constexpr int kShear = 3;  // of p_.give

  WEFT_INLINE void load_row(Place at, int k) {
    const auto part = [&](auto value) {
      const Parting<1> x(value(0, at.at), value(0, at.second()));
      const Parting<1> y(value(1, at.at), value(1, at.second()));
      const Parting<1> z(value(2, at.at), value(2, at.second()));
      return std::pair(Wide3{x.near, y.near, z.near}, Wide3{x.far, y.far, z.far});
    };
    const std::ptrdiff_t plane = p_.x.y - p_.x.x, previous = p_.previous.y - p_.previous.x;
    std::tie(x_.of[k], x_.of[k + 1]) = part([&](int c, std::ptrdiff_t i) {
      return load(p_.x.x + c * plane + i) + load(p_.u.x + c * plane + i);
    });
    if constexpr (kDamped)
      std::tie(way_.of[k], way_.of[k + 1]) = part([&](int c, std::ptrdiff_t i) {
        const Wide predicted =
            p_.previous.x ? load(p_.x.x + c * plane + i) - load(p_.previous.x + c * previous + i)
                          : load(p_.v.x + c * plane + i) * p_.dt;
        return predicted + load(p_.u.x + c * plane + i);
      });
    const Parting<1> w = at.load_from(p_.w);
    w_[k] = w.near;
    w_[k + 1] = w.far;
  }

  // The three rows of the mean strains.
  WEFT_INLINE void solve_means(WideInt which) {
    const Edges e(x_, p_.per_u, p_.per_v);
    const Wide3 u = e.twice_along(), v = e.twice_across();
    const Two metric{half_sum_of_squares(e.along), half_sum_of_squares(e.across),
                     dot(u, v) * 0.25f};
    Three r = strains(metric);
    if constexpr (kDamped) {
      const Edges by(way_, p_.per_u, p_.per_v);
      const Wide3 du = by.twice_along(), dv = by.twice_across();
      const Wide gained[3] = {
          (gain(e.along[0], by.along[0]) + gain(e.along[1], by.along[1])) * 0.5f,
          (gain(e.across[0], by.across[0]) + gain(e.across[1], by.across[1])) * 0.5f,
          (dot(u, dv) + dot(v, du) - dot(du, dv)) * 0.25f};
      for (int n = 0; n < 3; ++n) r.of[n] = r.of[n] + p_.rate * gained[n];
    }
    Three held{};
    if constexpr (kMultipliers) {
      for (int n = 0; n < 3; ++n) held.of[n] = place_.load_from(stress(n)).near;
      add_give(p_.give, held, r);
    }
    for (Wide& left : r.of) left = select(which, left, Wide{});
    const Wide scale = scale_ * (0.25f * (1 + p_.rate));
    const Wide all = scale * ((w_[0] + w_[3]) + (w_[1] + w_[2]));
    const Wide mixed = scale * ((w_[0] + w_[3]) - (w_[1] + w_[2]));
    const Two g{all * (p_.per_u * p_.per_u), all * (p_.per_v * p_.per_v),
                mixed * (p_.per_u * p_.per_v)};
    const Three by = stress_step(metric, g, p_.give, r);
    if constexpr (kMultipliers)
      for (int n = 0; n < 3; ++n) place_.store_to(stress(n), held.of[n] - by.of[n]);
    const Wide warp = scale_ * (0.5f * p_.per_u) * by.of[0];
    const Wide weft = scale_ * (0.5f * p_.per_v) * by.of[1];
    const Wide3 a = e.along[0] * warp, a_below = e.along[1] * warp;
    const Wide3 b = e.across[0] * weft, b_right = e.across[1] * weft;
    const Wide3 su = u * (scale_ * (0.25f * p_.per_v) * by.of[2]);
    const Wide3 sv = v * (scale_ * (0.25f * p_.per_u) * by.of[2]);
    move(0, (a + b) + (su + sv));
    move(1, (b_right - a) + (su - sv));
    move(2, (a_below - b) + (sv - su));
    move(3, Wide3{} - ((a_below + b_right) + (su + sv)));
  }

  // The row first e' + second e'' of the edges along, or across, so many times softer than their material.
  template <bool kAcross>
  WEFT_INLINE void solve_edges(Wide first, Wide second, WideInt which, Wide softer, int slot) {
    const float per = kAcross ? p_.per_v : p_.per_u;
    const Wide give = softer * p_.give_difference[kAcross];
    const auto edges_of = [&](const Corners& x, Wide3(&to)[2]) {
      to[0] = (x.of[kAcross ? 2 : 1] - x.of[0]) * wide(per);
      to[1] = (x.of[3] - x.of[kAcross ? 1 : 2]) * wide(per);
    };
    Wide3 e[2];
    edges_of(x_, e);
    const Wide square[2] = {squared_length(e[0]), squared_length(e[1])};
    Wide r = 0.5f * (first * (square[0] - 1.0f) + second * (square[1] - 1.0f));
    if constexpr (kDamped) {
      Wide3 by[2];
      edges_of(way_, by);
      r = r + p_.rate * (first * gain(e[0], by[0]) + second * gain(e[1], by[1]));
    }
    Wide held{};
    if constexpr (kMultipliers) {
      held = place_.load_from(stress(slot)).near;
      r = r + give * held;
    }
    // As for the means: what is pressed together takes short steps.
    const auto inertia = [&](Wide share, Wide w, Wide length) {
      return share * share * w * max(length, wide(1));
    };
    const Wide scale = scale_ * per;
    const Wide a = inertia(first, w_[0] + w_[kAcross ? 2 : 1], square[0]) +
                   inertia(second, w_[kAcross ? 1 : 2] + w_[3], square[1]);
    const Wide by = select(which, r / (scale * (per * (1 + p_.rate)) * a + give), Wide{});
    if constexpr (kMultipliers) place_.store_to(stress(slot), held - by);
    const Wide3 one = e[0] * (first * scale * by), other = e[1] * (second * scale * by);
    move(0, one);
    move(kAcross ? 2 : 1, Wide3{} - one);
    move(kAcross ? 1 : 2, other);
    move(3, Wide3{} - other);
  }

  // The row of γ alone.
  WEFT_INLINE void solve_shear(WideInt which) {
    const Edges e(x_, p_.per_u, p_.per_v);
    const Wide3 u = e.twice_along(), v = e.twice_across();
    Wide r = dot(u, v) * 0.25f;
    if constexpr (kDamped) {
      const Edges by(way_, p_.per_u, p_.per_v);
      const Wide3 du = by.twice_along(), dv = by.twice_across();
      r = r + p_.rate * (dot(u, dv) + dot(v, du) - dot(du, dv)) * 0.25f;
    }
    Wide held{};
    if constexpr (kMultipliers) {
      held = place_.load_from(stress(2)).near;
      r = r + p_.give[kShear] * held;
    }
    const Wide3 su = u * wide(0.25f * p_.per_v), sv = v * wide(0.25f * p_.per_u);
    const Wide3 one = su + sv, other = su - sv;
    const Wide at_rest = wide(0.25f * (p_.per_u * p_.per_u + p_.per_v * p_.per_v));
    const Wide a = (w_[0] + w_[3]) * max(squared_length(one), at_rest) +
                   (w_[1] + w_[2]) * max(squared_length(other), at_rest);
    const Wide by = select(which, r / (scale_ * (1 + p_.rate) * a + p_.give[kShear]), Wide{});
    if constexpr (kMultipliers) place_.store_to(stress(2), held - by);
    const Wide s = scale_ * by;
    move(0, one * s);
    move(1, other * s);
    move(2, Wide3{} - other * s);
    move(3, Wide3{} - one * s);
  }

  // How much the strain of an edge, of its rest length, has grown by the way its ends have gone.
  WEFT_INLINE static Wide gain(Wide3 edge, Wide3 by) { return dot(edge - by * wide(0.5f), by); }

  WEFT_INLINE void move(int corner, Wide3 by) {
    by = by * w_[corner];
    x_.of[corner] = x_.of[corner] + by;
    moved_.of[corner] = moved_.of[corner] + by;
    if constexpr (kDamped) way_.of[corner] = way_.of[corner] + by;
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
  Wide scale_, w_[4];
  Corners x_, way_;  // where corners are, and how far they have gone in this substep
  Corners moved_{};
  There there_;
  WideInt whole_;
};

// The cells below row j, and below row j+2 if that is asked for.
template <bool kMultipliers, bool kDamped, bool kTorn>
WEFT_INLINE void solve_rows(const MembraneSweep& p, int j, bool two) {
  constexpr int kCells = kLanes == 1 ? 1 : kLanes / 2;  // of a row in a block
  const std::ptrdiff_t row = std::ptrdiff_t(j) * p.stride;
  const WideInt number = lane_numbers();
  const WideInt first_row = lanes_below(kCells);
  const WideInt rows = two || kLanes == 1 ? ~WideInt{} : first_row;
  const WideInt column = Parting<1>::place(select(first_row, number, number - kCells));
  for (int colour = 0; colour < 2; ++colour)
    for (int i = colour; i + 1 < p.columns; i += 2 * kCells)
      CellBlock<kMultipliers, kDamped, kTorn>(p, {row + i, two ? 2 * std::ptrdiff_t(p.stride) : 0},
                                              j, two ? j + 2 : j,
                                              rows & (column < p.columns - 1 - i))
          .solve();
}

template <bool kMultipliers, bool kDamped, bool kTorn>
void sweep(const MembraneSweep& given) {
  const MembraneSweep p = given;  // a copy that no store can alias
  const int last = (p.end < p.rows - 1 ? p.end : p.rows - 1) - 1;
  for (int j = p.begin + (p.begin % 2 != p.colour); j <= last;) {
    const bool two = kLanes > 1 && j + 2 <= last;
    solve_rows<kMultipliers, kDamped, kTorn>(p, j, two);
    j += two ? 4 : 2;
  }
}

template <bool kMultipliers, bool kDamped>
void sweep(const MembraneSweep& p) {
  p.alive[0] ? sweep<kMultipliers, kDamped, true>(p) : sweep<kMultipliers, kDamped, false>(p);
}

}  // namespace

void sweep_membrane(const MembraneSweep& p) {
  if (p.rate > 0) return p.stress ? sweep<true, true>(p) : sweep<false, true>(p);
  p.stress ? sweep<true, false>(p) : sweep<false, false>(p);
}

}  // namespace weft::WEFT_KERNELS
