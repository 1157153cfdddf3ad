// The pair search of self-collision: who of many candidates is within a range of a particle. The
// candidates of a cell with several members are brought together first, those alone that are within
// the range of the box about the members, so that each of these tests few and whole groups.
#include "physics/kernels/contact.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::kNearPadding;
using physics::NearFound;
using physics::NearRoom;
using physics::NearSearch;
using physics::Run;

constexpr int kFewMembers = 2;  // of a cell, for which its candidates stay where they are

struct Runs {
  Run run[18];
  int count = 0, candidates = 0;
};

// Of those from number `begin` on.
WEFT_INLINE Runs runs_about(const NearSearch& s, std::int64_t bucket, int begin) {
  Runs r;
  const auto add = [&](std::int64_t from, std::int64_t to) {
    const int first = s.start[from];
    const Run run{first > begin ? first : begin, s.start[to]};
    r.run[r.count] = run;
    r.count += run.first < run.last;
    r.candidates += run.first < run.last ? run.last - run.first : 0;
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

// Of the sorted particles from number i on.
WEFT_INLINE WideInt names_at(const NearSearch& s, int i) {
  return s.names ? lanes_at(s.names + i) : lane_numbers() + i;
}

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
      count += store_lanes(room.number + count, kept, names_at(s, i));
    }
  }
  for (int i = 0; i < 16; i += kLanes)
    store(room.x.x + count + i, wide(1e18f));  // its square is still finite
  return count;
}

// A particle, and where the numbers of those near it go.
struct Seeker {
  Wide3 p;
  Wide u, w, apart;
  std::int32_t m;
  std::int32_t* near;
  int found = 0;

  WEFT_INLINE Seeker(const NearSearch& s, int number, std::int32_t* to)
      : p(wide3(s.x.x[number], s.x.y[number], s.x.z[number])),
        u(wide(s.u[number])),
        w(wide(s.w[number])),
        apart(wide(s.apart_squared[number])),
        m(number),
        near(to) {}

  // Of kLanes candidates, those `asked`.
  template <bool kOnce>
  WEFT_INLINE void test(const NearSearch& s, Wide3 x, Wide at_u, Wide at_w, WideInt number,
                        WideInt asked) {
    const Wide3 d = x - p;
    const Wide a = at_u - u, b = at_w - w;
    WideInt pair = (dot(d, d) < s.range_squared) & (a * a + b * b >= apart) & asked;
    if constexpr (kOnce) pair &= number > m;
    found += store_lanes(near + found, pair, number);
  }
};

// The numbers of those near particle m among what was brought together; returns how many.
template <bool kOnce>
WEFT_INLINE int near_one(const NearSearch& s, int candidates, int m, std::int32_t* near) {
  Seeker seeker(s, m, near);
  const NearRoom& room = s.room;
  for (int i = 0; i < candidates; i += kLanes)
    seeker.test<kOnce>(s, load3(room.x, i), load(room.u + i), load(room.w + i),
                       lanes_at(room.number + i), WideInt{} - 1);
  return seeker.found;
}

// The same among the runs themselves, which are short: as many as fit share a group.
template <bool kOnce>
WEFT_INLINE int near_one(const NearSearch& s, const Runs& runs, int m, std::int32_t* near) {
  Seeker seeker(s, m, near);
  Wide3 x{};
  Wide u{}, w{};
  WideInt number{};
  int held = 0;
  const auto test = [&] {
    seeker.test<kOnce>(s, x, u, w, number, lanes_below(held));
    held = 0;
  };
  for (int r = 0; r < runs.count; ++r) {
    const int last = runs.run[r].last;
    for (int i = runs.run[r].first; i < last;) {
      const WideInt kept = lanes_below(held);
      const int at = i - held;
      x = select(kept, x, load3(s.x, at));
      u = select(kept, u, load(s.u + at));
      w = select(kept, w, load(s.w + at));
      number = kept ? number : names_at(s, at);
      const int taken = last - i < kLanes - held ? last - i : kLanes - held;
      held += taken;
      i += taken;
      if (held == kLanes) test();
    }
  }
  if (held > 0) test();
  return seeker.found;
}

template <bool kOnce>
WEFT_INLINE NearFound search(const NearSearch& given) {
  const NearSearch s = given;
  int found = 0;
  for (int m = s.begin; m < s.end;) {
    const std::int32_t bucket = s.bucket[m];
    const Runs runs = runs_about(s, bucket, kOnce ? m : 0);
    const int needed = runs.candidates + kNearPadding;
    if (s.room.size < needed) return {m, found, needed};
    int end = m + 1;
    while (end < s.end && s.bucket[end] == bucket) ++end;
    const bool together = end - m > kFewMembers;
    const int near = together ? bring_together(s, runs, m, end) : runs.candidates;
    for (; m < end; ++m) {
      if (s.pairs_room - found < needed) return {m, found, needed};
      int count = 0;
      if (near > 1)
        count = together ? near_one<kOnce>(s, near, m, s.neighbour + found)
                         : near_one<kOnce>(s, runs, m, s.neighbour + found);
      const WideInt owner = WideInt{} + (s.names ? s.names[m] : m);
      for (int i = 0; i < count; i += kLanes) put_lanes(s.owner + found + i, owner);
      found += count;
    }
  }
  return {s.end, found, 0};
}

}  // namespace

NearFound near_pairs(const NearSearch& given) {
  return given.once ? search<true>(given) : search<false>(given);
}

}  // namespace weft::WEFT_KERNELS
