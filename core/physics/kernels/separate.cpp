// Self-collision: how pairs that are too near are pushed apart (Jacobi: every pair looks at the same
// state). The pairs that touch are brought together first, kLanes of them say what they ask for, and
// what each body is asked is summed up in the pairs' order. Bodies move when all have been asked.
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
// A pair of two sheets of which one has the course's rule is stiff.
#include "physics/kernels/contact.h"
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::Asked;
using physics::AskedSum;
using physics::AskFound;
using physics::AskPairs;
using physics::BodyBlock;
using physics::BodyFriction;
using physics::CloseFound;
using physics::ClosePairs;
using physics::MoveBodies;
using physics::PairRoom;
using physics::SumAsked;

// Of the thickness, at once: what starts intersecting comes apart slowly.
constexpr float kMostPush = 0.5f;
constexpr float kTiny = 1e-12f;
// All that a pair asks for, push and gain.
typedef float Eight __attribute__((vector_size(32), may_alias));

constexpr int kBody = 4;  // floats of a place, and of a motion
constexpr int kAsked = sizeof(Asked) / sizeof(float);

template <bool kAlike>
WEFT_INLINE Wide friction_of(const BodyFriction& friction, const std::int32_t* body) {
  if constexpr (kAlike) return wide(friction.alike);
  Wide r{};
  for (int l = 0; l < kLanes; ++l) r[l] = friction.each[body[l]];
  return r;
}

// Of kLanes pairs: relative speed squared, and depth, of the distance at which they are held.
struct AskedLanes {
  Wide speed_squared, depth;
};

// What kLanes pairs from `at` on ask for.
template <bool kAlike>
WEFT_INLINE AskedLanes ask(const AskPairs& s, int at) {
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
  const WideInt course = max(mine, theirs) < 0.0f;
  const Wide friction = select(min(mine, theirs) < 0.0f, max(mine, theirs), 0.5f * (mine + theirs));
  // By the course's rule both move all the way.
  const Wide share = select(course, wide(0.5f), own.last / (own.last + other.last));
  const Wide weight = select(course, wide(1), depth);
  const Wide lift = select(course, 2.0f * depth, min(depth, kMostPush * held)) * weight;
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
  put_records(s.asked[at].gain, kAsked, {(n * lost - slide * rubbed) * weight, share});
  return {dot(u, u), depth / held};
}

template <bool kAlike>
WEFT_INLINE AskFound ask_all(const AskPairs& given) {
  const AskPairs s = given;
  Wide fastest{}, deepest{};
  for (int i = 0; i < s.pairs; i += kLanes) {
    const AskedLanes asked = ask<kAlike>(s, i);
    const WideInt there = lanes_below(s.pairs - i);
    fastest = max(fastest, select(there, asked.speed_squared, Wide{}));
    deepest = max(deepest, select(there, asked.depth, Wide{}));
  }
  return {greatest(fastest), greatest(deepest)};
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

int sum_asked(const SumAsked& given) {
  const SumAsked s = given;
  int first = 0;
  // The weight counts whole, the rest in part.
  const auto add = [&](std::int32_t body, const Eight& asked, float part) {
    if (body < s.begin || body >= s.end) return;
    AskedSum& sum = s.sum[body];
    s.body[first] = body;
    std::int32_t weight;
    __builtin_memcpy(&weight, sum.push + 3, 4);
    first += weight == 0;
    const Eight whole{0, 0, 0, 1};
    const Eight parts{part, part, part, part, part, part, part, part};
    *reinterpret_cast<Eight*>(sum.push) +=
        asked * __builtin_shufflevector(parts, whole, 0, 1, 2, 11, 4, 5, 6, 7);
  };
  for (int i = 0; i < s.pairs; ++i) {
    const Eight& asked = *reinterpret_cast<const Eight*>(s.asked[i].push);
    const float share = s.asked[i].gain[3];
    add(s.owner[i], asked, share);
    add(s.neighbour[i], asked, share - 1);
  }
  return first;
}

// By the mean of what each is asked.
void move_bodies(const MoveBodies& given) {
  const MoveBodies s = given;
  for (int n = 0; n < s.bodies; ++n) {
    const std::int32_t body = s.body[n];
    AskedSum& sum = s.sum[body];
    const Four push = load_four(sum.push), gain = load_four(sum.gain);
    *reinterpret_cast<Eight*>(sum.push) = Eight{};
    float* const x = s.place[body].x;
    float* const v = s.motion[body].v;
    const float weight = push[3];
    if (!(v[3] > 0 && weight > 0)) continue;
    const bool course = (s.friction.each ? s.friction.each[body] : s.friction.alike) < 0;
    const float mean = 1 / weight;
    const Four by = push * Four{1, 1, 1, 0} * (mean * (course ? s.course_share : 1));
    const Four faster = course ? by * s.inverse_dt : gain * Four{1, 1, 1, 0} * mean;
    store_four(x, load_four(x) + by);
    store_four(v, load_four(v) + faster);
    s.moved[body / 16] = 1;
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
    for (int group = 0; group < b.columns; group += 16) {
      const std::ptrdiff_t first = j * b.body_stride + group, number = b.first_body + first;
      std::uint8_t& loaded = b.loaded[(j * b.stride + group) / 16];
      if (!(b.moved[number / 16] | b.moved[(number + 15) / 16] | loaded)) continue;
      WideInt loads{};
      for (int i = 0; i < 16 && group + i < b.columns; i += kLanes) {
        const std::ptrdiff_t at = j * b.stride + group + i, body = first + i;
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
        // (What is ahead is a share of the load.)
        loads = loads | (load.x != 0.0f) | (load.y != 0.0f) | (load.z != 0.0f);
      }
      loaded = any(loads);
    }
}

}  // namespace weft::WEFT_KERNELS
