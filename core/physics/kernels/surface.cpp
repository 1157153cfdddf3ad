// Self-collision among surfaces: vertices against triangles and edges against edges, of one square
// and 16 others at a time.
//
// With the closest points Σ a_i x_i and Σ b_k y_k (a, b >= 0, each summing to 1), n from the other's
// to the own, and d their distance: what is nearer than h is pushed apart by
//
//   Δx_i = n (h - d) w_i a_i / (Σ w a² + Σ w b²)
//
// and the velocity into the other is lost in the same shares, and of the velocity along it up to μ
// times as much; of several pairs their mean, each weighing (h - d) h/d, so that between two layers
// the nearer one has its way. Every square sums up what concerns its own corners: nothing is
// written twice.
#include "physics/kernels/surface.h"

#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::Square;
using physics::SquareSum;
using physics::SurfaceSquare;

constexpr float kTiny = 1e-20f;
// Of the thickness: weights of pairs nearer than that grow no further.
constexpr float kClosest = 0.01f;
// Columns or rows from which on squares of one sheet are no neighbours.
constexpr float kApart = 2.5f;

constexpr int kEdges[3][2] = {{0, 1}, {0, 2}, {1, 2}}, kFaces[2][3] = {{0, 1, 2}, {1, 3, 2}};
constexpr int kStride = sizeof(Square) / sizeof(float);

struct Sums {
  Wide nearest;
  Wide3 push[4], gain[4];
  Wide weight[4];
};

struct Edge {
  Wide3 along;
  Wide square, inverse;  // of its length [m², 1/m²]
};

struct Face {
  Wide3 corner[3];
  Edge side[3];        // from the first corner to the others, and from the second to the third
  Wide between;        // of the first two sides: their product [m²]
  Wide area, inverse;  // twice the area, squared [m⁴, 1/m⁴]
};

// What squares are made of, relative to the owner's A.
struct Shape {
  Wide3 x[4];
  Edge edge[3];
  Face face[2];
};

// The closest points of two squares, as shares of the corners A, B, C, D.
struct Closest {
  Wide own[4], other[4];
};

WEFT_INLINE Wide clamp01(Wide s) {
  return min(max(s, Wide{}), wide(1));
}

WEFT_INLINE void fill_shape(Shape& s) {
  const auto edge = [&](int i, int j) {
    const Wide3 along = s.x[j] - s.x[i];
    const Wide square = max(dot(along, along), wide(kTiny));
    return Edge{along, square, 1.0f / square};
  };
  for (int n = 0; n < 3; ++n) s.edge[n] = edge(kEdges[n][0], kEdges[n][1]);
  for (int n = 0; n < 2; ++n) {
    const auto [i, j, k] = kFaces[n];
    Face& t = s.face[n];
    t.corner[0] = s.x[i], t.corner[1] = s.x[j], t.corner[2] = s.x[k];
    t.side[0] = edge(i, j), t.side[1] = edge(i, k), t.side[2] = edge(j, k);
    t.between = dot(t.side[0].along, t.side[1].along);
    t.area = t.side[0].square * t.side[1].square - t.between * t.between;
    t.inverse = 1.0f / max(t.area, wide(kTiny));
  }
}

// A vertex against a triangle: shares of its corners, and the distance squared.
WEFT_INLINE Wide vertex_face(Wide3 p, const Face& t, Wide (&share)[3]) {
  const Edge &e = t.side[0], &f = t.side[1];
  const Wide3 d = p - t.corner[0];
  const Wide de = dot(d, e.along), df = dot(d, f.along);
  share[1] = (f.square * de - t.between * df) * t.inverse;
  share[2] = (e.square * df - t.between * de) * t.inverse;
  share[0] = 1.0f - share[1] - share[2];
  const WideInt inside =
      (t.area > kTiny) & (share[0] >= 0.0f) & (share[1] >= 0.0f) & (share[2] >= 0.0f);
  const Wide3 above = d - e.along * share[1] - f.along * share[2];
  Wide best = select(inside, dot(above, above), wide(1e18f));
  constexpr int kSides[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (int n = 0; n < 3; ++n) {
    const auto [i, j] = kSides[n];
    const Wide3 to = p - t.corner[i];
    const Wide s = clamp01(dot(to, t.side[n].along) * t.side[n].inverse);
    const Wide3 off = to - t.side[n].along * s;
    const Wide square = dot(off, off);
    const WideInt nearer = square < best;
    best = select(nearer, square, best);
    for (int k = 0; k < 3; ++k)
      share[k] = select(nearer, k == i ? 1.0f - s : k == j ? s : Wide{}, share[k]);
  }
  return best;
}

// Two edges that start in p and q (Ericson 2005, 5.1.9): shares s and t of their ends, and the
// distance squared.
WEFT_INLINE Wide edge_edge(Wide3 p, const Edge& e, Wide3 q, const Edge& f, Wide& s, Wide& t) {
  const Wide3 r = p - q;
  const Wide ef = dot(e.along, f.along), er = dot(e.along, r), fr = dot(f.along, r);
  const Wide area = e.square * f.square - ef * ef;
  s = select(area > kTiny, clamp01((ef * fr - er * f.square) / area), Wide{});
  t = (ef * s + fr) * f.inverse;
  s = select(t < 0.0f, clamp01(-er * e.inverse),
             select(t > 1.0f, clamp01((ef - er) * e.inverse), s));
  t = clamp01(t);
  const Wide3 off = r + e.along * s - f.along * t;
  return dot(off, off);
}

// What one group of 16 others, or a part of it, is to the owner.
class Group {
 public:
  WEFT_INLINE Group(const SurfaceSquare& given, const Shape& own, const std::int32_t* others,
                    Sums& sums)
      : given_(given), p_(given.squares[given.owner]), own_(own), others_(others), sums_(sums) {
    corners_of(&Square::x, other_.x);
    for (Wide3& x : other_.x) x = x - wide3(p_.x[0][0], p_.x[0][1], p_.x[0][2]);
    fill_shape(other_);
    const Wide4 rest = records_at(given.squares->place, kStride, others);
    const WideInt beside =
        (abs(rest.xyz.x - p_.place[0]) < kApart) & (abs(rest.xyz.y - p_.place[1]) < kApart);
    const Wide thickness = 0.5f * (rest.xyz.z + p_.place[2]);
    const Wide held = select(beside, min(thickness, wide(given.close)), thickness);
    held_ = held;
    held_squared_ = held * held;
    const Wide4 corner =
        records_at(reinterpret_cast<const float*>(given.squares->corner), kStride, others);
    corner_[0] = (WideInt)corner.xyz.x;
    corner_[1] = (WideInt)corner.xyz.y;
    corner_[2] = (WideInt)corner.xyz.z;
    corner_[3] = (WideInt)corner.last;
  }

  // The own vertex against a triangle of the others, and the other way round.
  WEFT_INLINE void vertex(int n) {
    const auto [i, j, k] = kFaces[n];
    Wide share[3];
    const Wide square = vertex_face(own_.x[0], other_.face[n], share);
    if (const WideInt touch = met(square, same(0, i) | same(0, j) | same(0, k)); any(touch)) {
      Closest c{};
      c.own[0] = wide(1);
      c.other[i] = share[0], c.other[j] = share[1], c.other[k] = share[2];
      push(c, touch);
    }
    const Wide back = vertex_face(other_.x[0], own_.face[n], share);
    if (const WideInt touch = met(back, same(i, 0) | same(j, 0) | same(k, 0)); any(touch)) {
      Closest c{};
      c.other[0] = wide(1);
      c.own[i] = share[0], c.own[j] = share[1], c.own[k] = share[2];
      push(c, touch);
    }
  }

  WEFT_INLINE void edge(int n, int m) {
    const auto [i, j] = kEdges[n];
    const auto [k, l] = kEdges[m];
    Wide s, t;
    const Wide square = edge_edge(own_.x[i], own_.edge[n], other_.x[k], other_.edge[m], s, t);
    const WideInt touch = met(square, same(i, k) | same(i, l) | same(j, k) | same(j, l));
    if (!any(touch)) return;
    Closest c{};
    c.own[i] = 1.0f - s, c.own[j] = s;
    c.other[k] = 1.0f - t, c.other[l] = t;
    push(c, touch);
  }

 private:
  // Whether a corner of the own is the same particle as a corner of the others.
  WEFT_INLINE WideInt same(int own, int other) const { return corner_[other] == p_.corner[own]; }

  // Three floats of each of the others' corners.
  WEFT_INLINE void corners_of(float (Square::*part)[4][3], Wide3 (&out)[4]) const {
    Wide f[12];
    for (int q = 0; q < 3; ++q) {
      const Wide4 four = records_at(&(given_.squares->*part)[0][0] + 4 * q, kStride, others_);
      f[4 * q] = four.xyz.x, f[4 * q + 1] = four.xyz.y, f[4 * q + 2] = four.xyz.z,
            f[4 * q + 3] = four.last;
    }
    for (int c = 0; c < 4; ++c) out[c] = {f[3 * c], f[3 * c + 1], f[3 * c + 2]};
  }

  // Takes a distance squared into account; returns where it is less than the thickness.
  WEFT_INLINE WideInt met(Wide square, WideInt joined) {
    const Wide apart = select(joined, wide(1e18f), square);
    sums_.nearest = min(sums_.nearest, apart);
    return apart < held_squared_;
  }

  // Not inlined: few pairs touch, and there are thirteen kinds.
  __attribute__((noinline)) void push(const Closest& c, WideInt touch) {
    Wide3 off = wide3(0, 0, 0), u = wide3(0, 0, 0), v[4];
    corners_of(&Square::v, v);
    const Wide4 w = records_at(given_.squares->w, kStride, others_);
    const Wide weights[4] = {w.xyz.x, w.xyz.y, w.xyz.z, w.last};
    Wide mass{};
    for (int k = 0; k < 4; ++k) {
      off = off + own_.x[k] * c.own[k] - other_.x[k] * c.other[k];
      u = u + wide3(p_.v[k][0], p_.v[k][1], p_.v[k][2]) * c.own[k] - v[k] * c.other[k];
      mass = mass + p_.w[k] * (c.own[k] * c.own[k]) + weights[k] * (c.other[k] * c.other[k]);
    }
    // Nothing is pushed where the distance or all inverse masses are 0.
    const Wide distance = sqrt(dot(off, off));
    const Wide3 n = off * (1.0f / max(distance, wide(kTiny)));
    const Wide depth = held_ - distance;
    const Wide closeness = held_ / max(distance, held_ * kClosest);
    const Wide into = dot(u, n), lost = max(Wide{}, -into);
    const Wide3 slide = u - n * into;
    const Wide sliding = sqrt(dot(slide, slide));
    const Wide rubbed =
        select(sliding > 1e-12f, min(wide(1), p_.friction * lost / sliding), Wide{});
    const Wide3 gain = n * lost - slide * rubbed;
    const Wide3 nothing = wide3(0, 0, 0);
    for (int k = 0; k < 4; ++k) {
      const Wide weight = depth * closeness * c.own[k];
      const Wide part = weight * (p_.w[k] * c.own[k] / max(mass, wide(kTiny)));
      sums_.push[k] = sums_.push[k] + select(touch, n * (part * depth), nothing);
      sums_.gain[k] = sums_.gain[k] + select(touch, gain * part, nothing);
      sums_.weight[k] = sums_.weight[k] + select(touch, weight, Wide{});
    }
  }

  const SurfaceSquare& given_;
  const Square& p_;
  const Shape& own_;
  const std::int32_t* const others_;
  Sums& sums_;
  Shape other_;
  WideInt corner_[4];
  Wide held_, held_squared_;
};

WEFT_INLINE void compare(const SurfaceSquare& given, const Shape& own, const std::int32_t* others,
                         Sums& sums) {
  Group group(given, own, others, sums);
  for (int n = 0; n < 2; ++n) group.vertex(n);
  for (int n = 0; n < 3; ++n)
    for (int m = 0; m < 3; ++m) group.edge(n, m);
}

// Leaves those of the others whose boxes are within the range; returns how many.
WEFT_INLINE int keep_near(const SurfaceSquare& given) {
  const physics::SquareBox& own = given.boxes[given.owner];
  constexpr int kBoxStride = sizeof(own) / sizeof(float);
  const Wide3 low = wide3(own.low[0], own.low[1], own.low[2]);
  const Wide3 high = wide3(own.high[0], own.high[1], own.high[2]);
  int near = 0;
  for (int i = 0; i < given.count; i += kLanes) {
    for (int l = given.count; l < i + kLanes; ++l) given.others[l] = given.far_away;
    const WideInt number = lanes_at(given.others + i);
    const Wide3 a = low - records_at(given.boxes->high, kBoxStride, given.others + i).xyz;
    const Wide3 b = records_at(given.boxes->low, kBoxStride, given.others + i).xyz - high;
    const Wide3 gap{max(max(a.x, b.x), Wide{}), max(max(a.y, b.y), Wide{}),
                    max(max(a.z, b.z), Wide{})};
    near += store_lanes(given.others + near, dot(gap, gap) < given.range * given.range, number);
  }
  for (int l = near; l < padded(near); ++l) given.others[l] = given.far_away;
  return near;
}

// Lane by lane from 0 to 15, whatever the width.
WEFT_INLINE void add_up(Wide v, float& sum) {
  for (int l = 0; l < kLanes; ++l) sum += v[l];
}

}  // namespace

void surface_square(const SurfaceSquare& given) {
  SquareSum& out = *given.out;
  out = {};
  const int near = keep_near(given);
  float nearest = given.range * given.range;
  const Square& p = given.squares[given.owner];
  Shape own;
  for (int c = 0; c < 4; ++c)
    own.x[c] = wide3(p.x[c][0] - p.x[0][0], p.x[c][1] - p.x[0][1], p.x[c][2] - p.x[0][2]);
  fill_shape(own);
  for (int part = 0; part < 16; part += kLanes) {
    Sums sums{};
    sums.nearest = wide(nearest);
    for (int i = part; i < near; i += 16) compare(given, own, given.others + i, sums);
    nearest = least(sums.nearest);
    for (int k = 0; k < 4; ++k) {
      add_up(sums.push[k].x, out.push[k][0]);
      add_up(sums.push[k].y, out.push[k][1]);
      add_up(sums.push[k].z, out.push[k][2]);
      add_up(sums.gain[k].x, out.gain[k][0]);
      add_up(sums.gain[k].y, out.gain[k][1]);
      add_up(sums.gain[k].z, out.gain[k][2]);
      add_up(sums.weight[k], out.weight[k]);
    }
  }
  out.nearest = __builtin_sqrtf(nearest);
}

}  // namespace weft::WEFT_KERNELS
