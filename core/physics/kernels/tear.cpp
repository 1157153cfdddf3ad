// Constraints that are too long end.
#include "physics/kernels/tear.h"

#include "physics/kernels/gather.h"

namespace weft::WEFT_KERNELS {

namespace {

WEFT_INLINE Wide3 edge(const physics::TearEnds& ends, int a) {
  return load3(ends.far, a) - load3(ends.near, a);
}

template <bool kMoved>
WEFT_INLINE WideInt too_long(const physics::TearRow& r, int a) {
  Wide3 e = edge(r.x, a);
  if constexpr (kMoved) e = fma(edge(r.moved[0], a) + edge(r.moved[1], a), wide(0.5f), e);
  return lanes_at(r.alive + a) & (dot(e, e) > r.longest * r.longest);
}

template <bool kMoved>
int tear_row(const physics::TearRow& r) {
  // Mostly there are none: one question for the whole row.
  WideInt some{};
  for (int a = 0; a < padded(r.count); a += kLanes) some |= too_long<kMoved>(r, a);
  if (!any(some)) return 0;
  int torn = 0;
  for (int a = 0; a < padded(r.count); a += kLanes) {
    const WideInt over = too_long<kMoved>(r, a);
    put_lanes(r.alive + a, lanes_at(r.alive + a) & ~over);
    torn += __builtin_popcount(bits(over));
  }
  return torn;
}

}  // namespace

int tear(const physics::TearRow& given) {
  const physics::TearRow r = given;
  return r.moved ? tear_row<true>(r) : tear_row<false>(r);
}

bool tear_edges(const physics::TearEdges& r) {
  unsigned some = 0;
  for (int n = 0; n < r.count; ++n) {
    const physics::TearBatch& b = r.batches[n];
    unsigned over = 0;
    for (int lane = 0; lane < physics::kTearBatch; lane += kLanes) {
      const Wide3 e = gathered(r.x, b.far + lane) - gathered(r.x, b.near + lane);
      over |= unsigned(bits(dot(e, e) > load(b.longest + lane))) << lane;
    }
    r.overlong[n] = std::uint16_t(over);
    some |= over;
  }
  return some != 0;
}

}  // namespace weft::WEFT_KERNELS
