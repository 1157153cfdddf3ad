// Constraints that are too long end.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

WEFT_INLINE WideInt too_long(const physics::TearRow& r, int a) {
  const Wide3 e = load3(r.far, a) - load3(r.near, a);
  return lanes_at(r.alive + a) & (dot(e, e) > r.longest * r.longest);
}

}  // namespace

int tear(const physics::TearRow& given) {
  const physics::TearRow r = given;
  // Mostly there are none: one question for the whole row.
  WideInt some{};
  for (int a = 0; a < padded(r.count); a += kLanes) some |= too_long(r, a);
  if (!any(some)) return 0;
  int torn = 0;
  for (int a = 0; a < padded(r.count); a += kLanes) {
    const WideInt over = too_long(r, a);
    put_lanes(r.alive + a, lanes_at(r.alive + a) & ~over);
    torn += __builtin_popcount(bits(over));
  }
  return torn;
}

}  // namespace weft::WEFT_KERNELS
