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
using physics::AskFound;
using physics::AskPairs;
using physics::BodyBlock;
using physics::BodyFriction;
using physics::CloseFound;
using physics::ClosePairs;
using physics::MoveOwners;
using physics::PairRoom;

// Of the thickness, at once: what starts intersecting comes apart slowly.
constexpr float kMostPush = 0.5f;
constexpr float kTiny = 1e-12f;
constexpr int kBody = 4;  // floats of a place, and of a motion
constexpr int kAsked = sizeof(Asked) / sizeof(float);

template <bool kAlike>
WEFT_INLINE Wide friction_of(const BodyFriction& friction, const std::int32_t* body) {
  if constexpr (kAlike) return wide(friction.alike);
  Wide r{};
  for (int l = 0; l < kLanes; ++l) r[l] = friction.each[body[l]];
  return r;
}

// What kLanes pairs from `at` on ask for; returns their greatest squared relative speed.
template <bool kAlike>
WEFT_INLINE Wide ask(const AskPairs& s, int at) {
  const std::int32_t *const owner = s.owner + at, *const neighbour = s.neighbour + at;
  const Wide4 apart = differences_at(s.place->x, kBody, owner, neighbour);
  const Wide held = 0.5f * apart.last;
  Wide3 d = apart.xyz;
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
  const Wide4 own = records_at(s.motion->v, kBody, owner);
  const Wide4 other = records_at(s.motion->v, kBody, neighbour);
  const Wide mine = friction_of<kAlike>(s.friction, owner);
  const Wide theirs = friction_of<kAlike>(s.friction, neighbour);
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
  put_records(s.asked[at].push, kAsked, {n * lift, weight});
  put_records(s.asked[at].gain, kAsked, {(n * lost - slide * rubbed) * (share * weight), Wide{}});
  return dot(u, u);
}

// Sums up what the pairs ask of their owners; returns how many owners these are. Without branches: how
// many pairs an owner has cannot be foretold.
WEFT_INLINE int sum_up(const AskPairs& s) {
  typedef std::int32_t FourInt __attribute__((vector_size(16)));
  Four push{}, gain{};
  std::int32_t last = -1;
  int owners = -1;
  for (int i = 0; i < s.pairs; ++i) {
    const std::int32_t owner = s.owner[i];
    const int goes_on = -int(owner == last);
    const FourInt kept = FourInt{} + goes_on;
    push = (Four)((FourInt)push & kept) + load_four(s.asked[i].push);
    gain = (Four)((FourInt)gain & kept) + load_four(s.asked[i].gain);
    owners += 1 + goes_on;
    s.asked_owner[owners] = last = owner;
    store_four(s.sum[owners].push, push);
    store_four(s.sum[owners].gain, gain);
  }
  return owners + 1;
}

template <bool kAlike>
WEFT_INLINE AskFound ask_all(const AskPairs& given) {
  const AskPairs s = given;
  Wide fastest{};
  for (int i = 0; i < s.pairs; i += kLanes)
    fastest = max(fastest, select(lanes_below(s.pairs - i), ask<kAlike>(s, i), Wide{}));
  return {sum_up(s), greatest(fastest)};
}

}  // namespace

CloseFound close_pairs(const ClosePairs& given) {
  const ClosePairs s = given;
  const float reach2 = s.reach * s.reach;
  CloseFound found{};
  const auto put = [](const PairRoom& room, int at, LaneBits which, WideInt owner,
                      WideInt neighbour) {
    store_lanes(room.owner + at, which, owner);
    return at + store_lanes(room.neighbour + at, which, neighbour);
  };
  for (int k = 0; k < s.pairs; k += kLanes) {
    const Wide4 d = differences_at(s.place->x, kBody, s.owner + k, s.neighbour + k);
    const WideInt owner = lanes_at(s.owner + k), neighbour = lanes_at(s.neighbour + k);
    const Wide held = 0.5f * d.last, held2 = held * held;
    const Wide square = dot(d.xyz, d.xyz);
    const LaneBits there = first_lanes(s.pairs - k);
    if (s.close.owner)
      found.close =
          put(s.close, found.close, where_less(square, reach2 * held2) & there, owner, neighbour);
    found.touching =
        put(s.touching, found.touching, where_less(square, held2) & there, owner, neighbour);
  }
  const auto pad = [](const PairRoom& room, int end) {
    put_lanes(room.owner + end, WideInt{});
    put_lanes(room.neighbour + end, WideInt{});
  };
  if (s.close.owner) pad(s.close, found.close);
  pad(s.touching, found.touching);
  return found;
}

AskFound ask_pairs(const AskPairs& s) {
  return s.friction.each ? ask_all<false>(s) : ask_all<true>(s);
}

// By the mean of what each is asked.
void move_owners(const MoveOwners& given) {
  const MoveOwners s = given;
  for (int n = 0; n < s.owners; ++n) {
    const std::int32_t owner = s.owner[n];
    const Asked& asked = s.sum[n];
    float* const x = s.place[owner].x;
    float* const v = s.motion[owner].v;
    const float weight = asked.push[3];
    if (!(v[3] > 0 && weight > 0)) continue;
    const bool course = (s.friction.each ? s.friction.each[owner] : s.friction.alike) < 0;
    const float mean = 1 / weight, share = mean * (course ? s.course_share : 1);
    const Four none{1, 1, 1, 0};
    const Four by = load_four(asked.push) * none * share;
    const Four faster = course ? by * s.inverse_dt : load_four(asked.gain) * mean;
    store_four(x, load_four(x) + by);
    store_four(v, load_four(v) + faster);
  }
}

void gather_bodies(const BodyBlock& given) {
  const BodyBlock b = given;
  for (int j = 0; j < b.rows; ++j)
    for (int i = 0; i < b.columns; i += kLanes) {
      const std::ptrdiff_t at = j * b.stride + i, body = j * b.body_stride + i;
      put_records(b.place[body].x, kBody, {load3(b.x, at), wide(b.held)});
      put_records(b.motion[body].v, kBody, {load3(b.v, at), load(b.w + at)});
    }
}

void scatter_bodies(const BodyBlock& given) {
  const BodyBlock b = given;
  for (int j = 0; j < b.rows; ++j)
    for (int i = 0; i < b.columns; i += kLanes) {
      const std::ptrdiff_t at = j * b.stride + i, body = j * b.body_stride + i;
      store3(b.x, at, records_in_row(b.place[body].x, kBody).xyz);
      const Wide4 now = records_in_row(b.motion[body].v, kBody);
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
