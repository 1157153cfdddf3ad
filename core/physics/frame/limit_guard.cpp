// Strain limits and the substeps that hold them (limit_guard.h).
#include "physics/frame/limit_guard.h"

#include <algorithm>

namespace weft::physics {
namespace {

// Of a limit: strain beyond it that is let be, as where a load has just come; and with which a limit holds well.
constexpr double kLetBe = 0.1, kHeld = 0.03;
constexpr double kCured = 0.7;  // of what was beyond: more is left where finer substeps do not help
constexpr int kFinest = 8, kFramesHeld = 10, kFramesHopeless = 60;

// The greatest strain of a cloth beyond its limit, of the limit.
double greatest_excess(const Cloths& cloths, const Sleeping* sleeping) {
  double excess = 0;
  for (std::size_t c = 0; c < cloths.size(); ++c) {
    const Cloth& cloth = cloths[c]->cloth();
    if (cloth.strain_limit == 0 || cloth.strain_limit_order == StrainLimitOrder::course ||
        is_asleep(sleeping, c))
      continue;
    excess = std::max(excess, cloths[c]->model().limited_strain() / cloth.strain_limit - 1);
  }
  return excess;
}

}  // namespace

bool LimitGuard::asks_again(const Cloths& cloths, const Sleeping* sleeping) {
  excess_ = greatest_excess(cloths, sleeping);
  if (again_ && excess_ > kCured * before_ && excess_ > kLetBe) {
    hopeless_ = kFramesHopeless;
    return false;
  }
  if (excess_ <= kLetBe || hopeless_ > 0 || finer_ == kFinest) return false;
  again_ = true;
  before_ = excess_;
  finer_ *= 2;
  return true;
}

bool LimitGuard::accept() {
  again_ = false;
  held_ = excess_ > kHeld ? 0 : held_ + 1;
  hopeless_ = std::max(0, hopeless_ - 1);
  const bool longer = finer_ > 1 && (held_ >= kFramesHeld || hopeless_ == kFramesHopeless - 1);
  if (!longer) return false;
  finer_ /= 2;
  held_ = 0;
  return true;
}

}  // namespace weft::physics
