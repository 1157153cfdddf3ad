// Bending by curvature energy, linear in curvature: for an inextensible sheet of flexural rigidity
// D
//
//   E = ½ D ∫ |x_uu|² + |x_vv|² + 2 |x_uv|² dA
//
// is the energy of a plate without Poisson's effect, and quadratic in the positions (Bergou et al.
// 2006, "A quadratic bending model for inextensible surfaces"). On the grid, with second
// differences d of three neighbours in line and the twist t of a cell,
//
//   E = ½ k_u Σ |x_{i-1} - 2 x_i + x_{i+1}|² + the same along v + ½ k_t Σ |x_00 - x_10 - x_01 +
//   x_11|².
//
// As a force for the explicit methods. For those that project, as compliant constraints d = 0 and
// t = 0: the second differences of a line together, whose multipliers solve a pentadiagonal system,
//
//   A μ = d,  A = B W Bᵀ + α̃,  α̃ = 1/(k dt²),   u <- u - W Bᵀ μ,     B = rows (1, -2, 1)
//
// of particles at x + u, whose corrections u positions do not round.
#include "physics/kernels/bending.h"

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

using physics::BendLine;
using physics::BendRow;
using physics::kBendLines;
using physics::kBendScratch;
using physics::TwistRow;

namespace {

// Terms that are torn are none.
WEFT_INLINE Wide3 of_those_left(Wide3 term, const float* left, int i) {
  return left ? term * load(left + i) : term;
}

// Force of the row's own second differences on its particles: d[a] belongs to a, a+1, a+2.
struct AlongRow {
  Delay3<1> one;
  Delay3<2> two;
  WEFT_INLINE Wide3 next(ConstRow3 x, const float* left, int i, int columns) {
    const Wide3 all = load3(x, i) - load3(x, i + 1) * wide(2) + load3(x, i + 2);
    const Wide3 d = of_those_left(select(lanes_below(columns - 2 - i), all, Wide3{}), left, i);
    return one.next(d) * wide(2) - d - two.next(d);
  }
};

// Difference of neighbouring twists of the cells between two rows.
struct Twist {
  Delay3<1> one;
  WEFT_INLINE Wide3 next(ConstRow3 x, ConstRow3 below, const float* left, int i, int columns) {
    const Wide3 all = (load3(x, i) - load3(x, i + 1)) - (load3(below, i) - load3(below, i + 1));
    const Wide3 t = of_those_left(select(lanes_below(columns - 1 - i), all, Wide3{}), left, i);
    return t - one.next(t);
  }
};

WEFT_INLINE void push(const BendRow& r, int row, int i, Wide3 force) {
  const Wide gain = load(r.w[row] + i) * r.dt;
  store3(r.v[row], i, load3(r.v[row], i) + force * gain);
}

}  // namespace

void bend_row(const BendRow& given) {
  const BendRow r = given;
  AlongRow along;
  Twist twist;
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    Wide3 own = along.next(r.x[0], r.along, i, r.columns) * wide(r.k.along), next{};
    if (r.rows > 1) {
      const Wide3 t = twist.next(r.x[0], r.x[1], r.twist, i, r.columns) * wide(r.k.twist);
      own = own - t;
      next = t;
    }
    if (r.rows > 2) {
      const Wide3 all = load3(r.x[0], i) - load3(r.x[1], i) * wide(2) + load3(r.x[2], i);
      const Wide3 d = of_those_left(all * (load(r.width + i) * r.k.across), r.across, i);
      own = own - d;
      next = next + d * wide(2);
      push(r, 2, i, Wide3{} - d);
    }
    push(r, 0, i, own);
    if (r.rows > 1) push(r, 1, i, next);
  }
}

namespace {

WEFT_INLINE void add(Row3 u, int i, Wide3 by) {
  store3(u, i, load3(u, i) + by);
}

// One block of lines. Constraint m joins particles m, m+1, m+2.
WEFT_INLINE void bend_block(const BendLine& p, int lane) {
  const auto row = [&](auto r, int m) {
    const std::ptrdiff_t at = lane + m * p.step;
    return decltype(r){r.x + at, r.y + at, r.z + at};
  };
  const auto position = [&](int m) { return load3(row(p.x, m), 0) + load3(row(p.u, m), 0); };
  const auto shift = [&](int m, Wide3 by) { add(row(p.u, m), 0, by); };
  const auto mass = [&](int m) { return load(p.w + lane + m * p.step); };
  const auto scratch = [&](int m) {
    return p.scratch + static_cast<std::ptrdiff_t>(m) * kBendScratch + lane;
  };
  const auto triple = [&](int m) {
    float* s = scratch(m) + 2 * kBendLines;
    return Row3{s, s + kBendLines, s + 2 * kBendLines};
  };
  const int count = p.particles - 2;
  const Wide compliance = load(p.compliance + lane);
  Wide r1{}, r2{}, u1{};  // reciprocal pivots of m-1 and m-2, subdiagonal of m-1
  Wide3 g1{}, g2{};
  Wide3 xa = position(0), xb = position(1);
  Wide wa = mass(0), wb = mass(1);
  for (int m = 0; m < count; ++m) {
    const Wide3 xc = position(m + 2), d = (xa - xb) - (xb - xc);
    const Wide wc = mass(m + 2);
    // The couplings with constraints m-2 and m-1 vanish with the reciprocals of what is not there.
    const Wide two = wa * r2;
    const Wide u = (wa + wb) * -2.0f - two * u1;
    const Wide one = u * r1;
    const Wide pivot = (wa + wb * 4.0f + wc + compliance) - (u * one + wa * two);
    // One that is torn has no multiplier, and couples with none.
    Wide r = select(pivot > 0.0f, 1.0f / pivot, Wide{});
    if (p.left) r = r * load(p.left + lane + m * p.step);
    const Wide3 g = d - (g1 * one + g2 * two);
    store(scratch(m), r);
    store(scratch(m) + kBendLines, u);
    store3(triple(m), 0, g);
    r2 = r1;
    r1 = r;
    u1 = u;
    g2 = g1;
    g1 = g;
    xa = xb;
    xb = xc;
    wa = wb;
    wb = wc;
  }
  Wide3 mu1{}, mu2{};  // multipliers of m+1 and m+2
  Wide ua{};           // subdiagonal of m+1
  for (int m = count - 1; m >= 0; --m) {
    const Wide w2 = mass(m + 2);
    const Wide3 mu = (load3(triple(m), 0) - (mu1 * ua + mu2 * w2)) * load(scratch(m));
    const Wide3 pull = mu - mu1 * wide(2) + mu2;
    shift(m + 2, Wide3{} - pull * w2);
    ua = load(scratch(m) + kBendLines);
    mu2 = mu1;
    mu1 = mu;
  }
  shift(1, (mu1 * wide(2) - mu2) * mass(1));
  shift(0, Wide3{} - mu1 * mass(0));
}

}  // namespace

void bend_line(const BendLine& given) {
  const BendLine p = given;
  if (p.particles < 3) return;
  for (int lane = 0; lane < kBendLines; lane += kLanes) bend_block(p, lane);
}

void bend_twist(const TwistRow& given) {
  const TwistRow r = given;
  Delay3<1> left;
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const auto at = [](ConstRow3 x, Row3 u, int n) { return load3(x, n) + load3(u, n); };
    const Wide3 above = at(r.x, r.u, i) - at(r.x, r.u, i + 1);
    const Wide3 below = at(r.below, r.u_below, i) - at(r.below, r.u_below, i + 1);
    const Wide3 t = of_those_left(above - below, r.left, i);
    const Wide wa = load(r.w + i), wb = load(r.w + i + 1);
    const Wide wc = load(r.w_below + i), wd = load(r.w_below + i + 1);
    const WideInt chosen =
        (((lane_numbers() + i) & 1) == (r.odd ? 1 : 0)) & lanes_below(r.columns - 1 - i);
    const Wide3 mu = select(chosen, t * (1.0f / (wa + wb + wc + wd + r.compliance)), Wide3{});
    const Wide3 by = mu - left.next(mu);
    add(r.u, i, Wide3{} - by * wa);
    add(r.u_below, i, by * wc);
  }
}

}  // namespace weft::WEFT_KERNELS
