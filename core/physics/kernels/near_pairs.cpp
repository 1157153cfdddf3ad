// The pair search of self-collision: who of many candidates is within a range of a particle. The
// candidates of a cell are brought together first, those alone that are within the range of the box
// about its members, so that each of these tests few and whole groups.
#include "physics/kernels/contact.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::kNearPadding;
using physics::NearFound;
using physics::NearRoom;
using physics::NearSearch;
using physics::Run;

struct Runs {
  Run run[18];
  int count = 0, candidates = 0;
};

WEFT_INLINE Runs runs_about(const NearSearch& s, std::int64_t bucket) {
  Runs r;
  const auto add = [&](std::int64_t from, std::int64_t to) {
    const Run run{s.start[from], s.start[to]};
    r.run[r.count] = run;
    r.count += run.first < run.last;
    r.candidates += run.last - run.first;
  };
  for (const std::int64_t offset : s.offset) {
    std::int64_t from = bucket + offset;
    if (from >= s.table) from -= s.table;
    if (from + 3 <= s.table) {
      add(from, from + 3);
    } else {
      add(from, s.table);
      add(0, from + 3 - s.table);
    }
  }
  return r;
}

typedef WideInt LooseInt __attribute__((aligned(4), may_alias));

// From a box to points outside, axis by axis. Rounding keeps it no longer than from any point inside.
WEFT_INLINE Wide outside(Wide x, float low, float high) {
  return max(max(low - x, x - high), Wide{});
}

// The runs' particles within the range of the sorted ones from `begin` to `end`, next to each other
// in the room; the last group is filled up with some far away. Returns how many.
WEFT_INLINE int bring_together(const NearSearch& s, const Runs& runs, int begin, int end) {
  float low[3], high[3];
  const float* const x[3] = {s.x.x, s.x.y, s.x.z};
  for (int k = 0; k < 3; ++k) {
    low[k] = high[k] = x[k][begin];
    for (int m = begin + 1; m < end; ++m) {
      low[k] = x[k][m] < low[k] ? x[k][m] : low[k];
      high[k] = x[k][m] > high[k] ? x[k][m] : high[k];
    }
  }
  const NearRoom& room = s.room;
  int count = 0;
  for (int r = 0; r < runs.count; ++r) {
    const int last = runs.run[r].last;
    for (int i = runs.run[r].first; i < last; i += kLanes) {
      const Wide3 p = load3(s.x, i);
      const Wide3 d{outside(p.x, low[0], high[0]), outside(p.y, low[1], high[1]),
                    outside(p.z, low[2], high[2])};
      const WideInt kept = (dot(d, d) < s.range_squared) & lanes_below(last - i);
      store_lanes(room.x.x + count, kept, p.x);
      store_lanes(room.x.y + count, kept, p.y);
      store_lanes(room.x.z + count, kept, p.z);
      store_lanes(room.u + count, kept, load(s.u + i));
      store_lanes(room.w + count, kept, load(s.w + i));
      count += store_lanes(room.number + count, kept, lane_numbers() + i);
    }
  }
  for (int i = 0; i < 16; i += kLanes)
    store(room.x.x + count + i, wide(1e18f));  // its square is still finite
  return count;
}

// The numbers of those near particle m, the nearer ones first; returns how many.
WEFT_INLINE int near_one(const NearSearch& s, int candidates, int m, std::int32_t* hits) {
  const Wide3 p = wide3(s.x.x[m], s.x.y[m], s.x.z[m]);
  const Wide u = wide(s.u[m]), w = wide(s.w[m]), apart = wide(s.apart_squared[m]);
  int found = 0, farther = 0;
  for (int i = 0; i < candidates; i += kLanes) {
    const Wide3 d = load3(s.room.x, i) - p;
    const Wide square = dot(d, d);
    const Wide a = load(s.room.u + i) - u, b = load(s.room.w + i) - w;
    const WideInt pair = (square < s.range_squared) & (a * a + b * b >= apart);
    const WideInt number = *reinterpret_cast<const LooseInt*>(s.room.number + i);
    found += store_lanes(hits + found, pair & (square < s.near_squared), number);
    farther += store_lanes(s.room.farther + farther, pair & (square >= s.near_squared), number);
  }
  for (int i = 0; i < farther; i += kLanes)
    *reinterpret_cast<LooseInt*>(hits + found + i) =
        *reinterpret_cast<const LooseInt*>(s.room.farther + i);
  return found + farther;
}

}  // namespace

NearFound near_pairs(const NearSearch& given) {
  const NearSearch s = given;
  int found = 0;
  for (int m = s.begin; m < s.end;) {
    const std::int32_t bucket = s.bucket[m];
    const Runs runs = runs_about(s, bucket);
    const int needed = runs.candidates + kNearPadding;
    if (s.room.size < needed) return {m, found, needed};
    int end = m + 1;
    while (end < s.end && s.bucket[end] == bucket) ++end;
    const int near = runs.candidates > 1 ? bring_together(s, runs, m, end) : 0;
    for (; m < end; ++m) {
      if (s.hits_room - found < needed) return {m, found, needed};
      s.counts[m] = near > 1 ? near_one(s, near, m, s.hits + found) : 0;
      found += s.counts[m];
    }
  }
  return {s.end, found, 0};
}

}  // namespace weft::WEFT_KERNELS
