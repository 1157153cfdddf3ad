// Motions of points as samples, between which they go straight.
#pragma once

#include <functional>
#include <vector>

#include "weft/point_cache.h"

namespace weft::text {

struct SampledMotion {
  std::vector<float> times;  // s, increasing
  double off = 0;  // the greatest distance of a straight way from the motion that was found
};

// Chooses the times at which samples of a motion are taken: at its knots, between which it is smooth, and wherever a
// point that goes straight from sample to sample comes farther than `tolerance` from its way: at a quarter, the
// middle or three quarters of the time between them. Of the intervals that do not hold, the worst is halved first,
// until all hold, there are `most` samples, or they are 1e-4 s apart, below which rounding of places would be speed.
// Knots that are closer are left out, but the last; where there are more than `most`, they are all that is told. `knots`: one at
// least, not negative; `at`: where all points are at a time.
SampledMotion choose_samples(std::vector<double> knots, double tolerance, std::size_t most,
                             const std::function<std::vector<Vec3>(double time)>& at);

}  // namespace weft::text
