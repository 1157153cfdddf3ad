// The pair search of self-collision: who of many candidates is within a range of a particle. The
// candidates of a cell with several members are brought together first, those alone that are within
// the range of the box about the members, so that each of these tests few and whole groups.
#include "physics/kernels/contact.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::CellKeys;
using physics::kNearPadding;
using physics::NearFound;
using physics::NearRoom;
using physics::NearSearch;
using physics::NearSheet;
using physics::Run;

constexpr int kFewMembers = 2;  // of a cell, for which its candidates stay where they are

struct Runs {
  Run run[18];
  int count = 0, candidates = 0;
};

// Of those from number `begin` on, the run that begins there first.
WEFT_INLINE Runs runs_about(const NearSearch& s, std::int64_t bucket, int begin) {
  Runs r;
  const auto add = [&](std::int64_t from, std::int64_t to) {
    const int first = s.start[from], last = s.start[to];
    if (first <= begin && begin < last) r.run[0].last = last;
    if (first <= begin) return;
    r.run[r.count] = {first, last};
    r.count += first < last;
    r.candidates += last - first;
  };
  r.run[0] = {begin, begin};
  r.count = 1;
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
  r.candidates += r.run[0].last - begin;
  return r;
}

// Of the sorted particles from number i on.
template <bool kNamed>
WEFT_INLINE WideInt names_at(const NearSearch& s, int i) {
  return kNamed ? lanes_at(s.name + i) : lane_numbers() + i;
}

// From a box to points outside, along an axis. Rounding keeps it no longer than from any point inside.
WEFT_INLINE Wide outside(Wide x, Wide low, Wide high) {
  return x - max(low, min(x, high));
}

// The runs' particles within the range of the sorted ones from `begin` to `end`, these first, next to
// each other in the room; the last group is filled up with some far away. Returns how many.
template <bool kNamed>
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
  const Wide range = wide(s.range_squared);
  int count = 0;
  for (int r = 0; r < runs.count; ++r) {
    const int last = runs.run[r].last;
    for (int i = runs.run[r].first; i < last; i += kLanes) {
      const Wide3 p = load3(s.x, i);
      const Wide3 d{outside(p.x, wide(low[0]), wide(high[0])),
                    outside(p.y, wide(low[1]), wide(high[1])),
                    outside(p.z, wide(low[2]), wide(high[2]))};
      const LaneBits kept = where_less(dot(d, d), range) & first_lanes(last - i);
      store_lanes(room.x.x + count, kept, p.x);
      store_lanes(room.x.y + count, kept, p.y);
      store_lanes(room.x.z + count, kept, p.z);
      count += store_lanes(room.name + count, kept, names_at<kNamed>(s, i));
    }
  }
  for (int i = 0; i < 16; i += kLanes)
    store(room.x.x + count + i, wide(1e18f));  // its square is still finite
  return count;
}

// A particle, and where the names of those near it go.
template <bool kNamed>
struct Seeker {
  Wide3 p;
  Wide range;
  std::int32_t name;
  const NearSheet* sheet;
  std::int32_t* near;
  int found = 0;

  WEFT_INLINE Seeker(const NearSearch& s, int number, const NearSheet* sheet, std::int32_t* to)
      : p(wide3(s.x.x[number], s.x.y[number], s.x.z[number])),
        range(wide(s.range_squared)),
        name(kNamed ? s.name[number] : number),
        sheet(sheet),
        near(to) {}

  // Of kLanes candidates, those `asked`.
  WEFT_INLINE void test(Wide3 x, WideInt other, LaneBits asked) {
    const Wide3 d = x - p;
    LaneBits pair = where_less(dot(d, d), range) & asked;
    if constexpr (kNamed) {
      const WideInt apart = select(other > name, other - name, name - other);
      for (int w = 0; w < sheet->windows; ++w)
        pair &= ~where_within(apart, sheet->window[w].low, sheet->window[w].high);
    }
    found += store_lanes(near + found, pair, other);
  }

  // Of what was brought together, those from number `first` to `last`.
  WEFT_INLINE int among(const NearRoom& room, int first, int last) {
    for (int i = first; i < last; i += kLanes)
      test(load3(room.x, i), lanes_at(room.name + i), first_lanes(kLanes));
    return found;
  }

  // Of the runs themselves, which are short, but the first `left_out`: as many as fit share a group.
  WEFT_INLINE int among(const NearSearch& s, const Runs& runs, int left_out) {
    Wide3 x{};
    WideInt names{};
    int held = 0;
    for (int r = 0; r < runs.count; ++r) {
      const int last = runs.run[r].last;
      for (int i = runs.run[r].first + (r == 0 ? left_out : 0); i < last;) {
        const WideInt kept = lanes_below(held);
        const int at = i - held;
        x = select(kept, x, load3(s.x, at));
        names = select(kept, names, names_at<kNamed>(s, at));
        const int taken = last - i < kLanes - held ? last - i : kLanes - held;
        held += taken;
        i += taken;
        if (held < kLanes) continue;
        test(x, names, first_lanes(kLanes));
        held = 0;
      }
    }
    if (held > 0) test(x, names, first_lanes(held));
    return found;
  }
};

// About each particle among those that follow it in sorted order.
template <bool kNamed>
WEFT_INLINE NearFound search(const NearSearch& given) {
  const NearSearch s = given;
  const NearSheet* sheet = s.sheet;
  int found = 0;
  for (int m = s.begin; m < s.end;) {
    const std::int32_t bucket = s.bucket[m];
    const int first = m;
    const Runs runs = runs_about(s, bucket, first);
    const int needed = runs.candidates + kNearPadding;
    if (s.room.size < needed) return {m, found, needed};
    int end = m + 1;
    while (end < s.end && s.bucket[end] == bucket) ++end;
    const bool together = end - m > kFewMembers;
    const int candidates = together ? bring_together<kNamed>(s, runs, m, end) : runs.candidates;
    for (; m < end; ++m) {
      if (s.pairs_room - found < needed) return {m, found, needed};
      const int left_out = m + 1 - first;
      if (candidates == left_out) continue;
      if constexpr (kNamed) {
        while (sheet->first > s.name[m]) --sheet;
        while (sheet + 1 < s.sheet + s.sheets && sheet[1].first <= s.name[m]) ++sheet;
      }
      Seeker<kNamed> seeker(s, m, sheet, s.neighbour + found);
      const int count =
          together ? seeker.among(s.room, left_out, candidates) : seeker.among(s, runs, left_out);
      for (int i = 0; i < count; i += kLanes)
        put_lanes(s.owner + found + i, WideInt{} + seeker.name);
      found += count;
    }
  }
  return {s.end, found, 0};
}

// The cell along an axis; what is not a number lands in the last.
WEFT_INLINE WideInt cell(Wide x, float low, float last, float inverse) {
  const Wide along = max(min((x - low) * inverse, wide(last)), Wide{});
  return __builtin_convertvector(along, WideInt) + 1;
}

}  // namespace

void cell_keys(const CellKeys& given) {
  const CellKeys s = given;
  for (int i = s.begin; i < s.end; i += kLanes) {
    const WideInt a = cell(load(s.x.x + i), s.low[0], s.last[0], s.inverse);
    const WideInt b = cell(load(s.x.y + i), s.low[1], s.last[1], s.inverse);
    const WideInt c = cell(load(s.x.z + i), s.low[2], s.last[2], s.inverse);
    if (s.wraps) {
      for (int l = 0; l < kLanes; ++l)
        s.key[i + l] = std::int32_t((a[l] + b[l] * s.stride_y + c[l] * s.stride_z) % s.table);
    } else {
      put_lanes(s.key + i, a + b * std::int32_t(s.stride_y) + c * std::int32_t(s.stride_z));
    }
  }
}

NearFound near_pairs(const NearSearch& given) {
  return given.name ? search<true>(given) : search<false>(given);
}

}  // namespace weft::WEFT_KERNELS
