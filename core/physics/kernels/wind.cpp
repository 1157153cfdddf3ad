// Air on cloth. A triangle of area A and unit normal n, in air that moves by u against it, n turned
// to the lee side (u·n >= 0), is pushed by
//
//   F = A [drag (u·n)² n + lift (u·n) |u| (n - û (û·n))]
//
// (drag and lift of a flat plate; Wilson et al. 2014, "Simulating wind effects on cloth"). A force
// that would take more than the whole relative motion within one substep is softened: F/(1 + q),
// q the share of the motion that it and the five other triangles at a particle would take.
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

using physics::Gust;
using physics::WindRow;

constexpr float kTinySquare = 1e-20f;

WEFT_INLINE Wide3 cross(Wide3 a, Wide3 b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A wave of period 1 and height 1 of two parabolas a period: smooth, near to a sine, and exact.
WEFT_INLINE Wide wave(Wide phase) {
  const WideInt whole = __builtin_convertvector(phase, WideInt);
  const Wide part = phase - __builtin_convertvector(whole, Wide);  // -1 … 1
  const Wide s = select(part > 0.0f, part, part + 1.0f) - 0.5f;    // -0.5 … 0.5
  return s * (8.0f - 16.0f * abs(s));
}

WEFT_INLINE Wide3 gust(const WindRow& r, Wide3 x) {
  Wide sum[3] = {};
  for (int n = 0; n < physics::kGusts; ++n) {
    const Gust& g = r.gusts[n];
    sum[n % 3] = sum[n % 3] + wave(x.x * g.kx + x.y * g.ky + x.z * g.kz + g.at);
  }
  return Wide3{sum[0], sum[1], sum[2]} * wide(r.gust_speed * 0.5f);
}

// A third of the force on the triangle a, b, c with velocities' sum v3 and inverse masses' sum w3.
WEFT_INLINE Wide3 third_of_force(const WindRow& r, Wide3 air, Wide3 a, Wide3 b, Wide3 c, Wide3 v3,
                                 Wide w3) {
  const Wide third = wide(1.0f / 3.0f);
  const Wide3 doubled = cross(b - a, c - a);
  const Wide size = sqrt(max(dot(doubled, doubled), wide(kTinySquare)));
  const Wide3 u = air - v3 * third;
  const Wide along = dot(u, doubled) / size;
  const Wide3 n = select(along < 0.0f, doubled * (-1.0f / size), doubled * (1.0f / size));
  const Wide into = abs(along);
  const Wide square = max(dot(u, u), wide(kTinySquare)), speed = sqrt(square);
  const Wide3 across = n - u * (into / square);
  const Wide area = size * 0.5f;
  const Wide taken = (r.drag * into + r.lift * speed) * area * w3 * (r.dt * 6.0f / 9.0f);
  const Wide scale = area * into * third * r.steps / (1.0f + taken);
  return n * (scale * (r.drag * into)) + across * (scale * (r.lift * speed));
}

}  // namespace

void wind(const WindRow& given) {
  const WindRow r = given;
  Delay3<1> own_right, next_right;
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const WideInt inside = lanes_below(r.columns - 1 - i);
    const Wide3 x00 = load3(r.x, i), x10 = load3(r.x, i + 1);
    const Wide3 x01 = load3(r.x_next, i), x11 = load3(r.x_next, i + 1);
    const Wide3 v10 = load3(r.v, i + 1), v01 = load3(r.v_next, i);
    const Wide w10 = load(r.w + i + 1), w01 = load(r.w_next + i);
    // Both triangles of a square feel the air in the middle of the edge between them.
    Wide3 air = wide3(r.wx, r.wy, r.wz);
    if (r.gust_speed > 0) air = air + gust(r, (x10 + x01) * wide(0.5f));
    const Wide3 first = select(
        inside,
        third_of_force(r, air, x00, x10, x01, load3(r.v, i) + v10 + v01, load(r.w + i) + w10 + w01),
        Wide3{});
    const Wide3 second =
        select(inside,
               third_of_force(r, air, x10, x11, x01, v10 + load3(r.v_next, i + 1) + v01,
                              w10 + load(r.w_next + i + 1) + w01),
               Wide3{});
    const Wide3 both = first + second;
    store3(r.f, i, load3(r.f, i) + (first + own_right.next(both)));
    store3(r.f_next, i, load3(r.f_next, i) + (both + next_right.next(second)));
  }
}

void push(const AdvanceRow& r) {
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 gained = load3(r.f, i) * (load(r.w + i) * r.advance.dt);
    if (r.inverse_dt > 0) store3(r.v, i, load3(r.v, i) + gained);
    store3(r.x, i, load3(r.x, i) + gained * wide(r.advance.dt));
    store3(r.f, i, Wide3{});
  }
}

}  // namespace weft::WEFT_KERNELS
