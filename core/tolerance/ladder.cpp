// Richardson's estimate (ladder.h).
#include "tolerance/ladder.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace weft::tolerance {
namespace {

// Times as fine as the finest rung: where the order seen was of the second and what follows is of the first, an error
// is told half as great as it is.
constexpr double kFarthest = 2;
constexpr double kSafety = 1.25;  // of errors of what was not run

}  // namespace

void Ladder::add(Motion motion) {
  if (++rungs_ > 1) {
    apart_before_ = apart_;
    apart_ = distance(finest_, motion);
    order_before_ = order_;
    const double seen = rungs_ < 3 || !std::isfinite(apart_before_) ? kLowOrder
                        : apart_ > 0 ? std::log2(apart_before_ / apart_)
                                     : most_;
    order_ = std::clamp(seen, 0.0, double(most_));
  }
  finest_ = std::move(motion);
}

double Ladder::order() const {
  return rungs_ < 4 ? order_ : std::min(order_, order_before_);
}

double Ladder::error(double times) const {
  if (rungs_ < 2) return std::numeric_limits<double>::infinity();
  const double p = std::max(order(), kLowOrder);
  return apart_ / (std::exp2(p) - 1) * std::pow(times, -p);
}

std::optional<double> Ladder::needed(double asked) const {
  if (!std::isfinite(error())) return {};
  const double p = std::max(order(), kLowOrder);
  if (error(0.5) <= asked) return 0.5;
  if (error() <= asked) return std::pow(error() / asked, 1 / p);
  const double times = std::pow(kSafety * error() / asked, 1 / p);
  if (rungs_ < 3 || !falls() || times > kFarthest) return {};
  return times;
}

}  // namespace weft::tolerance
