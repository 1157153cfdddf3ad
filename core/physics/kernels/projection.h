// What the projection kernels share: where the ends of constraints lie, and their moves.
//
// The sweeps of method `positional` move the positions themselves. Those of `compliant` gather the
// corrections u in arrays of their own and see positions x + u: a velocity must gain just what the
// sweeps have moved a particle by, and the difference of rounded positions over a small dt is not
// that. `Displaced` tells the two apart.
#pragma once

#include <cstddef>

#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

struct ProjectedRow {
  float *x, *u;          // first component
  std::ptrdiff_t plane;  // floats from one component to the next
  const float* w;
};

// Lane a of the result is an end of constraint a.
WEFT_INLINE ProjectedRow projected_row(const ProjectRows& p, int j, int first) {
  const std::ptrdiff_t at = std::ptrdiff_t(j) * p.stride + first;
  return {p.x.x + at, p.u.x ? p.u.x + at : nullptr, p.x.y - p.x.x, p.w + at};
}

template <bool Displaced>
WEFT_INLINE Wide3 position(const ProjectedRow& r, std::ptrdiff_t i) {
  if constexpr (Displaced) return load_planes(r.x + i, r.plane) + load_planes(r.u + i, r.plane);
  return load_planes(r.x + i, r.plane);
}

// What the sweeps change.
template <bool Displaced>
WEFT_INLINE float* movable(const ProjectedRow& r) {
  return Displaced ? r.u : r.x;
}

template <bool Displaced>
WEFT_INLINE void shift(const ProjectedRow& r, std::ptrdiff_t i, Wide3 change) {
  float* const at = movable<Displaced>(r) + i;
  store_planes(at, r.plane, load_planes(at, r.plane) + change);
}

// Constraints a … of row j that are not torn.
WEFT_INLINE WideInt alive_lanes(const ProjectRows& p, int j, int a) {
  return lanes_at(p.alive + std::ptrdiff_t(j) * p.stride + a);
}

// Constraints between particles of the same inverse mass w: half of what a correction computes is
// then known beforehand.
//
//   w Δλ/|e| = κ (1 - l/|e|),  κ = w/(2w + α̃)         or, with multipliers,
//   Δλ = (|e| - l + α̃ λ)/(2w + α̃)
struct Alike {
  float k, kl;  // κ and κ l [m]
  float rest, compliance, inverse_inertia, w;
};

WEFT_INLINE float compliance_at(const ProjectRows& p, int j) {
  return p.compliance ? p.compliance[j] : 0;
}

WEFT_INLINE Alike alike(const ProjectRows& p, int j, float w) {
  const float compliance = compliance_at(p, j);
  const float inertia = 2 * w * p.weight + compliance;
  const float k = w / inertia;
  return {k, k * p.rest, p.rest, compliance, 1 / inertia, w};
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
    return b;
}

// The last N lanes of a, followed by the first of b: of every group of kGroup lanes.
template <int N, int kGroup, int... L>
WEFT_INLINE Wide preceding(Wide a, Wide b, std::integer_sequence<int, L...>) {
  constexpr auto from = [](int l) { return l % kGroup < N ? l + kGroup - N : kLanes + l - N; };
  return __builtin_shufflevector(a, b, from(L)...);
}
template <int N, int kGroup = kLanes>
WEFT_INLINE Wide preceding(Wide a, Wide b) {
  if constexpr (kLanes > 1)
    return preceding<N, kGroup>(a, b, std::make_integer_sequence<int, kLanes>{});
  else
    return a;
}

// Constraints (i, i+N) of one colour along a row fill every other group of N lanes. Two blocks of
// lanes are parted into near and far ends, solved without a lane idle, and woven together again.
template <int N>
struct Parting {
  Wide near, far;
  WEFT_INLINE Parting() : near{}, far{} {}
  WEFT_INLINE Parting(Wide first, Wide second)
      : Parting(first, second, std::make_integer_sequence<int, kLanes>{}) {}
  WEFT_INLINE Wide first() const { return woven<0>(std::make_integer_sequence<int, kLanes>{}); }
  WEFT_INLINE Wide second() const {
    return woven<kLanes>(std::make_integer_sequence<int, kLanes>{});
  }

  // Lane of the two blocks that lane l of the near ends comes from; its far end lies N lanes on.
  static constexpr int place(int l) { return l / N * 2 * N + l % N; }

 private:
  // Lane m of the two blocks holds near end index(m), or kLanes + far end.
  static constexpr int index(int m) {
    return m / (2 * N) * N + m % N + (m / N % 2 == 0 ? 0 : kLanes);
  }
  template <int... L>
  WEFT_INLINE Parting(Wide a, Wide b, std::integer_sequence<int, L...>)
      // One lane alone is an end whatever N is, and its index without meaning.
      : near(kLanes > 1 ? __builtin_shufflevector(a, b, (place(L) % (2 * kLanes))...) : a),
        far(kLanes > 1 ? __builtin_shufflevector(a, b, ((place(L) + N) % (2 * kLanes))...) : b) {}
  template <int kFirst, int... L>
  WEFT_INLINE Wide woven(std::integer_sequence<int, L...>) const {
    if constexpr (kLanes == 1) return kFirst ? far : near;
    return __builtin_shufflevector(near, far, (index(L + kFirst) % (2 * kLanes))...);
  }
};

}  // namespace weft::WEFT_KERNELS
