// Self-collision: how pairs that are too near are pushed apart (Jacobi: every owner looks at the same
// state), 16 owners at a time.
//
//   stiff:   Δx_a = n (t - d) w_a/(w_a + w_b); the velocity into the other is lost, and the tangential
//            velocity loses up to μ times as much as was pressed (Coulomb); averaged over the pairs,
//            each weighing as much as it is deep
//   course:  Δx_a = n (t - d), averaged over the pairs and divided by the substeps, velocity included
//            (seeds 001 and 004: the position before stays)
#include "physics/kernels/contact.h"
#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::Body;
using physics::SeparateGroup;

// Of the thickness, at once: what starts intersecting comes apart slowly.
constexpr float kMostPush = 0.5f;
constexpr float kTiny = 1e-12f;
constexpr int kStride = sizeof(Body) / sizeof(float);

// What all pairs of an owner ask for.
struct Sum {
  Wide3 push = wide3(0, 0, 0), gain = wide3(0, 0, 0);
  Wide weight{};
  Wide speed{};  // greatest squared relative speed [m²/s²]
};

struct Owner {
  Wide3 x, v;
  Wide thickness, w, friction, held;
  WideInt number, course;
};

WEFT_INLINE void add_pair(const Owner& p, const Body* bodies, const std::int32_t* number,
                          Sum& sum) {
  const Wide4 q = records_at(bodies->x, kStride, number);
  const Wide held = 0.5f * (p.thickness + q.last) * p.held;
  Wide3 d = p.x - q.xyz;
  const Wide square = dot(d, d);
  const WideInt touch = square < held * held;
  if (!any(touch)) return;
  const Wide4 motion = records_at(bodies->v, kStride, number);
  // In one place: apart along y, by their order.
  const WideInt together = square < kTiny * kTiny;
  const Wide distance = select(together, Wide{}, sqrt(square));
  if (any(together)) {
    const WideInt later = lanes_at(number) > p.number;
    d = select(together, {Wide{}, select(later, wide(1), wide(-1)), Wide{}}, d);
  }
  const Wide3 n = d * (1.0f / select(together, wide(1), distance));
  const Wide depth = held - distance;
  const Wide share = p.w / (p.w + motion.last);
  const Wide weight = select(p.course, wide(1), depth);
  const Wide lift = select(p.course, depth, min(depth, kMostPush * held) * share) * weight;
  const Wide3 u = p.v - motion.xyz;
  const Wide into = dot(u, n);
  const Wide3 slide = u - n * into;
  const Wide lost = max(Wide{}, -into);
  Wide rubbed{};
  if (any(touch & (lost * p.friction > 0.0f))) {
    const Wide sliding = sqrt(dot(slide, slide));
    rubbed = select(sliding > kTiny, min(wide(1), p.friction * lost / sliding), Wide{});
  }
  const Wide3 nothing = wide3(0, 0, 0);
  sum.push = sum.push + select(touch, n * lift, nothing);
  sum.gain = sum.gain + select(touch, (n * lost - slide * rubbed) * (share * weight), nothing);
  sum.weight = sum.weight + select(touch, weight, Wide{});
  sum.speed = max(sum.speed, select(touch, dot(u, u), Wide{}));
}

}  // namespace

float separate(const SeparateGroup& g) {
  float fastest = 0;
  alignas(64) std::int32_t own[16];
  for (int l = 0; l < 16; ++l) own[l] = g.first + l;
  for (int i = 0; i < 16; i += kLanes) {
    const Wide4 place = records_at(g.bodies->x, kStride, own + i);
    const Wide4 motion = records_at(g.bodies->v, kStride, own + i);
    Owner p{place.xyz,
            motion.xyz,
            place.last,
            motion.last,
            load(g.friction + i),
            Wide{},
            lanes_at(own + i),
            lanes_at(g.course + i)};
    p.held = select(p.course, wide(1), wide(physics::kHeld));
    Sum sum;
    for (int k = 0; k < g.slots; ++k) add_pair(p, g.bodies, g.neighbour + 16 * k + i, sum);
    const WideInt moves = (sum.weight > 0.0f) & (p.w > 0.0f);
    const Wide mean = 1.0f / sum.weight;
    const Wide3 pushed = sum.push * (mean * select(p.course, wide(g.course_share), wide(1)));
    const Wide3 faster{select(p.course, pushed.x * g.inverse_dt, sum.gain.x * mean),
                       select(p.course, pushed.y * g.inverse_dt, sum.gain.y * mean),
                       select(p.course, pushed.z * g.inverse_dt, sum.gain.z * mean)};
    const Wide3 x = select(moves, p.x + pushed, p.x), v = select(moves, p.v + faster, p.v);
    for (int l = 0; l < kLanes; ++l)
      g.out[i + l] = {{x.x[l], x.y[l], x.z[l], p.thickness[l]}, {v.x[l], v.y[l], v.z[l], p.w[l]}};
    const float speed = greatest(sum.speed);
    fastest = fastest < speed ? speed : fastest;
  }
  return fastest;
}

}  // namespace weft::WEFT_KERNELS
