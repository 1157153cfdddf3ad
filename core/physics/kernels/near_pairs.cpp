// The pair search of self-collision: who of many candidates is within a range of a particle, tested
// in whole groups; and how far the particles of a row have moved apart.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

int near_pairs(const physics::NearCell& given) {
  const physics::NearCell c = given;
  std::int32_t* out = c.hits;
  for (int m = 0; m < c.member_count; ++m) {
    const Wide3 p = wide3(c.members.x[m], c.members.y[m], c.members.z[m]);
    std::int32_t* const first = out;
    for (int i = 0; i < padded(c.candidate_count); i += kLanes) {
      const Wide3 d = load3(c.candidates, i) - p;
      for (unsigned near = bits(dot(d, d) < c.range_squared); near != 0; near &= near - 1)
        *out++ = i + __builtin_ctz(near);
    }
    c.counts[m] = std::int32_t(out - first);
  }
  return int(out - c.hits);
}

void spread(ConstRow3 a, ConstRow3 b, int columns, physics::Spread& s) {
  Wide3 low = wide3(s.low[0], s.low[1], s.low[2]), high = wide3(s.high[0], s.high[1], s.high[2]);
  for (int i = 0; i < padded(columns); i += kLanes) {
    const WideInt inside = lanes_below(columns - i);
    Wide3 d = load3(a, i);
    if (b.x) d = d - load3(b, i);
    low = {min(low.x, select(inside, d.x, low.x)), min(low.y, select(inside, d.y, low.y)),
           min(low.z, select(inside, d.z, low.z))};
    high = {max(high.x, select(inside, d.x, high.x)), max(high.y, select(inside, d.y, high.y)),
            max(high.z, select(inside, d.z, high.z))};
  }
  const Wide* lows[3] = {&low.x, &low.y, &low.z};
  const Wide* highs[3] = {&high.x, &high.y, &high.z};
  for (int k = 0; k < 3; ++k) {
    s.low[k] = least(*lows[k]);
    s.high[k] = greatest(*highs[k]);
  }
}

}  // namespace weft::WEFT_KERNELS
