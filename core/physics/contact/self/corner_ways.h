// How far the corners of a grid's squares have come from each other, at most: interval by interval, ways are added up.
// Two squares that share a corner and were d apart otherwise are no nearer than d - w after ways whose sum is w, so that
// a pair need not be looked at before its squares have come so far together: it sleeps. (Conservative advancement:
// Mirtich 1996; lists with such bounds: Verlet 1967.)
#pragma once

#include <vector>

#include "physics/kernels/kernels.h"
#include "physics/kernels/surface.h"

namespace weft::physics {

class CornerWays {
 public:
  // When a pair is looked at, in ways: at once, as one that has slept or is new; or always, as one that is near.
  static constexpr float kAtOnce = -1, kAlways = 0;
  static constexpr float kLongest = 4;  // m, where rounding of ways is a micrometre

  CornerWays(const std::vector<Square>& squares, const KernelTable& kernels);

  // All have come nowhere, and no pair sleeps.
  void forget();
  // Ways have become so long that rounding would tell: they are to be forgotten.
  bool too_long() const;
  // Adds the ways of so many squares from one on in an interval. Several may be added at once.
  void add(std::size_t first, int count, const Displacement* moved);
  // A corner was put elsewhere between two intervals [m].
  void shift(std::size_t square, float way) { all_[square] += 2 * way; }

  // Of every square, all that was added up [m].
  const float* all() const { return all_.data(); }
  // What of it is of the last interval, of a pair [m].
  float of_last(std::int32_t a, std::int32_t b) const {
    return last_[std::size_t(a)] + last_[std::size_t(b)];
  }
  // Until when two squares sleep that come no nearer than what is asked before they have come so much farther.
  float until(std::int32_t a, std::int32_t b, float farther) const {
    return (all_[std::size_t(a)] + all_[std::size_t(b)] + farther) * kRoundedDown;
  }
  std::size_t bytes() const { return 8 * all_.size(); }

 private:
  const std::vector<Square>& squares_;
  const KernelTable& kernels_;
  std::vector<float> all_, last_;  // of every square, and of kPacket more
};

}  // namespace weft::physics
