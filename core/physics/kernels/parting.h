// Two blocks of lanes, parted into those that come first of every pair and those that come second.
#pragma once

#include <utility>

#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

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

  // Lanes of the two blocks that lanes l of the near ends come from; their far ends lie N lanes on.
  template <class Lanes>
  WEFT_INLINE static constexpr Lanes place(Lanes l) {
    return l / N * (2 * N) + l % N;
  }

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
