// Richardson's estimate: what runs of ever finer substeps or grids, each twice as fine as the one before, tell of their
// errors. With e(h) = C h^p two successive ones are e(h) - e(h/2) = (2^p - 1) e(h/2) apart.
#pragma once

#include <algorithm>
#include <optional>

#include "tolerance/trial_run.h"

namespace weft::tolerance {

class Ladder {
 public:
  // `order`: p at its greatest. `least`: below it errors do not fall, be it by chance.
  explicit Ladder(int order, double least = kLowOrder) : most_(order), least_(least) {}

  // Twice as fine as the one before.
  void add(Motion motion);

  const Motion& finest() const { return finest_; }
  int rungs() const { return rungs_; }
  // The lesser of the last two orders seen, as far as there are so many: where fast motion is smoothed away an error
  // may hardly fall for a while after it has fallen fast. With two rungs none is seen, and a low one is taken.
  double order() const;
  // Not so where neither of the last two orders is one: what the next rung adds may be as much as what the last did.
  bool falls() const {
    return rungs_ < 3 || std::max(order_, rungs_ < 4 ? order_ : order_before_) > least_;
  }
  // m; of something so many times as fine as the finest rung.
  double error(double times = 1) const;
  // How many times as fine as the finest rung something has to be that has this error: from 1/2, the rung before, to
  // 2. None where what was seen does not tell.
  std::optional<double> needed(double error) const;

 private:
  static constexpr double kLowOrder = 0.5;

  int most_;
  double least_;
  Motion finest_;
  int rungs_ = 0;
  // m; of the two last rungs, of the two before; the last order and the one before.
  double apart_ = 0, apart_before_ = 0, order_ = kLowOrder, order_before_ = kLowOrder;
};

}  // namespace weft::tolerance
