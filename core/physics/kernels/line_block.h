// Lines on their way through the sheet, for the kernels that solve them (line.cpp, membrane_line.cpp): lanes
// across the lines, elimination forwards and substitution backwards, and lines that leave the sheet at one
// side and come in again at the other. What the constraints are is said by a law.
#pragma once

#include "physics/kernels/line.h"
#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::kBatchLines;
using physics::kBatchScratch;
using physics::LineBatch;

// Pivots below belong to no constraint, or to one of no length and so no direction; their reciprocals
// would not be finite.
constexpr float kTinyPivot = 1e-30f;
constexpr int kForesight = 8;  // rows

int least(int a, int b) {
  return a < b ? a : b;
}
int greatest(int a, int b) {
  return a > b ? a : b;
}

// Writes only the lanes of the mask: what lies in the others may belong to another thread.
WEFT_INLINE void store_where(float* p, WideInt mask, Wide v) {
#if WEFT_LANES == 16
  _mm512_mask_storeu_ps(p, _mm512_movepi32_mask((__m512i)mask), (__m512)v);
#elif WEFT_LANES == 8
  _mm256_maskstore_ps(p, (__m256i)mask, (__m256)v);
#else
  for (int i = 0; i < kLanes; ++i)
    if (mask[i] != 0) p[i] = v[i];
#endif
}

// Where a block of kLanes neighbouring lines lies in a row: in lanes next to each other,
struct Whole {
  std::ptrdiff_t at;
};
// or partly beyond the side of the sheet, where those lines come in again at the other side.
struct Split {
  std::ptrdiff_t at, again;
  WideInt inside, beyond;  // which lanes are lines at all, and on this side or the other
};

WEFT_INLINE Wide load_at(const float* p, Whole s) {
  return load(p + s.at);
}
WEFT_INLINE Wide load_at(const float* p, Split s) {
  const Wide here = load(p + s.at);
  return s.again == s.at ? here : select(s.beyond, load(p + s.again), here);
}
WEFT_INLINE void store_at(float* p, Whole s, Wide v) {
  store(p + s.at, v);
}
WEFT_INLINE void store_at(float* p, Split s, Wide v) {
  store_where(p + s.at, s.inside, v);
  if (s.again != s.at) store_where(p + s.again, s.beyond, v);
}
template <class Place>
WEFT_INLINE Wide3 load3_at(ConstRow3 r, Place s) {
  return {load_at(r.x, s), load_at(r.y, s), load_at(r.z, s)};
}
template <class Place>
WEFT_INLINE void store3_at(Row3 r, Place s, Wide3 v) {
  store_at(r.x, s, v.x);
  store_at(r.y, s, v.y);
  store_at(r.z, s, v.z);
}

// What a constraint holds: a length |e|, or half of a squared length e·e/2, which needs no root.
enum class LineLaw { length, square };
// A block of kLanes lines on its way along the sheet. kFirst: u is still zero.
template <LineLaw kLaw, bool kLambda, bool kFirst>
class Block {
 public:
  // `step`: of Newton's, from 0.
  Block(const LineBatch& batch, int offset, int step)
      : p(batch), offset_(offset), step_(step), line_(batch.first + offset) {
    const int left = batch.columns - line_;
    lines_ = left < kLanes ? left : kLanes;
    if (p.lean == 0) {  // nothing leaves the sheet, and beyond its side is padding without mass
      last_whole_ = line_;
    } else if (lines_ == kLanes) {
      first_whole_ = p.lean < 0 ? -p.lean : 0;
      last_whole_ = p.columns - kLanes - (p.lean > 0 ? p.lean : 0);
    }
  }

  // Whether constraint m of all lines goes from lanes to lanes next to each other; and if it does,
  // how many in a row do, m and those after it, or m and those before it.
  WEFT_INLINE bool whole(int m) const { return lane(m) >= first_whole_ && lane(m) <= last_whole_; }
  WEFT_INLINE int whole_from(int m) const {
    if (p.lean == 0) return p.particles;
    return p.lean > 0 ? (last_whole_ - lane(m)) / p.lean + 1
                      : (first_whole_ - lane(m)) / p.lean + 1;
  }
  WEFT_INLINE int whole_back_from(int m) const {
    if (p.lean == 0) return p.particles;
    return p.lean > 0 ? (lane(m) - first_whole_) / p.lean + 1
                      : (lane(m) - last_whole_) / p.lean + 1;
  }

  // Elimination: begin(), then every constraint in turn.
  WEFT_INLINE void begin() {
    const Split here = split(0);
    u_ = gathered(here);
    x_ = moved(here, u_);
    w_ = load_at(p.w, here);
  }
  template <bool kWhole>
  WEFT_INLINE void eliminate(int m) {
    if constexpr (kWhole) {
      foresee(least(m + kForesight, p.particles - 1));
      eliminate(m, at(m), at(m + 1), [](WideInt pivots) { return pivots; });
    } else {
      const Split here = split(m);
      const WideInt there = lane_numbers() + (lane(m) + p.lean) - (here.beyond & p.columns);
      const WideInt exists = (here.inside | here.beyond) & (there >= 0) & (there < p.columns);
      wrap(m + 1);
      eliminate(m, here, split(m + 1), [&](WideInt pivots) { return pivots & exists; });
    }
  }

  // Substitution: every constraint from the last to the first, then end().
  template <bool kWhole>
  WEFT_INLINE void substitute(int m) {
    if constexpr (kWhole) {
      substitute(m, at(m), at(m + 1));
    } else {
      const Split there = split(m + 1);
      wrap(m);
      substitute(m, split(m), there);
    }
  }
  WEFT_INLINE void end() { shift(split(0), pull_); }

 private:
  WEFT_INLINE int lane(int m) const { return line_ + m * p.lean; }
  WEFT_INLINE Whole at(int m) const { return {line_ + m * p.step}; }
  // The block's first line is to be on the sheet in row m, be it come in again.
  WEFT_INLINE void wrap(int m) {
    if (lane(m) >= p.columns) line_ -= p.columns;
    if (lane(m) < 0) line_ += p.columns;
  }
  WEFT_INLINE Split split(int m) const {
    const std::ptrdiff_t here = line_ + m * p.step;
    const WideInt lanes = lane_numbers() + lane(m), lines = lanes_below(lines_);
    return {here, lane(m) + lines_ > p.columns ? here - p.columns : here,
            lines & (lanes < p.columns), lines & (lanes >= p.columns)};
  }
  WEFT_INLINE float* scratch(int m) const {
    return p.scratch + static_cast<std::ptrdiff_t>(m) * kBatchScratch + offset_;
  }
  // Asks for rows that will be written: they are too far apart for the processor to foresee them, and another core
  // may hold them. None but its own: another core may need what lies beyond.
  WEFT_INLINE void foresee(int m) const {
#if WEFT_LANES > 1
    for (const float* row : {p.u.x, p.u.y, p.u.z})
      asm volatile("prefetchw %0" : : "m"(row[at(m).at]));
#else
    (void)m;
#endif
  }
  template <class Place>
  WEFT_INLINE Wide3 gathered(Place s) const {
    if constexpr (kFirst) return Wide3{};
    return load3_at(p.u, s);
  }
  template <class Place>
  WEFT_INLINE Wide3 moved(Place s, Wide3 u) const {
    const Wide3 x = load3_at(p.x, s);
    if constexpr (kFirst) return x;
    return x + u;
  }
  // Which of the constraints from here are not cut.
  WEFT_INLINE WideInt alive(Whole s) const {
    return lanes_at(p.alive + s.at);
  }
  WEFT_INLINE WideInt alive(Split s) const {
    return s.beyond ? lanes_at(p.alive + s.again) : lanes_at(p.alive + s.at);
  }

  template <class Place, class Existing>
  WEFT_INLINE void eliminate(int m, Place here, Place there, const Existing& existing) {
    const Wide3 u_far = gathered(there), far = moved(there, u_far);
    const Wide w_far = load_at(p.w, there);
    const Wide3 e = far - x_;
    const Wide alpha = load(p.compliance + m * p.compliance_step + offset_);
    const Wide squared = squared_length(e);
    const Wide coupling = w_ * dot(edge_, e);
    const Wide factor = coupling * reciprocal_;
    Wide length, pivot;
    if constexpr (kLaw == LineLaw::length) {
      length = sqrt(squared);
      pivot = fnma(factor, coupling, (w_ + w_far + alpha) * squared);
      Wide rest =
          p.rests ? load(p.rests + std::ptrdiff_t(m) * kBatchLines + offset_) : wide(p.rest);
      if constexpr (kLambda)
        if (!p.fresh) rest = fnma(alpha, load_at(p.lambda, here), rest);
      right_ = fma(factor, right_, fnma(length, rest, squared));
    } else {
      pivot = fnma(factor, coupling, fma(w_ + w_far, squared, alpha));
      const Wide rest = p.squares ? load_at(p.squares, here) : wide(p.rest * p.rest);
      Wide violation = (squared - rest) * 0.5f;
      if (step_ > 0) {
        violation = fma(alpha, load(scratch(m) + 2 * kBatchLines), violation);
      } else if constexpr (kLambda) {
        const Wide before = p.fresh ? Wide{} : load_at(p.lambda, here);
        store(scratch(m) + 2 * kBatchLines, before);
        violation = fma(alpha, before, violation);
      }
      right_ = fma(factor, right_, violation);
    }
    WideInt solved = existing(pivot > kTinyPivot);
    if (p.alive) solved = solved & alive(here);
    reciprocal_ = select(solved, 1.0f / pivot, Wide{});
    store(scratch(m), right_ * reciprocal_);
    store(scratch(m) + kBatchLines, factor);
    if constexpr (kLaw == LineLaw::length && kLambda) store(scratch(m) + 2 * kBatchLines, length);
    edge_ = e;
    u_ = u_far;
    x_ = far;
    w_ = w_far;
  }

  template <class Place>
  WEFT_INLINE void substitute(int m, Place here, Place there) {
    const Wide3 u_near = gathered(here), near = moved(here, u_near);
    mu_ = fma(factor_, mu_, load(scratch(m)));
    factor_ = load(scratch(m) + kBatchLines);
    if constexpr (kLaw == LineLaw::square) {
      remember(m, here);
    } else if constexpr (kLambda) {
      const Wide before = p.fresh ? Wide{} : load_at(p.lambda, here);
      store_at(p.lambda, here, fnma(mu_, load(scratch(m) + 2 * kBatchLines), before));
    }
    // No multiplier where there is no constraint, whatever lies between the lanes.
    const Wide3 own = (x_ - near) * mu_;
    shift(there, pull_ - own);
    pull_ = own;
    u_ = u_near;
    x_ = near;
    w_ = load_at(p.w, here);
  }

  // The multiplier of a constraint for the next of Newton's steps, and after the last for the next sweep.
  template <class Place>
  WEFT_INLINE void remember(int m, Place here) const {
    float* kept = scratch(m) + 2 * kBatchLines;
    const Wide now = kLambda || step_ > 0 ? load(kept) - mu_ : -mu_;
    if (step_ + 1 < p.steps) return store(kept, now);
    if constexpr (kLambda) store_at(p.lambda, here, now);
  }

  // Moves a particle by the pulls of the constraints before and after it.
  template <class Place>
  WEFT_INLINE void shift(Place s, Wide3 by) const {
    store3_at(p.u, s, fma(by, w_ * p.share, u_));
  }

  const LineBatch& p;
  int offset_;  // of the block in the batch
  int step_;
  int lines_;  // that exist
  int line_;   // of lane 0 if it went on straight to where it is now
  int first_whole_ = 0, last_whole_ = -1;
  Wide3 x_{}, u_{};  // of the particle that the last constraint has led to
  Wide w_{};
  // Elimination: of the constraint before.
  Wide3 edge_{};
  Wide reciprocal_{}, right_{};
  // Substitution: of the constraint after.
  Wide mu_{}, factor_{};
  Wide3 pull_{};
};

// One or two blocks of lines side by side.
template <LineLaw kLaw, bool kLambda, bool kFirst, int kBlocks>
void solve_blocks(const LineBatch& given, int first, int step) {
  const LineBatch p = given;  // a copy that no store can alias
  Block<kLaw, kLambda, kFirst> a(p, first, step), b(p, first + (kBlocks - 1) * kLanes, step);
  const int constraints = p.particles - 1;
  a.begin();
  if constexpr (kBlocks == 2) b.begin();
  int m = 0;
  while (m < constraints) {
    if (a.whole(m) && b.whole(m)) {
      const int together = least(a.whole_from(m), b.whole_from(m));
      for (const int end = least(m + together, constraints); m < end; ++m) {
        a.template eliminate<true>(m);
        if constexpr (kBlocks == 2) b.template eliminate<true>(m);
      }
    } else {
      a.whole(m) ? a.template eliminate<true>(m) : a.template eliminate<false>(m);
      if constexpr (kBlocks == 2)
        b.whole(m) ? b.template eliminate<true>(m) : b.template eliminate<false>(m);
      ++m;
    }
  }
  --m;
  while (m >= 0) {
    if (a.whole(m) && b.whole(m)) {
      const int together = least(a.whole_back_from(m), b.whole_back_from(m));
      for (const int end = greatest(m - together, -1); m > end; --m) {
        a.template substitute<true>(m);
        if constexpr (kBlocks == 2) b.template substitute<true>(m);
      }
    } else {
      a.whole(m) ? a.template substitute<true>(m) : a.template substitute<false>(m);
      if constexpr (kBlocks == 2)
        b.whole(m) ? b.template substitute<true>(m) : b.template substitute<false>(m);
      --m;
    }
  }
  a.end();
  if constexpr (kBlocks == 2) b.end();
}

template <LineLaw kLaw, bool kLambda, bool kFirst>
void solve(const LineBatch& p, int step) {
  const int lines = least(kBatchLines, p.columns - p.first);
  for (int first = 0; first < lines;) {
    const bool two = kLanes >= 8 && lines - first > kLanes;
    two ? solve_blocks<kLaw, kLambda, kFirst, 2>(p, first, step)
        : solve_blocks<kLaw, kLambda, kFirst, 1>(p, first, step);
    first += two ? 2 * kLanes : kLanes;
  }
}

template <LineLaw kLaw>
void solve_lines(const LineBatch& p) {
  const int steps = kLaw == LineLaw::length ? 1 : p.steps;
  for (int step = 0; step < steps; ++step) {
    if (p.first_corrections && step == 0)
      p.lambda ? solve<kLaw, true, true>(p, step) : solve<kLaw, false, true>(p, step);
    else
      p.lambda ? solve<kLaw, true, false>(p, step) : solve<kLaw, false, false>(p, step);
  }
}

}  // namespace
}  // namespace weft::WEFT_KERNELS
