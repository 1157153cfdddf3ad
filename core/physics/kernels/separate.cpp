// Self-collision: how pairs that are too near are pushed apart (Jacobi: every owner looks at the same
// state). The pairs that touch are brought together first, kLanes of them say what they ask for, and
// each owner sums up what its own ask, in their order. Owners move when all have been asked.
//
//   stiff:   Δx_a = n (t - d) w_a/(w_a + w_b); the velocity into the other is lost, and the tangential
//            velocity loses up to μ times as much as was pressed (Coulomb; μ the mean of both);
//            averaged over the pairs, each weighing as much as it is deep
//            What contact has to take from a particle's velocity run after run, its load, it gives in
//            part beforehand (scatter_bodies): pressed by a load a, a particle that leaves with a Δt/2
//            is back in its place at the next run, while one that leaves with nothing has sunk in by
//            a Δt²/2. Only what this run and the one before agree on counts, and no more than what contact
//            had to give now: a blow is no load, and what is let go gets nothing.
//   course:  Δx_a = n (t - d), averaged over the pairs and divided by the substeps, velocity included
//            (seeds 001 and 004: the position before stays)
#include "physics/kernels/contact.h"
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::Asked;
using physics::Body;
using physics::BodyBlock;
using physics::CloseFound;
using physics::ClosePairs;
using physics::PairRoom;
using physics::Separated;
using physics::SeparateOwners;

// Of the thickness, at once: what starts intersecting comes apart slowly.
constexpr float kMostPush = 0.5f;
constexpr float kTiny = 1e-12f;
constexpr int kStride = sizeof(Body) / sizeof(float);

WEFT_INLINE Wide friction_of(const SeparateOwners& s, const std::int32_t* body) {
  if (!s.friction) return wide(s.friction_alike);
  Wide r{};
  for (int l = 0; l < kLanes; ++l) r[l] = s.friction[body[l]];
  return r;
}

// What kLanes pairs of the room from `at` on ask for; returns their greatest squared relative speed.
WEFT_INLINE Wide ask(const SeparateOwners& s, int at) {
  const std::int32_t* const owner = s.touching.owner + at;
  const std::int32_t* const neighbour = s.touching.neighbour + at;
  const Wide4 p = records_at(s.bodies->x, kStride, owner);
  const Wide4 q = records_at(s.bodies->x, kStride, neighbour);
  const Wide held = 0.5f * (p.last + q.last);
  Wide3 d = p.xyz - q.xyz;
  const Wide square = dot(d, d);
  // In one place: apart along y, by their order.
  const WideInt together = square < kTiny * kTiny;
  const Wide distance = select(together, Wide{}, sqrt(square));
  if (any(together)) {
    const WideInt later = lanes_at(neighbour) > lanes_at(owner);
    d = select(together, {Wide{}, select(later, wide(1), wide(-1)), Wide{}}, d);
  }
  const Wide3 n = d * (1.0f / select(together, wide(1), distance));
  const Wide depth = held - distance;
  const Wide4 own = records_at(s.bodies->v, kStride, owner);
  const Wide4 other = records_at(s.bodies->v, kStride, neighbour);
  const Wide mine = friction_of(s, owner), theirs = friction_of(s, neighbour);
  const WideInt course = mine < 0.0f;
  const Wide friction = select(theirs < 0.0f, mine, 0.5f * (mine + theirs));
  const Wide share = own.last / (own.last + other.last);
  const Wide weight = select(course, wide(1), depth);
  const Wide lift = select(course, depth, min(depth, kMostPush * held) * share) * weight;
  const Wide3 u = own.xyz - other.xyz;
  const Wide into = dot(u, n);
  const Wide3 slide = u - n * into;
  const Wide lost = max(Wide{}, -into);
  Wide rubbed{};
  if (any(lost * friction > 0.0f)) {
    const Wide sliding = sqrt(dot(slide, slide));
    rubbed = select(sliding > kTiny, min(wide(1), friction * lost / sliding), Wide{});
  }
  put_records(s.asked[at].push, kStride, {n * lift, weight});
  put_records(s.asked[at].gain, kStride, {(n * lost - slide * rubbed) * (share * weight), Wide{}});
  return dot(u, u);
}

// Sums up what the owners of `count` pairs are asked, owner after owner, in place. Returns how many
// owners, whose numbers then stand one after another in the room. Without branches: how many pairs an
// owner has cannot be foretold.
WEFT_INLINE int sum_up(const SeparateOwners& s, int count) {
  typedef std::int32_t FourInt __attribute__((vector_size(16)));
  Four push{}, gain{};
  std::int32_t last = -1;
  int owners = -1;
  for (int i = 0; i < count; ++i) {
    const std::int32_t owner = s.touching.owner[i];
    const int goes_on = -int(owner == last);
    const FourInt kept = FourInt{} + goes_on;
    push = (Four)((FourInt)push & kept) + load_four(s.asked[i].push);
    gain = (Four)((FourInt)gain & kept) + load_four(s.asked[i].gain);
    owners += 1 + goes_on;
    s.touching.owner[owners] = last = owner;
    *reinterpret_cast<Four*>(s.asked[owners].push) = push;
    *reinterpret_cast<Four*>(s.asked[owners].gain) = gain;
  }
  return owners + 1;
}

// Moves kLanes owners, from number `at` on in the room, by the mean of what they are asked.
WEFT_INLINE void move(const SeparateOwners& s, int at) {
  const std::int32_t* const owner = s.touching.owner + at;
  const Wide4 x = records_at(s.bodies->x, kStride, owner);
  const Wide4 v = records_at(s.bodies->v, kStride, owner);
  const Wide4 push = records_in_row(s.asked[at].push, kStride);
  const Wide3 gain = records_in_row(s.asked[at].gain, kStride).xyz;
  const Wide weight = push.last;
  const WideInt moves = (v.last > 0.0f) & (weight > 0.0f);
  const WideInt course = friction_of(s, owner) < 0.0f;
  const Wide mean = 1.0f / weight;
  const Wide3 by = push.xyz * (mean * select(course, wide(s.course_share), wide(1)));
  const Wide3 faster = select(course, by * wide(s.inverse_dt), gain * mean);
  put_records(s.moved[at].x, kStride, {select(moves, x.xyz + by, x.xyz), x.last});
  put_records(s.moved[at].v, kStride, {select(moves, v.xyz + faster, v.xyz), v.last});
  put_lanes(s.moved_owner + at, lanes_at(owner));
}

}  // namespace

CloseFound close_pairs(const ClosePairs& given) {
  const ClosePairs s = given;
  const float reach2 = s.reach * s.reach;
  CloseFound found{};
  const auto put = [](const PairRoom& room, int at, WideInt which, WideInt owner,
                      WideInt neighbour) {
    store_lanes(room.owner + at, which, owner);
    return at + store_lanes(room.neighbour + at, which, neighbour);
  };
  for (int k = 0; k < s.pairs; k += kLanes) {
    const Wide4 p = records_at(s.bodies->x, kStride, s.owner + k);
    const Wide4 q = records_at(s.bodies->x, kStride, s.neighbour + k);
    const WideInt owner = lanes_at(s.owner + k), neighbour = lanes_at(s.neighbour + k);
    const Wide held = 0.5f * (p.last + q.last);
    const Wide3 d = p.xyz - q.xyz;
    const Wide square = dot(d, d), held2 = held * held;
    const WideInt there = lanes_below(s.pairs - k);
    if (s.close.owner)
      found.close = put(s.close, found.close, (square < reach2 * held2) & there, owner, neighbour);
    found.touching = put(s.touching, found.touching, (square < held2) & there, owner, neighbour);
  }
  const auto pad = [](const PairRoom& room, int end) {
    put_lanes(room.owner + end, WideInt{});
    put_lanes(room.neighbour + end, WideInt{});
  };
  if (s.close.owner) pad(s.close, found.close);
  pad(s.touching, found.touching);
  return found;
}

Separated separate(const SeparateOwners& given) {
  const SeparateOwners s = given;
  Wide fastest{};
  for (int i = 0; i < s.pairs; i += kLanes)
    fastest = max(fastest, select(lanes_below(s.pairs - i), ask(s, i), Wide{}));
  const int owners = sum_up(s, s.pairs);
  for (int i = 0; i < owners; i += kLanes) move(s, i);
  return {owners, greatest(fastest)};
}

void gather_bodies(const BodyBlock& given) {
  const BodyBlock b = given;
  for (int j = 0; j < b.rows; ++j)
    for (int i = 0; i < b.columns; i += kLanes) {
      const std::ptrdiff_t at = j * b.stride + i;
      put_records(b.bodies[at].x, kStride, {load3(b.x, at), wide(b.held)});
      put_records(b.bodies[at].v, kStride, {load3(b.v, at), load(b.w + at)});
    }
}

void scatter_bodies(const BodyBlock& given) {
  const BodyBlock b = given;
  for (int j = 0; j < b.rows; ++j)
    for (int i = 0; i < b.columns; i += kLanes) {
      const std::ptrdiff_t at = j * b.stride + i;
      store3(b.x, at, records_in_row(b.bodies[at].x, kStride).xyz);
      const Wide4 now = records_in_row(b.bodies[at].v, kStride);
      const Wide3 gain = now.xyz - load3(b.v, at);
      const Wide3 load = (gain + load3(b.ahead, at)) * wide(b.inverse_since);
      const Wide square = dot(load, load);
      const Wide lasting =
          b.advance * b.since * min(wide(1), dot(load, load3(b.load, at)) / square);
      const Wide share = max(Wide{}, min(lasting, dot(gain, load) / square));
      const WideInt pressed = (now.last > 0.0f) & (square > 0.0f);
      const Wide3 ahead = load * select(pressed, share, Wide{});
      store3(b.load, at, load);
      store3(b.ahead, at, ahead);
      store3(b.v, at, now.xyz + ahead);
    }
}

}  // namespace weft::WEFT_KERNELS
