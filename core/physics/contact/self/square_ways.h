// How far squares have come, at most: interval by interval, ways are added up. Two squares that were d apart are no
// nearer than d - w after ways whose sum is w, so that a pair need not be looked at before its squares have come so
// far together: it sleeps. (Conservative advancement: Mirtich 1996; lists with such bounds: Verlet 1967.)
//
// A square's way is that of its farthest corner, against what is common to all motion. For two that share a corner it
// is enough how far the corners of each come from each other.
#pragma once

#include <vector>

#include "physics/kernels/surface.h"

namespace weft::physics {

// Of every square, all that was added up, and what of it is of the last interval [m].
struct Ways {
  std::vector<float> all, last;
  float of_last(std::int32_t a, std::int32_t b) const {
    return last[std::size_t(a)] + last[std::size_t(b)];
  }
  // Until when two squares sleep that come no nearer than what is asked before they have come so much farther.
  float until(std::int32_t a, std::int32_t b, float farther) const {
    return (all[std::size_t(a)] + all[std::size_t(b)] + farther) * kRoundedDown;
  }
};

class SquareWays {
 public:
  // When a pair is looked at, in ways: at once, as one that has slept or is new; or always, as one that is near.
  static constexpr float kAtOnce = -1, kAlways = 0;

  SquareWays(const std::vector<Square>& squares, std::size_t bodies);

  // All have come nowhere, and no pair sleeps.
  void forget();
  // Ways that have become so long that rounding would tell are to be forgotten.
  bool too_long() const { return longest_ > kLongest; }
  // Chooses what is common to all motion in an interval.
  void begin(const Displacement* moved);
  // Adds the way of a square in the interval. Several squares may be added at once.
  void add(std::size_t square, const Displacement* moved);
  // All squares are added.
  void end();
  // A body was put elsewhere between two intervals [m].
  void shift(std::int32_t body, float way);

  const Ways& anywhere() const { return anywhere_; }
  const Ways& beside() const { return beside_; }
  std::size_t bytes() const { return 16 * anywhere_.all.size() + 8 * shift_.size(); }

 private:
  // Ways count so much more: what a sleeping pair comes nearer in an interval is then so little of its distance that
  // it cannot pass either (passing.cpp), whatever contact changes by less than kMostChange.
  static constexpr float kMargin = 1.2f;
  static constexpr float kLongest = 4;  // m, where rounding is a micrometre

  const std::vector<Square>& squares_;
  Ways anywhere_, beside_;
  std::vector<float> shift_;           // m, of every body,
  std::vector<std::int32_t> shifted_;  // and those where it is not 0
  float common_[4] = {};               // m
  float longest_ = 0;                  // m
};

}  // namespace weft::physics
