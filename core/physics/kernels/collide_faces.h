// The triangles of cloth between two rows and one collider, for any shape of collide.h: how near they come; and all
// kernels of a shape.
#pragma once

#include "physics/kernels/collide.h"

namespace weft::WEFT_KERNELS {

// A convex shape's distance is never below its tangents: d(y) >= d(p) + n(p)·(y - p). On a triangle the tangent
// at any p is least at a vertex, so that d >= d(p) + min over vertices W of n(p)·(W - p). The vertices as p
// are enough for sheets on a flat side. Where they say too little, p descends: a step against the normal, and
// back to the nearest point of the triangle.
struct Face {
  Wide3 a, b, c;
};

WEFT_INLINE Wide tangent_bound(const Surface& at, Wide3 p, const Face& f) {
  return at.distance +
         min(dot(f.a - p, at.normal), min(dot(f.b - p, at.normal), dot(f.c - p, at.normal)));
}

WEFT_INLINE Wide within_unit(Wide t) {
  return min(max(t, Wide{}), wide(1));
}

// The point of a face nearest to q: in its plane, or on one of its sides.
WEFT_INLINE Wide3 nearest_on(const Face& f, Wide3 q) {
  const Wide3 ab = f.b - f.a, ac = f.c - f.a, bc = f.c - f.b, aq = q - f.a;
  const Wide bb = dot(ab, ab), bd = dot(ab, ac), cc = dot(ac, ac);
  const Wide qb = dot(aq, ab), qc = dot(aq, ac);
  const Wide scale = 1.0f / (bb * cc - bd * bd);
  const Wide v = (cc * qb - bd * qc) * scale, w = (bb * qc - bd * qb) * scale;
  Wide3 best = f.a + ab * within_unit(qb / bb);
  Wide least = dot(best - q, best - q);
  const Wide3 others[2] = {f.a + ac * within_unit(qc / cc),
                           f.b + bc * within_unit(dot(q - f.b, bc) / dot(bc, bc))};
  for (const Wide3& side : others) {
    const Wide square = dot(side - q, side - q);
    best = select(square < least, side, best);
    least = min(square, least);
  }
  return select((v >= 0.0f) & (w >= 0.0f) & (v + w <= 1.0f), f.a + ab * v + ac * w, best);
}

constexpr int kDescents = 6;

// Raises bounds of faces below `enough`, as far as a few descents do.
template <class Shape>
WEFT_INLINE Wide descend(const Shape& shape, const FacesRow& f, const Face& face, WideInt wanted,
                         Wide bound, float enough) {
  WideInt pending = wanted & (bound < enough);
  Wide3 p = (face.a + face.b + face.c) * wide(1.0f / 3.0f);
  const Wide least = wide(0.1f * f.edge);
  for (int n = 0; any(pending); ++n) {
    const Surface s = shape.at(p);
    bound = select(pending, max(tangent_bound(s, p, face), bound), bound);
    pending = pending & (bound < enough);
    if (n + 1 == kDescents || !any(pending)) break;
    p = nearest_on(face, p - s.normal * max(s.distance + f.row.shape.radius, least));
  }
  return bound;
}

// The same for triangles of a row by number: the first (2a) or second (2a+1) beside lane a, brought together.
template <class Shape>
WEFT_INLINE void descend_listed(const Shape& shape, const FacesRow& f, Wide3 place, int count,
                                float enough) {
  const ConstRow3 x[2] = {f.row.x, f.x_next};
  for (int k = 0; k < count; k += kLanes) {
    alignas(64) float corner[3][3][kLanes], bound[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      const std::int32_t number = f.room[k + l < count ? k + l : k];
      const int a = number / 2, second = number % 2;
      const int row[3] = {0, second, 1}, lane[3] = {a + second, a + 1, a};
      for (int n = 0; n < 3; ++n) {
        corner[n][0][l] = x[row[n]].x[lane[n]];
        corner[n][1][l] = x[row[n]].y[lane[n]];
        corner[n][2][l] = x[row[n]].z[lane[n]];
      }
      bound[l] = f.bound[second][a];
    }
    const auto at = [&](int n) {
      return Wide3{load(corner[n][0]), load(corner[n][1]), load(corner[n][2])} - place;
    };
    const Face face{at(0), at(1), at(2)};
    const Wide raised =
        descend(shape, f, face, lanes_below(count - k), load(bound), enough) - f.row.offset;
    for (int l = 0; l < kLanes && k + l < count; ++l)
      f.bound[f.room[k + l] % 2][f.room[k + l] / 2] = raised[l];
  }
}

// The lanes one further on, the last from the block that follows.
template <int... I>
WEFT_INLINE Wide one_on(Wide here, Wide next, std::integer_sequence<int, I...>) {
  return __builtin_shufflevector(here, next, (I + 1)...);
}
WEFT_INLINE Surface one_on(const Surface& here, const Surface& next) {
  constexpr std::make_integer_sequence<int, kLanes> lanes;
  const Wide3 &a = here.normal, &b = next.normal;
  return {one_on(here.distance, next.distance, lanes),
          {one_on(a.x, b.x, lanes), one_on(a.y, b.y, lanes), one_on(a.z, b.z, lanes)}};
}

constexpr float kFaceReach = 2;  // edges; triangles reach no farther from their corners

template <class Shape>
WEFT_INLINE RowReach below_faces_row(const FacesRow& f) {
  const CollideRow& r = f.row;
  const Shape shape(r.shape);
  const Wide3 place = wide3(r.cx, r.cy, r.cz);
  Wide clearance = wide(kFar), fastest{};
  for (int i = 0; i < padded(r.columns); i += kLanes)
    for (const Wide3& v : {load3(r.v, i), load3(f.v_next, i)})
      fastest = max(fastest, select(lanes_below(r.columns - i), past_place(r, v), Wide{}));
  const float speed = __builtin_sqrtf(greatest(fastest)) + r.rim;
  const float enough = r.offset - f.slack;
  const float far = r.offset + kFaceReach * f.edge + speed * r.dt;
  const auto surface = [&](ConstRow3 row, int i) { return shape.at(load3(row, i) - place); };
  Surface s00 = surface(r.x, 0), s01 = surface(f.x_next, 0);
  int listed = 0;
  for (int i = 0; i < padded(r.columns); i += kLanes) {
    const bool last = i + kLanes >= padded(r.columns);
    const Surface n00 = last ? s00 : surface(r.x, i + kLanes);
    const Surface n01 = last ? s01 : surface(f.x_next, i + kLanes);
    const WideInt there = lanes_below(r.columns - i), inside = lanes_below(r.columns - 1 - i);
    const Wide nearest = min(s00.distance, s01.distance);
    clearance = min(clearance, select(there, nearest - r.offset, wide(kFar)));
    const WideInt close = inside & (nearest < far);
    Wide bounds[2] = {wide(kFar), wide(kFar)};
    if (any(close)) {
      const Wide3 x00 = load3(r.x, i) - place, x01 = load3(f.x_next, i) - place;
      const Wide3 x10 = load3(r.x, i + 1) - place, x11 = load3(f.x_next, i + 1) - place;
      const Surface s10 = one_on(s00, n00), s11 = one_on(s01, n01);
      const Face one{x00, x10, x01}, two{x10, x11, x01};
      const Wide first = max(tangent_bound(s00, x00, one),
                             max(tangent_bound(s01, x01, one), tangent_bound(s10, x10, one)));
      const Wide second = max(tangent_bound(s11, x11, two),
                              max(tangent_bound(s01, x01, two), tangent_bound(s10, x10, two)));
      const Wide tangents[2] = {first, second};
      for (int t = 0; t < 2; ++t) {
        const WideInt low = close & (tangents[t] < enough);
        // Those that are low keep what they have for the descents.
        bounds[t] = select(low, tangents[t], tangents[t] - r.offset);
        listed += store_lanes(f.room + listed, bits(low), (lane_numbers() + i) * 2 + t);
      }
    }
    for (int t = 0; t < 2; ++t) store(f.bound[t] + i, select(close, bounds[t], wide(kFar)));
    s00 = n00;
    s01 = n01;
  }
  descend_listed(shape, f, place, listed, enough);
  return {least(clearance), speed};
}

#define WEFT_COLLIDER(name, Shape)             \
  namespace {                                  \
  RowReach coulomb(const CollideRow& r) {      \
    return collide_row<Shape, false>(r);       \
  }                                            \
  RowReach course(const CollideRow& r) {       \
    return collide_row<Shape, true>(r);        \
  }                                            \
  RowReach below_faces(const FacesRow& f) {    \
    return below_faces_row<Shape>(f);          \
  }                                            \
  RowReach damp_sliding(const CollideRow& r) { \
    return damp_sliding_row<Shape>(r);         \
  }                                            \
  }                                            \
  const physics::ColliderKernels name = {{coulomb, course}, below_faces, damp_sliding};

}  // namespace weft::WEFT_KERNELS
