// The pair search of self-collision: who of many candidates is within a range of a particle, tested
// in whole groups; and how far the particles of a row have moved apart.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

// Brings the runs' particles together, so that every member tests them in whole groups; returns how
// many. The last group is filled up with particles far away.
WEFT_INLINE int bring_together(const physics::NearCell& c) {
  typedef WideInt Loose __attribute__((aligned(4), may_alias));
  int count = 0;
  for (int r = 0; r < c.run_count; ++r) {
    const int first = c.runs[r].first, size = c.runs[r].last - first;
    for (int i = 0; i < size; i += kLanes) {
      store3(c.candidates, count + i, load3(c.sorted, first + i));
      store(c.columns + count + i, load(c.column + first + i));
      store(c.rows + count + i, load(c.row + first + i));
      *reinterpret_cast<Loose*>(c.numbers + count + i) = lane_numbers() + (first + i);
    }
    count += size;
  }
  for (int i = 0; i < 16; i += kLanes)
    store(c.candidates.x + count + i, wide(1e18f));  // its square is still finite
  return count;
}

}  // namespace

void near_pairs(const physics::NearCell& given) {
  const physics::NearCell c = given;
  const int count = bring_together(c);
  std::int32_t* out = c.hits;
  for (int m = c.members.first; m < c.members.last; ++m) {
    const Wide3 p = wide3(c.sorted.x[m], c.sorted.y[m], c.sorted.z[m]);
    const physics::RestMetric rest = c.metric[c.sheet[m]];
    std::int32_t* const first = out;
    for (int i = 0; i < padded(count); i += kLanes) {
      const Wide3 d = load3(c.candidates, i) - p;
      const WideInt close = dot(d, d) < c.range_squared;
      if (!any(close)) continue;
      const Wide a = load(c.columns + i) - c.column[m], b = load(c.rows + i) - c.row[m];
      const Wide apart = a * a * rest.uu + 2.0f * (a * b) * rest.uv + b * b * rest.vv;
      for (unsigned near = bits(close & (apart >= rest.range_squared)); near != 0; near &= near - 1)
        *out++ = c.numbers[i + __builtin_ctz(near)];
    }
    c.counts[m - c.members.first] = std::int32_t(out - first);
  }
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
