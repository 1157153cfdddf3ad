// Contact of one row with one collider, for any shape. A shape is a struct of constants with
//
//   Surface at(Wide3 p) const       signed distance [m] and outward unit normal at p, seen from its
//                                   place
//   static constexpr bool kFlat     whether the normal is the same everywhere: a half-space, which
//                                   nothing passes through
//
// or, where it has been found for every particle before,
//
//   Surface now(int i), before(int i) const    the same for lanes i … at the end and the start of a substep
//
// Positions x and velocities v are consistent, so that x - dt v is the position before the substep.
//
// Coulomb: a particle below the surface is lifted onto it along the normal n by `depth`, loses its
// velocity into the surface, and its tangential motion relative to the surface, t, shrinks by
// friction: all of it while |t| <= μ_s p, else by μ_d p, never reversed (seed 003). p, the normal
// impulse over the mass and times dt, is the way lost into the surface. The depth would be the same,
// but in short substeps it is the rounding of positions.
// One that slides over a surface that the mesh resolves is pushed along the normal where it was
// before, and goes on along the chord between the two places (SHAKE: Ryckaert et al. 1977). That is of
// second order in the substep, and neither takes energy nor gives any; pushed along the normal at the
// later place it would gain speed.
// Course: the correction from the position before is scaled by 1 - μ (seeds 001 and 004).
//
// A particle that went right through is found by following its path, seen from the collider, in
// steps as long as the distance that is left (sphere tracing: Hart 1996); it is put back before the
// surface that it entered by.
#pragma once

#include "physics/kernels/carried.h"
#include "physics/kernels/root.h"
#include "physics/kernels/row_kernels.h"
#include "physics/kernels/shape_kernels.h"

namespace weft::WEFT_KERNELS {

constexpr float kTinySquare = 1e-30f, kFar = 1e30f;

struct Surface {
  Wide distance;
  Wide3 normal;
};

// `radius` from the point that d comes from; where its square is no more than `least`, along `otherwise`.
WEFT_INLINE Surface around(Wide3 d, Wide radius, Wide least, Wide3 otherwise) {
  const Wide squared = dot(d, d);
  const WideInt apart = squared > least;
  const Wide reciprocal = reciprocal_root(select(apart, squared, wide(1)));
  return {select(apart, squared * reciprocal, Wide{}) - radius,
          select(apart, d * reciprocal, otherwise)};
}

// At the very point no direction is better than another: up.
WEFT_INLINE Surface around(Wide3 d, Wide radius) {
  return around(d, radius, wide(kTinySquare), wide3(0, 1, 0));
}

// The square of what rounding leaves across an axis, 1e-5 of the way p from its end: single precision leaves a
// hundredth of that.
WEFT_INLINE Wide rounding_across(Wide3 p) {
  return max(dot(p, p) * 1e-10f, wide(kTinySquare));
}

template <class Shape>
concept Found = requires(const Shape& shape) {
  shape.now(0);
};

// The surface for lanes i …, which are at p, and which were at p before the substep.
template <class Shape>
WEFT_INLINE Surface surface_now(const Shape& shape, Wide3 p, int i) {
  if constexpr (Found<Shape>)
    return shape.now(i);
  else
    return shape.at(p);
}
template <class Shape>
WEFT_INLINE Surface surface_before(const Shape& shape, Wide3 p, int i) {
  if constexpr (Found<Shape>)
    return shape.before(i);
  else
    return shape.at(p);
}

// Velocity of the surface beside the collider's: meshes may change their form.
template <class Shape>
WEFT_INLINE Wide3 own_velocity(const Shape& shape, int i) {
  if constexpr (Found<Shape>) return shape.velocity(i);
  return Wide3{};
}

// How touching particles are pushed onto the surface: by `depth` along the unit `normal`. `across` is
// normal to the way on, and as long as its part along `normal` is 1. `slides`: who goes along a chord.
struct Push {
  Wide depth;
  Wide3 normal, across;
  WideInt slides;
};

constexpr float kSlides = 0.01f;       // of its path: what began no farther from the surface slides
constexpr float kSharpestTurn = 0.5f;  // cosine of the angle between its normals, at least

// Of those that are pushed `straight` at the end of their paths, the ones that slide are pushed as is said
// above. `before`: the surface at the start of their paths; `way`: the square of how far they went past the collider's
// place, for who slides must not depend on how fast a body turns beneath.
WEFT_INLINE Push along_chords(const CollideRow& r, const Surface& before, Wide way,
                              const Push& straight) {
  // A body that turns pushed that way, whose path is seen from the body as it stands at the end.
  const Wide3 normal = turned_back(r, before.normal);
  const Wide turn = dot(normal, straight.normal);
  const Wide left = max(before.distance - r.offset, Wide{});
  const WideInt slides = (turn > kSharpestTurn) & (left * left <= way * (kSlides * kSlides));
  const Wide3 both = before.normal + straight.normal;
  const Wide3 middle = both * (1.0f / (r.turns ? dot(both, normal) : 1.0f + turn));
  return {straight.depth / select(slides, turn, wide(1)), select(slides, normal, straight.normal),
          select(slides, middle, straight.across), slides};
}

// Of a place's square: what eight units in the last place come to, squared; and less than what moves any.
constexpr float kRounding = 1e-12f, kNothing = 1e-16f;

// What sticks to a surface at rest stays where it was, unless that is off the surface by more than rounding: else
// positions would wander by a unit in the last place or two in every substep, and stretch what lies there until it slides.
WEFT_INLINE void rub(const CollideRow& r, int i, Wide3 u, WideInt touching, const Push& push) {
  const Wide3 n = push.normal;
  const Wide3 v = load3(r.v, i);
  const Wide3 relative = v - u;
  const Wide into = dot(relative, push.across);
  const Wide3 tangential = relative - n * into;
  const Wide distance = sqrt(max(dot(tangential, tangential), wide(kTinySquare))) * r.dt;
  const Wide pressed = max(into * -r.dt, Wide{});
  const Wide holds = r.friction_static * pressed;
  // As contact/friction.h has it.
  const Wide taken = max(r.friction_dynamic * pressed, 2.0f * holds - distance);
  const WideInt sticks = distance <= holds;
  const Wide3 rubbed = tangential * select(sticks, Wide{}, max(Wide{}, 1.0f - taken / distance));
  const Wide3 x = load3(r.x, i), before = x - v * wide(r.dt);
  const Wide off = push.depth + into * r.dt;
  const WideInt stands = dot(u, u) * (r.dt * r.dt) <= dot(x, x) * kNothing;
  const WideInt rests = sticks & stands & (off * off <= dot(x, x) * kRounding);
  const Wide3 moved = x + n * push.depth + (rubbed - tangential) * wide(r.dt);
  store3(r.x, i, select(touching, select(rests, before, moved), x));
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

// Where paths enter a shape: the depth of their ends below the plane that touches it there.
struct Entry {
  WideInt caught;
  Wide depth;
  Wide3 normal;
};

constexpr int kPathSteps = 32;           // of sphere tracing
constexpr float kPathTolerance = 1e-3f;  // of the path's length, from the surface
constexpr float kStartsInside = 0.25f;   // of the path's length: deeper starts are no entries
constexpr float kSteepest = 0.05f;       // sine below which a path only grazes

template <class Shape>
WEFT_INLINE Entry entry(const CollideRow& r, const Shape& shape, Wide3 end, Wide3 path,
                        WideInt wanted) {
  const Wide length = max(sqrt(dot(path, path)), wide(kTinySquare));
  const Wide3 start = end - path;
  Entry e{WideInt{}, Wide{}, Wide3{}};
  Wide t{};
  WideInt pending = wanted & (shape.at(start).distance - r.offset > length * -kStartsInside);
  for (int step = 0; step < kPathSteps && any(pending); ++step) {
    const Wide3 at = start + path * t;
    const Surface s = shape.at(at);
    const Wide left = s.distance - r.offset;
    pending = pending & (dot(path, s.normal) < length * -kSteepest);
    const WideInt hit = pending & (left <= length * kPathTolerance);
    e.caught = e.caught | hit;
    e.depth = select(hit, dot(at - end, s.normal) - left, e.depth);
    e.normal = select(hit, s.normal, e.normal);
    pending = pending & ~hit;
    t = t + select(pending, left / length, Wide{});
    pending = pending & (t < 1.0f);
  }
  return e;
}

template <class Shape, bool kCourse>
WEFT_INLINE RowReach collide_row(const CollideRow& r) {
  const Shape shape(r.shape);
  const Wide3 place = wide3(r.cx, r.cy, r.cz);
  const float shortest = 0.25f * r.shape.thin * r.shape.thin;
  Wide clearance = wide(kFar), fastest{};
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const WideInt free = free_lanes(r, i);
    const Wide3 p = load3(r.x, i) - place;
    const Surface s = surface_now(shape, p, i);
    const Wide left = s.distance - r.offset;
    const Wide3 v = load3(r.v, i), u = carried(r, p, v), relative = v - u;
    const Wide speed = dot(relative, relative);
    clearance = min(clearance, select(free, left, wide(kFar)));
    fastest = max(fastest, select(free, past_place(r, v), Wide{}));
    const WideInt below = free & (left < 0.0f);
    WideInt touching = below;
    Push push{-left, s.normal, s.normal, WideInt{}};
    if constexpr (!Shape::kFlat && !Found<Shape>) {
      // Only a particle that moves away from the surface nearest to it can have come through, and
      // only on a path that is long against the shape.
      const Wide path = speed * (r.dt * r.dt);
      const WideInt leaving =
          free & (path > shortest) & (left * left < path) & (dot(relative, s.normal) > 0.0f);
      if (any(leaving)) {
        const Entry e = entry(r, shape, p, relative * wide(r.dt), leaving);
        touching = touching | e.caught;
        push = {select(e.caught, e.depth, push.depth), select(e.caught, e.normal, push.normal),
                select(e.caught, e.normal, push.across), push.slides};
      }
    }
    if (!any(touching)) continue;
    if constexpr (kCourse) {
      course_correct(r, i, touching, load3(r.x, i) + push.normal * push.depth);
    } else {
      const Wide3 own = own_velocity(shape, i), path = (relative - own) * wide(r.dt);
      Wide3 surface = u + own;
      if (!Shape::kFlat && r.resolved) {
        const Wide3 past = r.turns ? (v - place_velocity(r) - own) * wide(r.dt) : path;
        push = along_chords(r, surface_before(shape, p - path, i), dot(past, past), push);
      }
      if (r.turns) {
        const Wide out = dot(faster_at_end(r, p, u), push.normal);
        surface = surface + push.normal * select(push.slides, Wide{}, out);
      }
      rub(r, i, surface, touching, push);
    }
  }
  return {least(clearance), __builtin_sqrtf(greatest(fastest)) + r.rim};
}

// Within a layer about the surface velocities along it are damped; positions before the substep stay.
template <class Shape>
WEFT_INLINE RowReach damp_sliding_row(const CollideRow& r) {
  const Shape shape(r.shape);
  const Wide3 place = wide3(r.cx, r.cy, r.cz);
  Wide clearance = wide(kFar), fastest{};
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const WideInt free = free_lanes(r, i);
    const Wide3 x = load3(r.x, i), v = load3(r.v, i), p = x - place;
    const Surface s = surface_now(shape, p, i);
    const Wide left = s.distance - (r.offset + r.bias);
    clearance = min(clearance, select(free, left, wide(kFar)));
    fastest = max(fastest, select(free, past_place(r, v), Wide{}));
    const WideInt within = free & (left < 0.0f);
    if (!any(within)) continue;
    const Wide3 slid = v - carried(r, p, v) - own_velocity(shape, i);
    const Wide3 lost = (slid - s.normal * dot(slid, s.normal)) * wide(r.damped);
    store3(r.v, i, select(within, v - lost, v));
    store3(r.x, i, select(within, x - lost * wide(r.dt), x));
  }
  return {least(clearance), __builtin_sqrtf(greatest(fastest)) + r.rim};
}

}  // namespace weft::WEFT_KERNELS
