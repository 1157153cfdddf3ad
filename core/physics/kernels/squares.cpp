// Which pairs of squares may come near each other in an interval (surface.h).
#include "physics/kernels/gather.h"
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"
#include "physics/kernels/surface.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::BesideAwake;
using physics::CornerWaysOfRow;
using physics::SquaresApart;
using physics::SquaresAwake;
using physics::SquaresWithin;

constexpr float kTiny = 1e-20f;  // m²
constexpr int kRecord = 4;       // floats

// Corners of kLanes squares at an interval's start and end, relative to a point.
struct Corners {
  Wide3 start[4], end[4];
};

// visit(corner, its bodies) of kLanes squares.
template <class Visit>
WEFT_INLINE void for_each_corner(Wide4 squares, const Visit& visit) {
  const WideInt corner[4] = {(WideInt)squares.xyz.x, (WideInt)squares.xyz.y, (WideInt)squares.xyz.z,
                             (WideInt)squares.last};
  for (int n = 0; n < 4; ++n) visit(n, (const std::int32_t*)&corner[n]);
}
WEFT_INLINE Wide4 squares_at(const physics::Square* squares, const std::int32_t* numbers) {
  return records_at((const float*)squares->corner, kRecord, numbers);
}

WEFT_INLINE Corners corners_of(const SquaresApart& s, const std::int32_t* numbers) {
  Corners c;
  for_each_corner(squares_at(s.squares, numbers), [&](int n, const std::int32_t* bodies) {
    c.start[n] = records_at(s.place->x, kRecord, bodies).xyz;
    c.end[n] = c.start[n] + records_at(s.moved->u, kRecord, bodies).xyz;
  });
  return c;
}

// How far corners of q are beyond those of p along a normal, at least; negative where neither.
WEFT_INLINE Wide beyond(Wide3 normal, const Wide3 (&p)[4], const Wide3 (&q)[4]) {
  Wide highest = dot(normal, p[0]), lowest = dot(normal, q[0]);
  for (int n = 1; n < 4; ++n) {
    highest = max(highest, dot(normal, p[n]));
    lowest = min(lowest, dot(normal, q[n]));
  }
  return lowest - highest;
}

// Whether a plane across p's normal is between the two all the time (positions are linear in time).
WEFT_INLINE WideInt kept_apart(const Corners& p, const Corners& q, float range) {
  const Wide3 normal = cross(p.start[3] - p.start[0], p.start[2] - p.start[1]);
  const Wide least = range * sqrt(dot(normal, normal)) + wide(kTiny);
  return ((beyond(normal, p.start, q.start) > least) & (beyond(normal, p.end, q.end) > least)) |
         ((beyond(normal, q.start, p.start) > least) & (beyond(normal, q.end, p.end) > least));
}

struct Box {
  Wide3 low, high;
};

// About the corners of squares all through an interval.
WEFT_INLINE Box box_of(const Corners& c) {
  Box box{c.start[0], c.start[0]};
  const auto add = [&](const Wide3& x) {
    box.low = {min(box.low.x, x.x), min(box.low.y, x.y), min(box.low.z, x.z)};
    box.high = {max(box.high.x, x.x), max(box.high.y, x.y), max(box.high.z, x.z)};
  };
  for (int n = 0; n < 4; ++n) add(c.start[n]), add(c.end[n]);
  return box;
}

// Between boxes, squared.
WEFT_INLINE Wide box_gap(const Box& p, const Box& q) {
  const Wide3 a = p.low - q.high, b = q.low - p.high;
  const Wide3 gap{max(max(a.x, b.x), Wide{}), max(max(a.y, b.y), Wide{}),
                  max(max(a.z, b.z), Wide{})};
  return dot(gap, gap);
}
WEFT_INLINE Wide box_gap(const physics::SquareBox* boxes, const std::int32_t* owner,
                         const std::int32_t* neighbour) {
  constexpr int kStride = sizeof(physics::SquareBox) / sizeof(float);
  const auto low = [&](const std::int32_t* of) { return records_at(boxes->low, kStride, of).xyz; };
  const auto high = [&](const std::int32_t* of) {
    return records_at(boxes->high, kStride, of).xyz;
  };
  return box_gap(Box{low(owner), high(owner)}, Box{low(neighbour), high(neighbour)});
}

}  // namespace

int squares_not_apart(const SquaresApart& given) {
  const SquaresApart s = given;
  int count = 0;
  for (int k = 0; k < s.pairs; k += kLanes) {
    const Corners p = corners_of(s, s.owner + k), q = corners_of(s, s.neighbour + k);
    const WideInt apart = kept_apart(p, q, s.range) | kept_apart(q, p, s.range) |
                          (box_gap(box_of(p), box_of(q)) > s.range * s.range);
    const unsigned near = bits(~apart & lanes_below(s.pairs - k));
    const WideInt neighbours = lanes_at(s.neighbour + k), owners = lanes_at(s.owner + k);
    store_lanes(s.near_owner + count, near, owners);
    count += store_lanes(s.near_neighbour + count, near, neighbours);
  }
  for (int l = 0; l < kLanes; ++l) s.near_owner[count + l] = s.near_neighbour[count + l] = 0;
  return count;
}

int squares_awake(const SquaresAwake& given) {
  const SquaresAwake s = given;
  int count = 0;
  for (int k = 0; k < s.pairs; k += kLanes) {
    const Wide ways = gathered(s.way, s.owner + k) + gathered(s.way, s.neighbour + k);
    const Wide until = load(s.until + k);
    const WideInt awake = (ways >= until) & lanes_below(s.pairs - k);
    if (!any(awake)) continue;
    const Wide beyond = sqrt(box_gap(s.boxes, s.owner + k, s.neighbour + k)) - s.range;
    const WideInt far = beyond > 0.0f;
    store(s.until + k, select(awake & far, (ways + beyond) * physics::kRoundedDown, until));
    const unsigned near = bits(awake & ~far);
    const WideInt neighbours = lanes_at(s.neighbour + k), owners = lanes_at(s.owner + k);
    store_lanes(s.near_owner + count, near, owners);
    store_lanes(s.near_number + count, near, lane_numbers() + (s.number + k));
    count += store_lanes(s.near_neighbour + count, near, neighbours);
  }
  for (int l = 0; l < kLanes; ++l) s.near_owner[count + l] = s.near_neighbour[count + l] = 0;
  return count;
}

void corner_ways(const CornerWaysOfRow& given) {
  const CornerWaysOfRow s = given;
  for (int k = 0; k < s.count; k += kLanes) {
    Wide3 u[4];
    for_each_corner(records_in_row((const float*)s.squares[k].corner, kRecord),
                    [&](int n, const std::int32_t* bodies) {
                      u[n] = records_at(s.moved->u, kRecord, bodies).xyz;
                    });
    Wide apart{};
    for (int n = 0; n < 4; ++n)
      for (int m = 0; m < n; ++m) apart = max(apart, dot(u[n] - u[m], u[n] - u[m]));
    const Wide way = sqrt(apart);
    store(s.last + k, way);
    store(s.all + k, (load(s.all + k) + way) / physics::kRoundedDown);
  }
}

int beside_awake(const BesideAwake& given) {
  const BesideAwake s = given;
  int count = 0;
  for (int k = 0; k < s.pairs; k += kLanes) {
    const WideInt awake =
        (load(s.way + k) + load(s.other_way + k) >= load(s.until + k)) & lanes_below(s.pairs - k);
    if (!any(awake)) continue;
    const unsigned which = bits(awake);
    const WideInt number = lane_numbers() + k;
    store_lanes(s.awake_owner + count, which, number + s.owner);
    store_lanes(s.awake_number + count, which, number * s.and_so_on + s.number);
    count += store_lanes(s.awake_neighbour + count, which, number + s.neighbour);
  }
  return count;
}

int squares_within(const SquaresWithin& given) {
  const SquaresWithin s = given;
  int count = 0;
  for (int k = 0; k < s.pairs; k += kLanes) {
    const Wide square = box_gap(s.boxes, s.owner + k, s.neighbour + k);
    const unsigned within = bits((square < s.range * s.range) & lanes_below(s.pairs - k));
    store_lanes(s.within_owner + count, within, lanes_at(s.owner + k));
    count += store_lanes(s.within_neighbour + count, within, lanes_at(s.neighbour + k));
  }
  for (int l = 0; l < kLanes; ++l) s.within_owner[count + l] = s.within_neighbour[count + l] = 0;
  return count;
}

}  // namespace weft::WEFT_KERNELS
