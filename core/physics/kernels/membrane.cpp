// The membrane of a sheet, and the leapfrog step, in one pass over the rows: the energy of a St.
// Venant-Kirchhoff material in Green's strains, orthotropic along warp and weft,
//
//   on edges     e11 = (a·a/h_u² - 1)/2,  e22 = (b·b/h_v² - 1)/2
//   in cells     γ = (p·p - q·q)/(4 h_u h_v),  p, q the diagonals
//   E = h_u h_v Σ_cells [½ C11 mean(e11²) + ½ C22 mean(e22²) + C12 mean(e11) mean(e22) + ½ C66 γ²]
//
// with means over the two edges of a cell each way. An edge is pulled along itself by its own strain and
// by those across of the cells at it; an edge of the sheet has one cell, and so counts half. The shear
// pulls one diagonal of a cell and pushes the other. All of it is polynomial: no root, no division.
// Damping puts e + damping de/dt in the place of e.
//
// Bending (bending.cpp) goes along: its terms are linear in the same edges, and what a row does to the two after it is
// carried to them.
#include "physics/kernels/membrane.h"

#include "physics/kernels/leapfrog.h"
#include "physics/kernels/membrane_cells.h"
#include "physics/kernels/root.h"

namespace weft::WEFT_KERNELS {

using physics::MembraneConstants;
using physics::MembraneRows;

namespace {

// Strains of a block of cells; the shear without its factor.
struct Strains {
  Wide a, a_below, b, b_right, shear;
  WEFT_INLINE Strains(const Cells& x, float half_u, float half_v) {
    const auto green = [](Wide3 edge, float half) {
      return fma(squared_length(edge), wide(half), wide(-0.5f));
    };
    a = green(x.a, half_u);
    a_below = green(x.a_below, half_u);
    b = green(x.b, half_v);
    b_right = green(x.b_right, half_v);
    shear = squared_length(x.p) - squared_length(x.q);
  }
  // Adds `factor` times half of how fast they change.
  WEFT_INLINE void add_rates(const Cells& x, const Cells& v, float half_u, float half_v,
                             float factor) {
    const Wide u = wide(half_u * factor), w = wide(half_v * factor);
    a = fma(dot(x.a, v.a), u, a);
    a_below = fma(dot(x.a_below, v.a_below), u, a_below);
    b = fma(dot(x.b, v.b), w, b);
    b_right = fma(dot(x.b_right, v.b_right), w, b_right);
    shear = fma(dot(x.p, v.p) - dot(x.q, v.q), wide(factor), shear);
  }
};

// Which edges, cells and shears of a block are there.
struct There {
  WideInt along, across, whole, sheared;
  WEFT_INLINE There(int left)
      : along(lanes_below(left - 1)), across(lanes_below(left)), whole(along), sheared(along) {}
  // `lane`: of the block's first, from that of row 0. A cell is whole with its edges and diagonals.
  WEFT_INLINE void less_torn(const MembraneRows& r, std::ptrdiff_t lane, std::ptrdiff_t below) {
    const auto alive = [&](int stencil, std::ptrdiff_t at) {
      return lanes_at(r.alive[stencil] + at);
    };
    sheared = sheared & alive(2, lane) & alive(3, lane);
    whole = sheared & alive(0, lane) & alive(0, below) & alive(1, lane) & alive(1, lane + 1);
    along = along & alive(0, lane);
    across = across & alive(1, lane);
  }
};

// Floats carried for every lane of a row: pulls on the next row, strains along, and bending's pulls on the row after.
template <bool kBent>
constexpr int kCarried = kBent ? 7 : 4;

// The second differences and the twist of a block: from (i, j) along the row, across to the rows below, of the cell.
struct Curvatures {
  Wide3 along, across, twist;
  WEFT_INLINE Curvatures(const Cells& c, const float* row, const float* below, const float* below2,
                         std::ptrdiff_t plane) {
    along = (load_planes(row + 2, plane) - load_planes(row + 1, plane)) - c.a;
    across = (load_planes(below2, plane) - load_planes(below, plane)) - c.b;
    twist = c.a_below - c.a;
  }
  WEFT_INLINE void add_rates(const Curvatures& rates, float damping) {
    along = along + rates.along * wide(damping);
    across = across + rates.across * wide(damping);
    twist = twist + rates.twist * wide(damping);
  }
};

// What bending does to a block of a row, and to those below it in the next two rows.
class BendPulls {
 public:
  Wide3 own, next, after;
  template <bool kTorn>
  WEFT_INLINE void take(const MembraneRows& r, const BendStiffness& k, Curvatures d,
                        std::ptrdiff_t lane, int i) {
    const int left = r.columns - i;
    Wide along = select(lanes_below(left - 2), wide(k.along), Wide{});
    Wide twist = select(lanes_below(left - 1), wide(k.twist), Wide{});
    Wide across = load(r.width + i) * k.across;
    if constexpr (kTorn) {
      along = along * load(r.along + lane);
      twist = twist * load(r.twist + lane);
      across = across * load(r.across + lane);
    }
    const Wide3 a = d.along * along, t = d.twist * twist;
    after = Wide3{} - d.across * across;
    const Wide3 turn = twist_.next(t) - t;
    own = one_.next(a) * wide(2) - a - two_.next(a) + turn + after;
    next = Wide3{} - turn - after * wide(2);
  }

 private:
  Delay3<1> one_, twist_;
  Delay3<2> two_;
};

template <bool kDamped, bool kTorn, bool kBent, bool kSides, bool kAlike>
WEFT_INLINE void one_row(const MembraneRows& r, int j) {
  const std::ptrdiff_t plane = r.x.y - r.x.x, start = std::ptrdiff_t(j) * r.stride;
  const std::ptrdiff_t next = j + 1 < r.rows ? start + r.stride : start;
  const std::ptrdiff_t after = j + 2 < r.rows ? next + r.stride : next;
  const MembraneConstants c = r.constants[j];
  Delay<1> coupled;
  Delay3<1> to_right, to_below;
  BendPulls bend{};
  float* carry = r.carry;
  for (int i = 0; i < r.columns; i += kLanes, carry += kCarried<kBent> * kLanes) {
    const Cells x(r.x.x + start + i, r.x.x + next + i, plane);
    Strains e(x, r.half_u, r.half_v);
    if constexpr (kDamped)
      e.add_rates(x, Cells(r.v.x + start + i, r.v.x + next + i, plane), r.half_u, r.half_v,
                  2 * r.damping);
    There there(r.columns - i);
    if constexpr (kTorn) there.less_torn(r, start + i, next + i);

    const Wide along = select(there.whole, (e.b + e.b_right) * c.along, Wide{});
    const Wide across = select(there.whole, (e.a + e.a_below) * c.across, Wide{});
    const Wide before = load(carry + 3 * kLanes);  // of the cells of the row before
    const Wide pull_a = select(there.along, fma(e.a, wide(c.warp), before + along), Wide{});
    const Wide weft = load(r.share + i) * c.weft;
    const Wide pull_b = select(there.across, fma(e.b, weft, across + coupled.next(across)), Wide{});
    const Wide shear = select(there.sheared, e.shear * c.shear, Wide{});

    const Wide3 a = x.a * pull_a, b = x.b * pull_b, p = x.p * shear, q = x.q * shear;
    Wide3 own = load_planes(carry, kLanes) + (a + b + p) + to_right.next(q - a);
    Wide3 below = Wide3{} - (b + q + to_below.next(p));
    if constexpr (kBent) {
      Curvatures d(x, r.x.x + start + i, r.x.x + next + i, r.x.x + after + i, plane);
      if constexpr (kDamped) {
        const Cells v(r.v.x + start + i, r.v.x + next + i, plane);
        d.add_rates({v, r.v.x + start + i, r.v.x + next + i, r.v.x + after + i, plane},
                    r.bend_damping);
      }
      bend.template take<kTorn>(r, r.bend[j], d, start + i, i);
      own = own + bend.own;
      below = below + bend.next + load_planes(carry + 4 * kLanes, kLanes);
      store_planes(carry + 4 * kLanes, kLanes, bend.after);
    }
    store_planes(carry, kLanes, below);
    store(carry + 3 * kLanes, along);
    leapfrog<kSides, kAlike>(r, r.x.x + start + i, r.columns - i, own);
  }
}

template <bool kDamped, bool kTorn, bool kBent, bool kSides, bool kAlike>
void rows_of(const MembraneRows& given) {
  const MembraneRows r = given;
  for (int j = r.begin; j < r.end; ++j) one_row<kDamped, kTorn, kBent, kSides, kAlike>(r, j);
}
template <bool kDamped, bool kTorn, bool kBent>
void rows_of(const MembraneRows& r) {
  if (!(r.alike > 0)) return rows_of<kDamped, kTorn, kBent, false, false>(r);
  r.sides ? rows_of<kDamped, kTorn, kBent, true, true>(r)
          : rows_of<kDamped, kTorn, kBent, false, true>(r);
}
template <bool kDamped, bool kTorn>
void rows_of(const MembraneRows& r) {
  r.bend ? rows_of<kDamped, kTorn, true>(r) : rows_of<kDamped, kTorn, false>(r);
}
template <bool kDamped>
void rows_of(const MembraneRows& r) {
  r.alive[0] ? rows_of<kDamped, true>(r) : rows_of<kDamped, false>(r);
}

}  // namespace

void membrane_rows(const MembraneRows& r) {
  r.damping > 0 || r.bend_damping > 0 ? rows_of<true>(r) : rows_of<false>(r);
}

}  // namespace weft::WEFT_KERNELS
