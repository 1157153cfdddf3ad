// Gauss–Seidel over rows whose inner particles all have one inverse mass, no constraint of which is torn:
// every row without a pin. Half of the equation is then known beforehand, and what is left waits more than it
// computes: these kernels see to it that little has to be waited for.
#pragma once

#include <cstddef>
#include <utility>

#include "physics/kernels/parting.h"
#include "physics/kernels/projection.h"

namespace weft::WEFT_KERNELS {

// Constraints between particles of the same inverse mass w: half of what a correction computes is
// then known beforehand.
//
//   w Δλ/|e| = κ (1 - l/|e|),  κ = w/(2w + α̃)         or, with multipliers,
//   Δλ = (|e| - l + α̃ λ)/(2w + α̃)
//
// Particles at the sides may weigh half. Along the columns there, compliance is twice as much, too, and all
// is as elsewhere. Across them, Δλ has the share (2w + α̃)/(3w + α̃), or (2w + α̃)/(4w + α̃) where both ends
// lie at the sides, and those ends move by twice as much.
struct Alike {
  float k, kl;  // κ and κ l [m]
  float rest, compliance, inverse_inertia, w;
  bool sides;  // whether there are such ends
  float one_side, both_sides;
};

WEFT_INLINE float compliance_at(const ProjectRows& p, int j) {
  return p.compliance ? p.compliance[j] : 0;
}

WEFT_INLINE Alike alike(const ProjectRows& p, int j, float w) {
  const float compliance = compliance_at(p, j);
  const float inertia = 2 * w * p.weight + compliance;
  const float k = w / inertia, more = w * p.weight;
  return {k,
          k * p.rest,
          p.rest,
          compliance,
          1 / inertia,
          w,
          p.side_by_side,
          inertia / (inertia + more),
          inertia / (inertia + 2 * more)};
}

// The scale of e that moves the near ends of a block of constraints by e times it.
template <bool kMultipliers>
WEFT_INLINE Wide scale_alike(const Alike& c, Wide3 e, Wide& lambda) {
  const Wide length = sqrt(squared_length(e)), reciprocal = 1.0f / length;
  if constexpr (!kMultipliers) return fnma(wide(c.kl), reciprocal, wide(c.k));
  const Wide violation = length - c.rest;
  const Wide change = fma(wide(c.compliance), lambda, violation) * c.inverse_inertia;
  lambda = lambda - change;
  return (change * c.w) * reciprocal;
}

// The scales that move the near and the far end, where some lie at the sides; takes back of lambda what is
// too much.
struct EndScales {
  Wide near, far;
};
template <bool kMultipliers>
WEFT_INLINE EndScales at_sides(const Alike& c, WideInt near, WideInt far, Wide scale, Wide before,
                               Wide& lambda) {
  const Wide share =
      select(near & far, wide(c.both_sides), select(near | far, wide(c.one_side), wide(1)));
  if constexpr (kMultipliers) lambda = fma(lambda - before, share, before);
  const Wide s = scale * share;
  return {select(near, s + s, s), select(far, s + s, s)};
}

// The lanes of a from lane N on, followed by the first N of b: of every group of kGroup lanes.
template <int N, int kGroup, int... L>
WEFT_INLINE Wide following(Wide a, Wide b, std::integer_sequence<int, L...>) {
  constexpr auto from = [](int l) {
    return l % kGroup + N < kGroup ? l + N : kLanes + l + N - kGroup;
  };
  return __builtin_shufflevector(a, b, from(L)...);
}
template <int N, int kGroup = kLanes>
WEFT_INLINE Wide following(Wide a, Wide b) {
  if constexpr (kLanes > 1)
    return following<N, kGroup>(a, b, std::make_integer_sequence<int, kLanes>{});
  else
    return N > 0 ? b : a;
}
// The last N lanes of a, followed by the others of b.
template <int N, int kGroup = kLanes>
WEFT_INLINE Wide preceding(Wide a, Wide b) {
  return following<kGroup - N, kGroup>(a, b);
}

// The constraints between rows j and j+dj, of one column or, as kNear and kFar say, from lane a+1 to a
// or a to a+1. Ends are loaded and stored in whole blocks, and their lanes
// shifted: a load has at hand what was stored a moment ago only if it wants those very bytes.
template <Rule R, int kNear, int kFar>
class BetweenRowsAlike {
 public:
  // For other offsets than 0 and 1, the ends lie `near` and `far` lanes on.
  WEFT_INLINE BetweenRowsAlike(const ProjectRows& p, int j, const Alike& c, int near, int far)
      : count_(p.count),
        c_(c),
        near_(projected_row(p, j, near)),
        far_(projected_row(p, j + p.dj, far)),
        leaning_left_(p.near > 0),
        lambdas_(p.lambda + std::ptrdiff_t(j) * p.stride) {}

  WEFT_INLINE void run() {
    const int end = count_ + (kNear | kFar);
    if constexpr (kShifted) next_ = corrected(kNear ? near_ : far_, 0);
    for (int a = 0; a < end; a += kLanes) block(a, end);
  }

 private:
  static constexpr bool kMultipliers = R == Rule::multipliers;
  static constexpr bool kShifted = kNear + kFar > 0;

  WEFT_INLINE Wide3 edge(int a, int end) {
    if constexpr (kShifted) {
      const Wide3 b = next_;
      if (a + kLanes < end) next_ = corrected(kNear ? near_ : far_, a + kLanes);
      const Wide3 shifted{following<1>(b.x, next_.x), following<1>(b.y, next_.y),
                          following<1>(b.z, next_.z)};
      const Wide3 other = corrected(kNear ? far_ : near_, a);
      return kNear ? other - shifted : shifted - other;
    }
    return corrected(far_, a) - corrected(near_, a);
  }

  WEFT_INLINE void block(int a, int end) {
    const Wide3 e = edge(a, end);
    Wide lambda{};
    if constexpr (kMultipliers) lambda = load(lambdas_ + a);
    const Wide before = lambda;
    Wide scale = scale_alike<kMultipliers>(c_, e, lambda);
    EndScales ends{scale, scale};
    if (c_.sides && (a == 0 || a + kLanes >= count_)) {
      const WideInt first = lane_numbers() == -a, last = lane_numbers() == count_ - 1 - a;
      ends = at_sides<kMultipliers>(c_, leaning_left_ ? last : first, leaning_left_ ? first : last,
                                    scale, before, lambda);
    }
    if (a + kLanes > count_) {
      const WideInt active = lanes_below(count_ - a);
      ends = {select(active, ends.near, Wide{}), select(active, ends.far, Wide{})};
      lambda = select(active, lambda, before);
    }
    if constexpr (kMultipliers) store(lambdas_ + a, lambda);
    Wide3 past_e;
    Wide past_scale;
    if constexpr (kShifted) {
      past_e = edges_.next(e);
      past_scale = scales_.next(kNear ? ends.near : ends.far);
    }
    float* const near = near_.u + a;
    float* const far = far_.u + a;
    const std::ptrdiff_t plane = near_.plane;
    store_planes(near, plane,
                 fma(kNear ? past_e : e, kNear ? past_scale : ends.near, load_planes(near, plane)));
    store_planes(far, plane,
                 fnma(kFar ? past_e : e, kFar ? past_scale : ends.far, load_planes(far, plane)));
  }

  const int count_;
  const Alike& c_;
  const ProjectedRow near_, far_;
  const bool leaning_left_;  // the far end lies to the left
  float* const lambdas_;
  Wide3 next_;  // positions of the shifted ends' next block
  Delay3<1> edges_;
  Delay<1> scales_;
};

// Both colours along row j, N lanes from end to end. Two blocks at a time take their first colour;
// the second, which reaches into the next two blocks, follows behind. The two blocks are neighbours in
// the row, or, with kRows, of the same lanes in rows j and j+1: which leaves fewer lanes idle.
template <Rule R, int N, bool kRows>
class AlongRowAlike {
 public:
  WEFT_INLINE AlongRowAlike(const ProjectRows& p, int j, const Alike& c)
      : c_(c),
        count_(p.count),
        row_(projected_row(p, j, 0)),
        lambdas_(p.lambda + std::ptrdiff_t(j) * p.stride),
        apart_(kRows ? p.stride : kNext) {}

  // Two pairs of blocks behind, so that neither colour waits for the other's roots.
  WEFT_INLINE void run() {
    for (int first = 0; first < kChains; ++first) {
      for (Wide& c : carried_) c = Wide{};
      run_from(first, count_ + N);
    }
  }

 private:
  // Lane by lane, a row is N chains whose links are N lanes long.
  static constexpr int kChains = kLanes == 1 ? N : 1, kNext = kLanes == 1 ? N : kLanes;
  static constexpr int kStep = kRows ? kLanes : 2 * kNext;    // lanes from pair to pair
  static constexpr int kGroup = kRows ? kLanes / 2 : kLanes;  // ends of one row
  static constexpr bool kMultipliers = R == Rule::multipliers;

  // Two blocks, parted: where their first colour has put them, by how much it has moved near ends, and how
  // many times as much the far ones, the other way.
  struct Blocks {
    Parting<N> at[3];
    Wide change[3];
    Wide ratio;
    Parting<N> lambda;
  };

  WEFT_INLINE void run_from(int a, int end) {
    Blocks last = first_colour(a), before{};
    a += kStep;
    if (a < end) {
      before = last;
      last = first_colour(a);
      for (a += kStep; a < end; a += kStep) {
        const Blocks now = first_colour(a);
        second_colour(before, last, a - 2 * kStep);
        before = last;
        last = now;
      }
      second_colour(before, last, a - 2 * kStep);
    }
    second_colour(last, Blocks{}, a - kStep);
  }

  WEFT_INLINE Parting<N> lambdas(int a) const {
    return {load(lambdas_ + a), load(lambdas_ + a + apart_)};
  }

  // What scales the edges e of one colour for the near ends, and how many times as much for the far ones. In
  // its row, the constraint of lane 0 has number a.
  WEFT_INLINE Wide scale(Wide3 e, Wide& lambda, int a, Wide& ratio) const {
    const Wide before = lambda;
    Wide s = scale_alike<kMultipliers>(c_, e, lambda);
    ratio = wide(1);
    if (c_.sides && (a == 0 || a + kStep >= count_)) {
      const WideInt place = Parting<N>::place(lane_numbers() % kGroup);
      const WideInt first = place == -a, last = place == count_ - 1 - a;
      s = at_sides<kMultipliers>(c_, first, last, s, before, lambda).near;
      ratio = select(first & ~last, wide(0.5f), select(last & ~first, wide(2), ratio));
    }
    if (a + kStep > count_) {
      const WideInt active = Parting<N>::place(lane_numbers() % kGroup) < count_ - a;
      s = select(active, s, Wide{});
      lambda = select(active, lambda, before);
    }
    return s;
  }

  WEFT_INLINE Blocks first_colour(int a) const {
    Blocks b;
    const Wide3 one = corrected(row_, a), two = corrected(row_, a + apart_);
    b.at[0] = {one.x, two.x};
    b.at[1] = {one.y, two.y};
    b.at[2] = {one.z, two.z};
    if constexpr (kMultipliers) b.lambda = lambdas(a);
    Wide e[3];
    for (int k = 0; k < 3; ++k) e[k] = b.at[k].far - b.at[k].near;
    const Wide s = scale({e[0], e[1], e[2]}, b.lambda.near, a, b.ratio);
    for (int k = 0; k < 3; ++k) {
      b.change[k] = e[k] * s;
      b.at[k].near = b.at[k].near + b.change[k];
      b.at[k].far = fnma(b.change[k], b.ratio, b.at[k].far);
    }
    return b;
  }

  // From the far ends of b, whose first lane is a, to the near ends that follow; stores b.
  WEFT_INLINE void second_colour(const Blocks& b, const Blocks& after, int a) {
    Wide e[3];
    for (int k = 0; k < 3; ++k)
      e[k] = following<N, kGroup>(b.at[k].near, after.at[k].near) - b.at[k].far;
    Parting<N> lambda = b.lambda;
    Wide ratio;
    const Wide s = scale({e[0], e[1], e[2]}, lambda.far, a + N, ratio);
    for (int k = 0; k < 3; ++k) {
      const Wide change = e[k] * s, far = change * ratio;
      const Wide back = preceding<N, kGroup>(carried_[k], far);
      carried_[k] = far;
      Parting<N> moved;
      moved.near = b.change[k] - back;
      moved.far = fnma(b.change[k], b.ratio, change);
      float* const at = row_.u + k * row_.plane + a;
      store(at, load(at) + moved.first());
      store(at + apart_, load(at + apart_) + moved.second());
    }
    if constexpr (kMultipliers) {
      store(lambdas_ + a, lambda.first());
      store(lambdas_ + a + apart_, lambda.second());
    }
  }

  const Alike& c_;
  const int count_;
  const ProjectedRow row_;
  float* const lambdas_;
  const std::ptrdiff_t apart_;  // floats from the first to the second block
  Wide carried_[3]{};
};

// One colour along row j for any other offset.
template <Rule R>
WEFT_INLINE void along_row_alike(const ProjectRows& p, int j, int colour, const Alike& c) {
  constexpr bool kMultipliers = R == Rule::multipliers;
  const ProjectedRow near = projected_row(p, j, 0), far = projected_row(p, j, p.far);
  const std::int32_t* const lanes = p.lanes + std::ptrdiff_t(colour) * p.stride;
  float* const lambdas = p.lambda + std::ptrdiff_t(j) * p.stride;
  LongDelay3 delay(p.far);
  for (int a = 0; a < p.count + p.far; a += kLanes) {
    const WideInt active = lanes_at(lanes + a);
    const Wide3 e = corrected(far, a) - corrected(near, a);
    Wide lambda{}, before{};
    if constexpr (kMultipliers) lambda = before = load(lambdas + a);
    const Wide scale = scale_alike<kMultipliers>(c, e, lambda);
    EndScales ends{scale, scale};
    if (c.sides)
      ends = at_sides<kMultipliers>(c, lane_numbers() == -a, lane_numbers() == p.count - 1 - a,
                                    scale, before, lambda);
    if constexpr (kMultipliers) store(lambdas + a, select(active, lambda, before));
    const Wide3 change = e * select(active, ends.near, Wide{});
    gather(near, a, change - delay.next(e * select(active, ends.far, Wide{})));
  }
}

// Row j of a stencil whose rows have one inverse mass and no torn constraints.
template <Rule R>
WEFT_INLINE void row_alike(const ProjectRows& p, int j, const Alike& c) {
  if (p.dj > 0) {
    if (p.near == 1) return BetweenRowsAlike<R, 1, 0>(p, j, c, 0, 0).run();
    if (p.far == 1) return BetweenRowsAlike<R, 0, 1>(p, j, c, 0, 0).run();
    return BetweenRowsAlike<R, 0, 0>(p, j, c, p.near, p.far).run();
  }
  if (p.far == 1) return AlongRowAlike<R, 1, false>(p, j, c).run();
  if (p.far == 2) return AlongRowAlike<R, 2, false>(p, j, c).run();
  for (int colour = 0; colour < 2; ++colour) along_row_alike<R>(p, j, colour, c);
}

// Rows j and j+1 at once of a stencil along rows, where that is possible.
template <Rule R>
WEFT_INLINE bool two_rows_alike(const ProjectRows& p, int j, const Alike& c) {
  if (kLanes == 1 || p.dj > 0 || p.far > 2) return false;
  if (p.row_w[j + 1] != c.w || compliance_at(p, j + 1) != c.compliance) return false;
  if constexpr (kLanes > 1) {
    if (p.far == 1)
      AlongRowAlike<R, 1, true>(p, j, c).run();
    else
      AlongRowAlike<R, 2, true>(p, j, c).run();
  }
  return true;
}

}  // namespace weft::WEFT_KERNELS
