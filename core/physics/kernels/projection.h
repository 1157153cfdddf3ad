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
  Row3 x, u;
  const float* w;
};

// Lane a of the result is an end of constraint a.
WEFT_INLINE ProjectedRow projected_row(const ProjectRows& p, int j, int first) {
  const std::ptrdiff_t at = std::ptrdiff_t(j) * p.stride + first;
  return {{p.x.x + at, p.x.y + at, p.x.z + at},
          p.u.x ? Row3{p.u.x + at, p.u.y + at, p.u.z + at} : Row3{},
          p.w + at};
}

template <bool Displaced>
WEFT_INLINE Wide3 position(const ProjectedRow& r, std::ptrdiff_t i) {
  if constexpr (Displaced) return load3(r.x, i) + load3(r.u, i);
  return load3(r.x, i);
}

template <bool Displaced>
WEFT_INLINE void shift(const ProjectedRow& r, std::ptrdiff_t i, Wide3 change) {
  const Row3& moved = Displaced ? r.u : r.x;
  store3(moved, i, load3(moved, i) + change);
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

// The scales of e that move the near ends of K blocks of constraints by e times it.
template <bool Multipliers, int K>
WEFT_INLINE void scales_alike(const Alike& c, const Wide3* e, Wide* lambda, Wide* scale) {
  Wide squared[K], reciprocal[K];
  for (int k = 0; k < K; ++k) squared[k] = squared_length(e[k]);
  reciprocal_roots<K>(squared, reciprocal);
  for (int k = 0; k < K; ++k) {
    if constexpr (!Multipliers) {
      scale[k] = fnma(wide(c.kl), reciprocal[k], wide(c.k));
    } else {
      const Wide violation = fms(squared[k], reciprocal[k], wide(c.rest));
      const Wide change = fma(wide(c.compliance), lambda[k], violation) * c.inverse_inertia;
      lambda[k] = lambda[k] - change;
      scale[k] = (change * c.w) * reciprocal[k];
    }
  }
}

// Constraints (i, i+N) of one colour along a row fill every other group of N lanes. Two blocks of
// lanes are parted into near and far ends, solved without a lane idle, and woven together again.
template <int N>
struct Parting {
  Wide near, far;
  WEFT_INLINE Parting() : near{}, far{} {}
  WEFT_INLINE explicit Parting(const float* p) : Parting(load(p), load(p + kLanes)) {}
  WEFT_INLINE Parting(Wide first, Wide second)
      : Parting(first, second, std::make_integer_sequence<int, kLanes>{}) {}
  WEFT_INLINE void weave(float* p) const { weave(p, std::make_integer_sequence<int, kLanes>{}); }

  // Number of the constraint in lane l of the near ends, counted from the first lane of the blocks.
  WEFT_INLINE static WideInt numbers() {
    const WideInt l = lane_numbers();
    return l / N * (2 * N) + l % N;
  }

 private:
  // Lane l of the near ends lies in lane place(l) of the two blocks, its far end N lanes on.
  static constexpr int place(int l) { return l / N * 2 * N + l % N; }
  // Lane m of the two blocks holds near end index(m), or kLanes + far end.
  static constexpr int index(int m) {
    return m / (2 * N) * N + m % N + (m / N % 2 == 0 ? 0 : kLanes);
  }
  template <int... L>
  WEFT_INLINE Parting(Wide a, Wide b, std::integer_sequence<int, L...>)
      : near(__builtin_shufflevector(a, b, place(L)...)),
        far(__builtin_shufflevector(a, b, (place(L) + N)...)) {}
  template <int... L>
  WEFT_INLINE void weave(float* p, std::integer_sequence<int, L...>) const {
    store(p, __builtin_shufflevector(near, far, index(L)...));
    store(p + kLanes, __builtin_shufflevector(near, far, index(L + kLanes)...));
  }
};

}  // namespace weft::WEFT_KERNELS
