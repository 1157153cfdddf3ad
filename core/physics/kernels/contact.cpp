// Contact of one row with one collider. Positions x and velocities v are consistent, so that
// x - dt v is the position before the substep.
//
// Coulomb: a particle below the surface is lifted onto it along the normal n by `depth`, loses its
// velocity into the surface, and its tangential motion relative to the surface, t, shrinks by
// friction: all of it while |t| <= μ_s depth, else by μ_d depth, never reversed (seed 003).
// Course: the correction from the position before is scaled by 1 - μ (seeds 001 and 004).
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {
namespace {

constexpr float kTiny = 1e-30f;

WEFT_INLINE Wide3 wide3(float x, float y, float z) { return {wide(x), wide(y), wide(z)}; }

WEFT_INLINE void rub(const CollideRow& r, int i, WideInt touching, Wide depth, Wide3 n) {
  const Wide3 u = wide3(r.ux, r.uy, r.uz);
  const Wide3 v = load3(r.v, i);
  const Wide3 relative = v - u;
  const Wide into = dot(relative, n);
  const Wide3 tangential = relative - n * into;
  const Wide distance = sqrt(max(dot(tangential, tangential), wide(kTiny))) * r.dt;
  const Wide slide = max(Wide{}, 1.0f - r.friction_dynamic * depth / distance);
  const Wide keep = select(distance <= r.friction_static * depth, Wide{}, slide);
  const Wide3 rubbed = tangential * keep;
  const Wide3 x = load3(r.x, i);
  store3(r.x, i, select(touching, x + n * depth + (rubbed - tangential) * wide(r.dt), x));
  store3(r.v, i, select(touching, u + rubbed + n * max(into, Wide{}), v));
}

// The position becomes before + (target - before) (1 - friction), the velocity follows.
WEFT_INLINE void course_correct(const CollideRow& r, int i, WideInt touching, Wide3 target) {
  const Wide3 x = load3(r.x, i), v = load3(r.v, i);
  const Wide3 before = x - v * wide(r.dt);
  const Wide3 correction = (target - before) * wide(1.0f - r.friction_dynamic);
  store3(r.x, i, select(touching, before + correction, x));
  store3(r.v, i, select(touching, correction * wide(r.inverse_dt), v));
}

WEFT_INLINE WideInt free_lanes(const CollideRow& r, int i) {
  return (load(r.w + i) > 0.0f) & lanes_below(r.columns - i);
}

}  // namespace

void sphere(const CollideRow& r) {
  const Wide3 center = wide3(r.cx, r.cy, r.cz);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 d = load3(r.x, i) - center;
    const Wide squared = dot(d, d);
    const WideInt touching = (squared < r.radius * r.radius) & free_lanes(r, i);
    if (!any(touching)) continue;
    const Wide distance = sqrt(squared);
    // At the very center no direction is better than another: up.
    const WideInt apart = squared > kTiny;
    const Wide3 n = select(apart, d * (1.0f / select(apart, distance, wide(1))), wide3(0, 1, 0));
    rub(r, i, touching, r.radius - distance, n);
  }
}

void plane(const CollideRow& r) {
  const Wide3 point = wide3(r.cx, r.cy, r.cz), n = wide3(r.nx, r.ny, r.nz);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide depth = r.offset - dot(load3(r.x, i) - point, n);
    const WideInt touching = (depth > 0.0f) & free_lanes(r, i);
    if (any(touching)) rub(r, i, touching, depth, n);
  }
}

void course_sphere(const CollideRow& r) {
  const Wide3 center = wide3(r.cx, r.cy, r.cz);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 d = load3(r.x, i) - center;
    const Wide squared = dot(d, d);
    const WideInt touching = (squared <= r.radius * r.radius) & free_lanes(r, i);
    if (!any(touching)) continue;
    const WideInt apart = squared > kTiny;
    const Wide scale = r.radius / select(apart, sqrt(squared), wide(1));
    course_correct(r, i, touching, center + select(apart, d * scale, wide3(0, r.radius, 0)));
  }
}

// A particle whose path crossed the plane goes to the crossing, less the offset along its path; one
// that something else pushed below goes straight back up.
void course_plane(const CollideRow& r) {
  const Wide3 point = wide3(r.cx, r.cy, r.cz), n = wide3(r.nx, r.ny, r.nz);
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const Wide3 x = load3(r.x, i), path = load3(r.v, i) * wide(r.dt), before = x - path;
    const Wide height = dot(x - point, n), height_before = dot(before - point, n);
    const WideInt free = free_lanes(r, i);
    const WideInt crossed = (height * height_before <= 0.0f) & (height != height_before) & free;
    const WideInt sunk = (height < 0.0f) & (height_before < 0.0f) & free;
    if (any(crossed)) {
      const Wide length = max(sqrt(dot(path, path)), wide(kTiny));
      const Wide fall = select(crossed, height_before - height, wide(1));
      const Wide reach = height_before / fall - r.offset / length;
      course_correct(r, i, crossed, before + path * reach);
    }
    if (any(sunk)) store3(r.x, i, select(sunk, x + n * (r.offset - height), load3(r.x, i)));
  }
}

}  // namespace weft::WEFT_KERNELS
