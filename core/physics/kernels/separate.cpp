// Self-collision: how pairs that are too near are pushed apart (Jacobi: every owner looks at the same
// state). The pairs that touch are brought together first, kLanes of them say what they ask for, and
// each owner sums up what its own ask, in their order.
//
//   stiff:   Δx_a = n (t - d) w_a/(w_a + w_b); the velocity into the other is lost, and the tangential
//            velocity loses up to μ times as much as was pressed (Coulomb; μ the mean of both);
//            averaged over the pairs, each weighing as much as it is deep
//   course:  Δx_a = n (t - d), averaged over the pairs and divided by the substeps, velocity included
//            (seeds 001 and 004: the position before stays)
#include "physics/kernels/contact.h"
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::Asked;
using physics::Body;
using physics::PairsWithin;
using physics::SeparateOwners;

// Of the thickness, at once: what starts intersecting comes apart slowly.
constexpr float kMostPush = 0.5f;
constexpr float kTiny = 1e-12f;
constexpr int kStride = sizeof(Body) / sizeof(float);

WEFT_INLINE Wide friction_of(const float* friction, const std::int32_t* owner) {
  Wide r{};
  for (int l = 0; l < kLanes; ++l) r[l] = friction[owner[l]];
  return r;
}

// What kLanes pairs of the room from `at` on ask for; returns their greatest squared relative speed.
WEFT_INLINE Wide ask(const SeparateOwners& s, int at) {
  const std::int32_t *const owner = s.room.owner + at, *const neighbour = s.room.neighbour + at;
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
  const Wide mine = friction_of(s.friction, owner), theirs = friction_of(s.friction, neighbour);
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
  put_records(s.room.asked[at].push, kStride, {n * lift, weight});
  put_records(s.room.asked[at].gain, kStride,
              {(n * lost - slide * rubbed) * (share * weight), Wide{}});
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
    const std::int32_t owner = s.room.owner[i];
    const int goes_on = -int(owner == last);
    const FourInt kept = FourInt{} + goes_on;
    push = (Four)((FourInt)push & kept) + load_four(s.room.asked[i].push);
    gain = (Four)((FourInt)gain & kept) + load_four(s.room.asked[i].gain);
    owners += 1 + goes_on;
    s.room.owner[owners] = last = owner;
    *reinterpret_cast<Four*>(s.room.asked[owners].push) = push;
    *reinterpret_cast<Four*>(s.room.asked[owners].gain) = gain;
  }
  return owners + 1;
}

// Moves an owner by the mean of what it is asked.
WEFT_INLINE void move(const SeparateOwners& s, std::int32_t owner, const Asked& asked) {
  Body& b = s.out[owner];
  const Four push = load_four(asked.push), gain = load_four(asked.gain);
  const float weight = push[3];
  if (b.v[3] <= 0 || !(weight > 0)) return;
  const bool course = s.friction[owner] < 0;
  const float mean = 1 / weight, of_push = mean * (course ? s.course_share : 1);
  const Four pushed = push * Four{of_push, of_push, of_push, 0};
  *reinterpret_cast<Four*>(b.x) += pushed;
  *reinterpret_cast<Four*>(b.v) += course ? pushed * s.inverse_dt : gain * mean;
}

}  // namespace

int pairs_within(const PairsWithin& given) {
  const PairsWithin s = given;
  int count = 0;
  for (int k = 0; k < s.pairs; k += kLanes) {
    const Wide4 p = records_at(s.bodies->x, kStride, s.owner + k);
    const Wide4 q = records_at(s.bodies->x, kStride, s.neighbour + k);
    const Wide distance = (0.5f * s.reach) * (p.last + q.last);
    const Wide3 d = p.xyz - q.xyz;
    const WideInt within = (dot(d, d) < distance * distance) & lanes_below(s.pairs - k);
    store_lanes(s.within_owner + count, within, lanes_at(s.owner + k));
    count += store_lanes(s.within_neighbour + count, within, lanes_at(s.neighbour + k));
  }
  for (int l = 0; l < kLanes; ++l) s.within_owner[count + l] = s.within_neighbour[count + l] = 0;
  return count;
}

float separate(const SeparateOwners& given) {
  const SeparateOwners s = given;
  const int count =
      pairs_within({s.bodies, s.pairs, s.owner, s.neighbour, 1, s.room.owner, s.room.neighbour});
  Wide fastest{};
  for (int i = 0; i < count; i += kLanes)
    fastest = max(fastest, select(lanes_below(count - i), ask(s, i), Wide{}));
  for (int a = s.begin; a < s.end; ++a) s.out[a] = s.bodies[a];
  const int owners = sum_up(s, count);
  for (int i = 0; i < owners; ++i) move(s, s.room.owner[i], s.room.asked[i]);
  return greatest(fastest);
}

}  // namespace weft::WEFT_KERNELS
