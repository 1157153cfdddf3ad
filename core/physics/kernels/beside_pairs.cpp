// Self-collision: particles that lie a few steps from each other in their own sheet (contact.h).
#include "physics/kernels/contact.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::BesideFound;
using physics::BesidePairs;
using physics::SheetStep;

constexpr int kGroup = 16;  // columns, whatever the lanes: pairs are listed group after group

// The columns whose particles have one a step away.
struct Columns {
  int begin, end;
};
WEFT_INLINE Columns columns_of(const BesidePairs& s, SheetStep step) {
  return {step.across < 0 ? -step.across : 0,
          step.across > 0 ? s.columns - step.across : s.columns};
}

WEFT_INLINE LaneBits lanes_before(int count) {
  return first_lanes(count > 0 ? count : 0);
}

}  // namespace

// Few of them are ever in range: a group is looked through for which ones where any may be.
BesideFound beside_pairs(const BesidePairs& given) {
  const BesidePairs s = given;
  const Wide range = wide(s.range_squared);
  const int end = s.column + s.block_columns;
  BesideFound found{};
  for (; found.rows < s.block_rows && found.pairs <= s.most; ++found.rows) {
    const int row = s.row + found.rows;
    const std::ptrdiff_t from = row * s.stride;
    for (int group = s.column; group < end; group += kGroup) {
      const auto each_step = [&](const auto& visit) {
        for (int n = 0; n < s.steps && row + s.step[n].down < s.rows; ++n) {
          const Columns there = columns_of(s, s.step[n]);
          if (group < there.end && group + kGroup > there.begin)
            visit(s.step[n], from + s.step[n].down * s.stride + s.step[n].across, there);
        }
      };
      Wide3 here[kGroup / kLanes];
      for (int l = 0; l < kGroup; l += kLanes) here[l / kLanes] = load3(s.x, from + group + l);
      // From lanes of the group to those a step away.
      const auto squared = [&](std::ptrdiff_t to, int l) {
        const Wide3 d = load3(s.x, to + group + l) - here[l / kLanes];
        return dot(d, d);
      };
      Wide least = wide(1e30f);
      each_step([&](SheetStep, std::ptrdiff_t to, Columns) {
        for (int l = 0; l < kGroup; l += kLanes) least = min(least, squared(to, l));
      });
      if (where_less(least, range) == 0) continue;
      const std::int32_t name = s.first + row * s.name_stride;
      each_step([&](SheetStep step, std::ptrdiff_t to, Columns there) {
        const int last = there.end < end ? there.end : end;
        for (int l = 0; l < kGroup; l += kLanes) {
          const int i = group + l;
          const LaneBits near = where_less(squared(to, l), range) & lanes_before(last - i) &
                                ~lanes_before(there.begin - i);
          const WideInt owner = lane_numbers() + (name + i);
          store_lanes(s.pairs.owner + found.pairs, near, owner);
          found.pairs += store_lanes(s.pairs.neighbour + found.pairs, near,
                                     owner + (step.down * s.name_stride + step.across));
        }
      });
    }
  }
  return found;
}

}  // namespace weft::WEFT_KERNELS
