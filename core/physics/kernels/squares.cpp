// Which pairs of squares may come near each other in an interval (surface.h).
#include "physics/kernels/gather.h"
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"
#include "physics/kernels/surface.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::SquaresApart;
using physics::SquaresAwake;
using physics::SquaresWithin;

constexpr float kTiny = 1e-20f;  // m²
constexpr int kRecord = 4;       // floats

// Corners of kLanes squares at an interval's start and end, relative to a point.
struct Corners {
  Wide3 start[4], end[4];
};

WEFT_INLINE Corners corners_of(const SquaresApart& s, const std::int32_t* numbers) {
  const Wide4 square = records_at((const float*)s.squares->corner, kRecord, numbers);
  const WideInt corner[4] = {(WideInt)square.xyz.x, (WideInt)square.xyz.y, (WideInt)square.xyz.z,
                             (WideInt)square.last};
  Corners c;
  for (int n = 0; n < 4; ++n) {
    const auto* const number = (const std::int32_t*)&corner[n];
    c.start[n] = records_at(s.place->x, kRecord, number).xyz;
    c.end[n] = c.start[n] + records_at(s.moved->u, kRecord, number).xyz;
  }
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

// Between boxes, squared.
WEFT_INLINE Wide box_gap(const physics::SquareBox* boxes, const std::int32_t* owner,
                         const std::int32_t* neighbour) {
  constexpr int kStride = sizeof(physics::SquareBox) / sizeof(float);
  const auto low = [&](const std::int32_t* of) { return records_at(boxes->low, kStride, of).xyz; };
  const auto high = [&](const std::int32_t* of) {
    return records_at(boxes->high, kStride, of).xyz;
  };
  const Wide3 a = low(owner) - high(neighbour), b = low(neighbour) - high(owner);
  const Wide3 gap{max(max(a.x, b.x), Wide{}), max(max(a.y, b.y), Wide{}),
                  max(max(a.z, b.z), Wide{})};
  return dot(gap, gap);
}

}  // namespace

int squares_not_apart(const SquaresApart& given) {
  const SquaresApart s = given;
  int count = 0;
  for (int k = 0; k < s.pairs; k += kLanes) {
    const Corners p = corners_of(s, s.owner + k), q = corners_of(s, s.neighbour + k);
    const WideInt apart = kept_apart(p, q, s.range) | kept_apart(q, p, s.range);
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
