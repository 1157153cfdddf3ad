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
// the Newton step of the compliant constraints of one line together (Macklin, Müller, Chentanez 2016,
// with the whole of a line in place of one constraint), by the Thomas algorithm: elimination walks
// the lines forwards, substitution backwards. A constraint that does not exist or is cut has a
// pivot's reciprocal of zero: its multiplier is zero and the line falls into two.
#include "physics/kernels/line.h"

#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::kStripLines;
using physics::kStripScratch;
using physics::LineStrip;
using physics::TransposeRows;

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

WEFT_INLINE WideInt load_int(const std::int32_t* p) {
  typedef WideInt Loose __attribute__((aligned(4), may_alias));
  return *reinterpret_cast<const Loose*>(p);
}

// Which of the lanes lane … lane+kLanes-1 are columns of the sheet.
WEFT_INLINE WideInt on_sheet(const LineStrip& p, int lane) {
  const WideInt lanes = lane_numbers() + lane;
  return (lanes >= 0) & (lanes < p.columns);
}
WEFT_INLINE bool all_on_sheet(const LineStrip& p, int lane) {
  return lane >= 0 && lane + kLanes <= p.columns;
}

int quotient_up(int a, int b) { return a <= 0 ? 0 : (a + b - 1) / b; }

// Constraints begin … end-1 of a block of lines have a lane on the sheet at both their ends.
struct Range {
  int begin, end;
};
Range range_of(const LineStrip& p, int line) {
  const int last = p.particles - 1;
  if (p.lean == 0) return {0, line < p.columns ? last : 0};
  const int lean = p.lean > 0 ? p.lean : -p.lean;
  // Lanes move right by `lean` a row; for lines that lean left seen in the mirror.
  const int left = p.lean > 0 ? line : p.columns - line - kLanes;
  const int begin = quotient_up(-(left + kLanes - 1), lean);
  // The leftmost lane's far end is the last to leave at the right border.
  const int end = quotient_up(p.columns - lean - left, lean);
  return {begin < last ? begin : last, end < last ? end : last};
}

// One block of lanes on its way along the lines.
template <bool kLambda>
struct Block {
  const LineStrip& p;
  int line;       // of lane 0
  int offset;     // of the block in the strip
  Range range;
  Wide3 edge{};   // of the constraint before (elimination) or after (substitution)
  Wide3 x{};      // of the particle where the next constraint starts
  Wide w{};
  Wide reciprocal{}, right{}, mu{};
  Wide3 pull{};

  WEFT_INLINE std::ptrdiff_t at(int m) const { return line + m * p.step; }
  WEFT_INLINE float* scratch(int m) const {
    return p.scratch + static_cast<std::ptrdiff_t>(m) * kStripScratch + offset;
  }
  WEFT_INLINE Wide compliance(int m) const {
    return load(p.compliance + m * p.compliance_step + offset);
  }
  // e_c where the constraint exists, else 0.
  WEFT_INLINE Wide3 existing(Wide3 e, int m) const {
    const int lane = line + m * p.lean;
    if (!all_on_sheet(p, lane) || !all_on_sheet(p, lane + p.lean))
      e = select(on_sheet(p, lane) & on_sheet(p, lane + p.lean), e, Wide3{});
    if (p.alive) e = select(load_int(p.alive + at(m)), e, Wide3{});
    return e;
  }

  WEFT_INLINE void eliminate(int m) {
    if (m < range.begin || m >= range.end) return;
    if (m == range.begin) {
      x = load3_at(p.x, at(m));
      w = load(p.w + at(m));
    }
    const Wide3 far = load3_at(p.x, at(m + 1));
    const Wide w_far = load(p.w + at(m + 1));
    const Wide3 e = existing(far - x, m);
    const Wide alpha = compliance(m);
    const Wide squared = dot(e, e);
    const Wide length = sqrt(squared);
    const Wide coupling = w * dot(edge, e);
    const Wide factor = coupling * reciprocal;
    const Wide pivot = (w + w_far + alpha) * squared - factor * coupling;
    Wide violation = length - p.rest;
    if constexpr (kLambda)
      if (!p.fresh) violation = violation + alpha * load(p.lambda + at(m));
    right = length * violation + factor * right;
    reciprocal = select(pivot > 0.0f, 1.0f / pivot, Wide{});
    store(scratch(m), reciprocal);
    store(scratch(m) + kStripLines, right);
    if constexpr (kLambda) store(scratch(m) + 2 * kStripLines, length);
    edge = e;
    x = far;
    w = w_far;
  }

  // Moves particle m by the pulls of the constraints before and after it.
  WEFT_INLINE void shift(int m, Wide3 position, Wide inverse_mass, Wide3 by) const {
    const Wide3 moved = position + by * (inverse_mass * p.share);
    const int lane = line + m * p.lean;
    if (all_on_sheet(p, lane)) return store3({p.x.x + at(m), p.x.y + at(m), p.x.z + at(m)}, 0, moved);
    store3_where(p.x, at(m), on_sheet(p, lane), moved);
  }

  WEFT_INLINE void substitute(int m) {
    if (m < range.begin || m >= range.end) return;
    if (m == range.end - 1) {
      x = load3_at(p.x, at(m + 1));
      w = load(p.w + at(m + 1));
      edge = Wide3{};
    }
    const Wide3 near = load3_at(p.x, at(m));
    const Wide3 e = existing(x - near, m);
    const Wide coupling = w * dot(e, edge);
    mu = load(scratch(m)) * (load(scratch(m) + kStripLines) + coupling * mu);
    if constexpr (kLambda) keep_multiplier(m);
    const Wide3 own = e * mu;
    shift(m + 1, x, w, pull - own);
    pull = own;
    edge = e;
    x = near;
    w = load(p.w + at(m));
    if (m == range.begin) shift(m, x, w, pull);
  }

  WEFT_INLINE void keep_multiplier(int m) const {
    const Wide before = p.fresh ? Wide{} : load(p.lambda + at(m));
    const Wide lambda = before - mu * load(scratch(m) + 2 * kStripLines);
    store_where(p.lambda + at(m), on_sheet(p, line + m * p.lean), lambda);
  }
};

template <bool kLambda, int kBlocks>
void solve(const LineStrip& p) {
  const auto block = [&](int n) {
    return Block<kLambda>{p, p.first + n * kLanes, n * kLanes, range_of(p, p.first + n * kLanes)};
  };
  int begin = p.particles, end = 0;
  for (int n = 0; n < kBlocks; ++n) {
    const Range r = block(n).range;
    if (r.begin >= r.end) continue;
    begin = r.begin < begin ? r.begin : begin;
    end = r.end > end ? r.end : end;
  }
  // A block at a time in the narrow builds; two of the widest side by side.
  constexpr int kTogether = kLanes == 16 ? kBlocks : 1;
  for (int first = 0; first < kBlocks; first += kTogether) {
    Block<kLambda> a = block(first), b = block(first + kTogether - 1);
    for (int m = begin; m < end; ++m) {
      a.eliminate(m);
      if constexpr (kTogether == 2) b.eliminate(m);
    }
    for (int m = end - 1; m >= begin; --m) {
      a.substitute(m);
      if constexpr (kTogether == 2) b.substitute(m);
    }
  }
}

// A 4 by 4 tile from one layout to the other.
WEFT_INLINE void transpose4(const float* from, std::ptrdiff_t from_step, float* to,
                            std::ptrdiff_t to_step) {
#if WEFT_LANES > 1
  __m128 a = _mm_loadu_ps(from), b = _mm_loadu_ps(from + from_step),
         c = _mm_loadu_ps(from + 2 * from_step), d = _mm_loadu_ps(from + 3 * from_step);
  _MM_TRANSPOSE4_PS(a, b, c, d);
  _mm_storeu_ps(to, a);
  _mm_storeu_ps(to + to_step, b);
  _mm_storeu_ps(to + 2 * to_step, c);
  _mm_storeu_ps(to + 3 * to_step, d);
#else
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) to[j * to_step + i] = from[i * from_step + j];
#endif
}

}  // namespace

void line_strip(const LineStrip& p) {
  constexpr int kHalf = 16 / kLanes;
  if (p.lambda) {
    if (p.lines == 16) return solve<true, kHalf>(p);
    return solve<true, 2 * kHalf>(p);
  }
  if (p.lines == 16) return solve<false, kHalf>(p);
  solve<false, 2 * kHalf>(p);
}

void rows_to_lanes(const TransposeRows& t) {
  const int whole = t.row_count & ~3;
  for (int i = 0; i < t.columns; i += 4)  // reads the padding of the last columns
    for (int r = 0; r < whole; r += 4)
      transpose4(t.rows + r * t.stride + i, t.stride, t.lanes + i * t.pitch + r, t.pitch);
  for (int r = whole; r < t.row_count; ++r)
    for (int i = 0; i < t.columns; ++i) t.lanes[i * t.pitch + r] = t.rows[r * t.stride + i];
}

void lanes_to_rows(const TransposeRows& t) {
  const int rows = t.row_count & ~3, columns = t.columns & ~3;
  for (int i = 0; i < columns; i += 4)
    for (int r = 0; r < rows; r += 4)
      transpose4(t.lanes + i * t.pitch + r, t.pitch, t.rows + r * t.stride + i, t.stride);
  for (int r = 0; r < t.row_count; ++r)
    for (int i = r < rows ? columns : 0; i < t.columns; ++i)
      t.rows[r * t.stride + i] = t.lanes[i * t.pitch + r];
}

}  // namespace weft::WEFT_KERNELS
