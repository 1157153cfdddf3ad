// Bounds of a block of particles (contact.h): where they are, how fast, how far they have moved, and
// how their edges lie; and which boxes are near each other. Least and greatest values are exact, so that
// no order matters.
#include <limits>

#include "physics/kernels/contact.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

constexpr float kFar = std::numeric_limits<float>::max();

struct WideSpread {
  Wide3 low = wide3(kFar, kFar, kFar), high = wide3(-kFar, -kFar, -kFar);

  WEFT_INLINE void add(Wide3 d, WideInt inside) {
    low = {min(low.x, select(inside, d.x, low.x)), min(low.y, select(inside, d.y, low.y)),
           min(low.z, select(inside, d.z, low.z))};
    high = {max(high.x, select(inside, d.x, high.x)), max(high.y, select(inside, d.y, high.y)),
            max(high.z, select(inside, d.z, high.z))};
  }
  WEFT_INLINE physics::Spread spread() const {
    return {{least(low.x), least(low.y), least(low.z)},
            {greatest(high.x), greatest(high.y), greatest(high.z)}};
  }
};

}  // namespace

void block_bounds(const physics::BlockRows& b) {
  WideSpread x, v, moved;
  for (int j = 0; j < b.rows; ++j)
    for (int i = 0; i < b.columns; i += kLanes) {
      const std::ptrdiff_t at = std::ptrdiff_t(j) * b.stride + i;
      const WideInt inside = lanes_below(b.columns - i);
      const Wide3 here = load3(b.x, at);
      x.add(here, inside);
      v.add(load3(b.v, at), inside);
      if (b.then.x) moved.add(here - load3(b.then, at), inside);
    }
  b.bounds->x = x.spread();
  b.bounds->v = v.spread();
  if (b.then.x) b.bounds->moved = moved.spread();
}

void block_edges(const physics::BlockRows& b) {
  WideSpread along, across;
  Wide change_along{}, change_across{};
  for (int j = 0; j < b.rows; ++j)
    for (int i = 0; i < b.columns; i += kLanes) {
      const std::ptrdiff_t at = std::ptrdiff_t(j) * b.stride + i;
      const WideInt inside = lanes_below(b.columns - i);
      const Wide3 here = load3(b.x, at), speed = load3(b.v, at);
      const WideInt starts = lanes_below(b.edges_along - i);
      along.add(load3(b.x, at + 1) - here, starts);
      const Wide3 pulled = load3(b.v, at + 1) - speed;
      change_along = max(change_along, select(starts, dot(pulled, pulled), Wide{}));
      if (j >= b.edges_across) continue;
      across.add(load3(b.x, at + b.stride) - here, inside);
      const Wide3 turned = load3(b.v, at + b.stride) - speed;
      change_across = max(change_across, select(inside, dot(turned, turned), Wide{}));
    }
  b.bounds->along = along.spread();
  b.bounds->across = across.spread();
  b.bounds->change_along = greatest(change_along);
  b.bounds->change_across = greatest(change_across);
}

int near_boxes(const physics::NearBoxes& given) {
  const physics::NearBoxes s = given;
  int count = 0;
  for (int i = s.begin; i < s.end; i += kLanes) {
    Wide square{};
    for (int k = 0; k < 3; ++k) {
      const Wide gap =
          max(max(load(s.low[k] + i) - s.box.high[k], s.box.low[k] - load(s.high[k] + i)), Wide{});
      square = square + gap * gap;
    }
    const LaneBits near = where_less(square, wide(s.distance_squared)) & first_lanes(s.end - i);
    store_lanes(s.square + count, near, square);
    count += store_lanes(s.near + count, near, lane_numbers() + i);
  }
  return count;
}

}  // namespace weft::WEFT_KERNELS
