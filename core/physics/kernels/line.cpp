// Line sweeps: all constraints of a line (a row, column or diagonal of the sheet) solved as one
// tridiagonal system in their multipliers, with lanes across the lines.
//
// For constraints c = 0, 1, … along a line, e_c from particle c to particle c+1, and the multiplier
// of c written as μ_c |e_c| (which frees the equations of every division but the pivot's):
//
//   (w_c + w_{c+1} + α̃) |e_c|² μ_c - w_c e_{c-1}·e_c μ_{c-1} - w_{c+1} e_c·e_{c+1} μ_{c+1}
//       = |e_c| (|e_c| - l + α̃ λ_c),            α̃ = 1/(k dt²)
//   x_c <- x_c + w_c (μ_c e_c - μ_{c-1} e_{c-1}),  λ_c <- λ_c - μ_c |e_c|
//
// the Newton step of the compliant constraints of one line together (Macklin, Müller, Chentanez
// 2016, with the whole of a line in place of one constraint), by the Thomas algorithm: elimination
// walks the lines forwards, substitution backwards. A constraint that does not exist or is cut has
// a pivot's reciprocal of zero: its multiplier is zero and the line falls into two.
#include "physics/kernels/line.h"

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::kStripLines;
using physics::kStripScratch;
using physics::LineStrip;

// Pivots below belong to no constraint, or to one of no length and so no direction; their reciprocals
// would not be finite.
constexpr float kTinyPivot = 1e-30f;
constexpr int kForesight = 8;  // rows

// Writes only the lanes of the mask: what lies in the others may belong to another thread.
WEFT_INLINE void store_where(float* p, WideInt mask, Wide v) {
#if WEFT_LANES == 16
  _mm512_mask_storeu_ps(p, _mm512_movepi32_mask((__m512i)mask), (__m512)v);
#else
  for (int i = 0; i < kLanes; ++i)
    if (mask[i] != 0) p[i] = v[i];
#endif
}

WEFT_INLINE void store3_where(Row3 r, std::ptrdiff_t at, WideInt mask, Wide3 v) {
  store_where(r.x + at, mask, v.x);
  store_where(r.y + at, mask, v.y);
  store_where(r.z + at, mask, v.z);
}

WEFT_INLINE Wide3 load3_at(Row3 r, std::ptrdiff_t at) {
  return {load(r.x + at), load(r.y + at), load(r.z + at)};
}

// Which of the lanes lane … lane+kLanes-1 are columns of the sheet.
WEFT_INLINE WideInt on_sheet(const LineStrip& p, int lane) {
  const WideInt lanes = lane_numbers() + lane;
  return (lanes >= 0) & (lanes < p.columns);
}

int quotient_up(int a, int b) {
  return a <= 0 ? 0 : (a + b - 1) / b;
}
int least(int a, int b) {
  return a < b ? a : b;
}
int greatest(int a, int b) {
  return a > b ? a : b;
}

// A block of kLanes lines: constraints begin … end-1 have a lane on the sheet at both their ends,
// and of those whole_begin … whole_end-1 have all lanes at both ends.
struct Range {
  int begin, end, whole_begin, whole_end;
};
Range range_of(const LineStrip& p, int line) {
  const int last = p.particles - 1;
  if (p.lean == 0) {
    const int end = line < p.columns ? last : 0;
    return {0, end, 0, line + kLanes <= p.columns ? end : 0};
  }
  const int lean = p.lean > 0 ? p.lean : -p.lean;
  // Lanes move right by `lean` a row; for lines that lean left seen in the mirror.
  const int left = p.lean > 0 ? line : p.columns - line - kLanes, right = left + kLanes - 1;
  // The rightmost lane is the first to come in at the left border, the first to go at the right.
  Range r{quotient_up(-right, lean), quotient_up(p.columns - lean - left, lean),
          quotient_up(-left, lean), quotient_up(p.columns - lean - right, lean)};
  for (int* c : {&r.begin, &r.end, &r.whole_begin, &r.whole_end}) *c = least(*c, last);
  r.whole_end = greatest(r.whole_begin, r.whole_end);
  return r;
}

// One block of lanes on its way along the lines.
template <bool kLambda, bool kVelocity>
struct Block {
  const LineStrip& p;
  int line;    // of lane 0
  int offset;  // of the block in the strip
  Range range;
  Wide3 edge{};  // of the constraint before (elimination) or after (substitution)
  Wide3 x{};     // of the particle where the next constraint starts
  Wide w{};
  Wide reciprocal{}, right{}, mu{};
  Wide3 pull{};

  WEFT_INLINE std::ptrdiff_t at(int m) const { return line + m * p.step; }
  WEFT_INLINE float* scratch(int m) const {
    return p.scratch + static_cast<std::ptrdiff_t>(m) * kStripScratch + offset;
  }
  // Asks for a row that will be written: rows are too far apart for the processor to foresee them, and
  // another core may hold them. Any address will do, past the last row, too.
  WEFT_INLINE void foresee(Row3 r, int m) const {
#if WEFT_LANES > 1
    for (const float* row : {r.x, r.y, r.z}) asm volatile("prefetchw %0" : : "m"(row[at(m)]));
#else
    (void)r, (void)m;
#endif
  }
  // e_c where the constraint exists, else 0.
  WEFT_INLINE Wide3 existing(Wide3 e, int m) const {
    const int lane = line + m * p.lean;
    return select(on_sheet(p, lane) & on_sheet(p, lane + p.lean), e, Wide3{});
  }
  // e_c where the constraint is not cut, else 0.
  WEFT_INLINE Wide3 holding(Wide3 e, int m) const {
    return p.alive ? select(lanes_at(p.alive + at(m)), e, Wide3{}) : e;
  }

  template <bool kWhole>
  WEFT_INLINE void eliminate(int m) {
    if constexpr (kWhole) foresee(p.x, m + kForesight);
    const Wide3 far = load3_at(p.x, at(m + 1));
    const Wide w_far = load(p.w + at(m + 1));
    Wide3 e = holding(far - x, m);
    if constexpr (!kWhole) e = existing(e, m);
    const Wide alpha = load(p.compliance + m * p.compliance_step + offset);
    const Wide squared = dot(e, e);
    const Wide length = sqrt(squared);
    const Wide coupling = w * dot(edge, e);
    const Wide factor = coupling * reciprocal;
    const Wide pivot = (w + w_far + alpha) * squared - factor * coupling;
    Wide violation = length - p.rest;
    if constexpr (kLambda)
      if (!p.fresh) violation = violation + alpha * load(p.lambda + at(m));
    right = length * violation + factor * right;
    reciprocal = select(pivot > kTinyPivot, 1.0f / pivot, Wide{});
    store(scratch(m), reciprocal);
    store(scratch(m) + kStripLines, right);
    if constexpr (kLambda) store(scratch(m) + 2 * kStripLines, length);
    edge = e;
    x = far;
    w = w_far;
  }
  // The same where the block may be partly or wholly off the sheet.
  WEFT_INLINE void eliminate_at_border(int m) {
    if (m < range.begin || m >= range.end) return;
    if (m == range.begin) {
      x = load3_at(p.x, at(m));
      w = load(p.w + at(m));
    }
    is_whole(m) ? eliminate<true>(m) : eliminate<false>(m);
  }
  WEFT_INLINE bool is_whole(int m) const {
    return m >= range.whole_begin && m < range.whole_end;
  }

  // Moves particle m by the pulls of the constraints before and after it.
  template <bool kWhole>
  WEFT_INLINE void shift(int m, Wide3 position, Wide inverse_mass, Wide3 by) const {
    const Wide3 change = by * (inverse_mass * p.share);
    add_to<kWhole>(p.x, m, position, change);
    // As computed: the difference of rounded positions over dt would be mostly rounding.
    if constexpr (kVelocity)
      add_to<kWhole>(p.v, m, load3_at(p.v, at(m)), change * wide(p.inverse_dt));
  }
  template <bool kWhole>
  WEFT_INLINE void add_to(Row3 r, int m, Wide3 before, Wide3 change) const {
    if constexpr (kWhole)
      store3({r.x + at(m), r.y + at(m), r.z + at(m)}, 0, before + change);
    else
      store3_where(r, at(m), on_sheet(p, line + m * p.lean), before + change);
  }

  template <bool kWhole>
  WEFT_INLINE void substitute(int m) {
    if constexpr (kWhole && kVelocity) foresee(p.v, m - kForesight);
    const Wide3 near = load3_at(p.x, at(m));
    Wide3 e = holding(x - near, m);
    if constexpr (!kWhole) e = existing(e, m);
    const Wide coupling = w * dot(e, edge);
    mu = load(scratch(m)) * (load(scratch(m) + kStripLines) + coupling * mu);
    if constexpr (kLambda) keep_multiplier(m);
    const Wide3 own = e * mu;
    shift<kWhole>(m + 1, x, w, pull - own);
    pull = own;
    edge = e;
    x = near;
    w = load(p.w + at(m));
  }
  WEFT_INLINE void substitute_at_border(int m) {
    if (m < range.begin || m >= range.end) return;
    if (m == range.end - 1) {
      x = load3_at(p.x, at(m + 1));
      w = load(p.w + at(m + 1));
      edge = Wide3{};
    }
    is_whole(m) ? substitute<true>(m) : substitute<false>(m);
    if (m == range.begin) shift<false>(m, x, w, pull);
  }

  WEFT_INLINE void keep_multiplier(int m) const {
    const Wide before = p.fresh ? Wide{} : load(p.lambda + at(m));
    const Wide lambda = before - mu * load(scratch(m) + 2 * kStripLines);
    store_where(p.lambda + at(m), on_sheet(p, line + m * p.lean), lambda);
  }
};

// One or two blocks of lines side by side: whole constraints in a loop without a branch, the others
// before and after it.
template <bool kLambda, bool kVelocity, int kBlocks>
void solve_blocks(const LineStrip& given, int first) {
  const LineStrip p = given;  // a copy that no store can alias
  using B = Block<kLambda, kVelocity>;
  B a{p, p.first + first, first, range_of(p, p.first + first)};
  const int second = first + (kBlocks - 1) * kLanes;
  B b{p, p.first + second, second, range_of(p, p.first + second)};
  const int begin = least(a.range.begin, b.range.begin), end = greatest(a.range.end, b.range.end);
  // The first and the last constraint of a line do more than the others.
  int whole = greatest(a.range.whole_begin, b.range.whole_begin);
  whole = greatest(whole, greatest(a.range.begin, b.range.begin) + 1);
  int whole_end = least(a.range.whole_end, b.range.whole_end);
  whole_end = least(whole_end, least(a.range.end, b.range.end) - 1);
  if (whole_end <= whole) whole = whole_end = end;
  int m = begin;
  const auto eliminate = [&]<bool kWhole>(int to) __attribute__((always_inline)) {
    for (; m < to; ++m) {
      if constexpr (kWhole) {
        a.template eliminate<true>(m);
        if constexpr (kBlocks == 2) b.template eliminate<true>(m);
      } else {
        a.eliminate_at_border(m);
        if constexpr (kBlocks == 2) b.eliminate_at_border(m);
      }
    }
  };
  eliminate.template operator()<false>(whole);
  eliminate.template operator()<true>(whole_end);
  eliminate.template operator()<false>(end);
  const auto substitute = [&]<bool kWhole>(int from) __attribute__((always_inline)) {
    while (m > from) {
      --m;
      if constexpr (kWhole) {
        a.template substitute<true>(m);
        if constexpr (kBlocks == 2) b.template substitute<true>(m);
      } else {
        a.substitute_at_border(m);
        if constexpr (kBlocks == 2) b.substitute_at_border(m);
      }
    }
  };
  substitute.template operator()<false>(whole_end);
  substitute.template operator()<true>(whole);
  substitute.template operator()<false>(begin);
}

template <bool kLambda, bool kVelocity>
void solve(const LineStrip& p) {
  if (kLanes >= 8 && p.lines >= 2 * kLanes) {
    for (int first = 0; first < p.lines; first += 2 * kLanes)
      solve_blocks<kLambda, kVelocity, 2>(p, first);
    return;
  }
  for (int first = 0; first < p.lines; first += kLanes)
    solve_blocks<kLambda, kVelocity, 1>(p, first);
}

}  // namespace

void line_strip(const LineStrip& p) {
  if (p.lambda) return p.inverse_dt > 0 ? solve<true, true>(p) : solve<true, false>(p);
  p.inverse_dt > 0 ? solve<false, true>(p) : solve<false, false>(p);
}

}  // namespace weft::WEFT_KERNELS
