// Air on cloth. A triangle of area A and unit normal n, in air that moves by u against it, n turned
// to the lee side (u·n >= 0), is pushed by
//
//   F = A [drag (u·n)² n + lift (u·n) |u| (n - û (û·n))]
//
// (drag and lift of a flat plate; Wilson et al. 2014, "Simulating wind effects on cloth"), a third of
// it at each corner; on a grid, of both triangles of a square a quarter at each of its corners, so that particles
// are pushed by the area that they stand for. A particle gains
//
//   w T ΣF / (1 + a + b²),  a = w T Σ A/3 drag (u·n),  b = w T Σ A/3 lift |u|
//
// by drag, as much as in the exact motion of a plate against still air; by both, never more than the whole
// relative motion. With order 2, where air pushes in every substep, drag is that of the velocity after the push, as
// constraint forces are those of the positions after it: 1 + a becomes (1 + 2a + √(1 + 4a))/2.
#include "physics/kernels/gather.h"
#include "physics/kernels/mesh.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::Air;
using physics::AirRow;
using physics::Gust;
using physics::PushRow;
using physics::WindRow;

constexpr float kTinySquare = 1e-20f;

// A wave of period 1 and height 1 of two parabolas a period: smooth, near to a sine, and exact.
WEFT_INLINE Wide wave(Wide phase) {
  const Wide part = phase - __builtin_convertvector(whole(phase), Wide);  // -1 … 1
  const Wide s = select(part > 0.0f, part, part + 1.0f) - 0.5f;           // -0.5 … 0.5
  return s * (8.0f - 16.0f * abs(s));
}

WEFT_INLINE Wide3 gust(const Air& r, Wide3 x) {
  Wide sum[3] = {};
  for (int n = 0; n < physics::kGusts; ++n) {
    const Gust& g = r.gusts[n];
    sum[n % 3] = sum[n % 3] + wave(x.x * g.kx + x.y * g.ky + x.z * g.kz + g.at);
  }
  return Wide3{sum[0], sum[1], sum[2]} * wide(r.gust_speed * 0.5f);
}

// What a triangle does to each of its corners.
struct Third {
  Wide3 force;
  Wide drag, lift;
};

WEFT_INLINE Third operator+(const Third& a, const Third& b) {
  return {a.force + b.force, a.drag + b.drag, a.lift + b.lift};
}

// Of the triangle a, b, c with velocities' sum v3.
WEFT_INLINE Third third_of(const Air& r, WideInt inside, Wide3 air, Wide3 a, Wide3 b, Wide3 c,
                           Wide3 v3) {
  const Wide third = wide(1.0f / 3.0f);
  const Wide3 doubled = cross(b - a, c - a);
  const Wide size = sqrt(max(dot(doubled, doubled), wide(kTinySquare)));
  const Wide3 u = air - v3 * third;
  const Wide along = dot(u, doubled) / size;
  const Wide3 n = select(along < 0.0f, doubled * (-1.0f / size), doubled * (1.0f / size));
  const Wide into = abs(along);
  const Wide square = max(dot(u, u), wide(kTinySquare)), speed = sqrt(square);
  const Wide3 across = n - u * (into / square);
  const Wide area = select(inside, size * (0.5f / 3.0f), Wide{});
  const Wide drag = area * (r.drag * into), lift = area * (r.lift * speed);
  return {n * (into * drag) + across * (into * lift), drag, lift};
}

WEFT_INLINE Third operator*(const Third& a, float factor) {
  return {a.force * wide(factor), a.drag * factor, a.lift * factor};
}

class Delayed {
 public:
  WEFT_INLINE Third next(const Third& t) {
    return {force_.next(t.force), drag_.next(t.drag), lift_.next(t.lift)};
  }

 private:
  Delay3<1> force_;
  Delay<1> drag_, lift_;
};

WEFT_INLINE void add(const AirRow& air, int i, const Third& t) {
  store3(air.f, i, load3(air.f, i) + t.force);
  store(air.drag + i, load(air.drag + i) + t.drag);
  store(air.lift + i, load(air.lift + i) + t.lift);
}

// Adds the first `count` lanes where they belong.
WEFT_INLINE void scatter(float* to, const std::int32_t* at, int count, Wide value) {
  alignas(64) float values[kLanes];
  store(values, value);
  for (int l = 0; l < count; ++l) to[at[l]] += values[l];
}

}  // namespace

// Triangles of a batch share no corner: sums are added in the order of batches, whatever the lanes.
void mesh_wind(const physics::MeshWind& r) {
  for (const physics::MeshAirBatch* b = r.batches; b < r.batches + r.count; ++b)
    for (int lane = 0; lane < b->count; lane += kLanes) {
      Wide3 x[3], v3{};
      for (int k = 0; k < 3; ++k) {
        x[k] = gathered(r.x, b->corner[k] + lane);
        v3 = v3 + gathered(r.v, b->corner[k] + lane);
      }
      Wide3 air = wide3(r.wx, r.wy, r.wz);
      if (r.gust_speed > 0) air = air + gust(r, (x[0] + x[1] + x[2]) * wide(1.0f / 3.0f));
      const int count = b->count - lane < kLanes ? b->count - lane : kLanes;
      const Third t = third_of(r, lanes_below(count), air, x[0], x[1], x[2], v3);
      for (int k = 0; k < 3; ++k) {
        const std::int32_t* const at = b->sum[k] + lane;
        scatter(r.sums.f.x, at, count, t.force.x);
        scatter(r.sums.f.y, at, count, t.force.y);
        scatter(r.sums.f.z, at, count, t.force.z);
        scatter(r.sums.drag, at, count, t.drag);
        scatter(r.sums.lift, at, count, t.lift);
      }
    }
}

void wind(const WindRow& given) {
  const WindRow r = given;
  Delayed own_right, next_right;
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const WideInt inside = lanes_below(r.columns - 1 - i);
    const Wide3 x00 = load3(r.x, i), x10 = load3(r.x, i + 1);
    const Wide3 x01 = load3(r.x_next, i), x11 = load3(r.x_next, i + 1);
    const Wide3 v10 = load3(r.v, i + 1), v01 = load3(r.v_next, i);
    // Both triangles of a square feel the air in the middle of the edge between them.
    Wide3 air = wide3(r.wx, r.wy, r.wz);
    if (r.gust_speed > 0) air = air + gust(r, (x10 + x01) * wide(0.5f));
    const Third first = third_of(r, inside, air, x00, x10, x01, load3(r.v, i) + v10 + v01);
    const Third second =
        third_of(r, inside, air, x10, x11, x01, v10 + load3(r.v_next, i + 1) + v01);
    const Third quarter = (first + second) * 0.75f;
    add(r.air, i, quarter + own_right.next(quarter));
    add(r.air_next, i, quarter + next_right.next(quarter));
  }
}

void push(const PushRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide w = load(r.w + i), time = w * r.time, resists = w * r.resists;
    const Wide drag = resists * load(r.air.drag + i), lift = resists * load(r.air.lift + i);
    const Wide slowed = r.at_end ? 0.5f + drag + 0.5f * sqrt(1.0f + 4.0f * drag) : 1.0f + drag;
    const Wide3 gained = load3(r.air.f, i) * (time / (slowed + lift * lift));
    store3(r.v, i, load3(r.v, i) + gained);
    store3(r.x, i, load3(r.x, i) + gained * wide(r.dt));
    store3(r.air.f, i, Wide3{});
    for (float* sum : {r.air.drag, r.air.lift}) store(sum + i, Wide{});
  }
}

}  // namespace weft::WEFT_KERNELS
