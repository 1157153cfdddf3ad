// Self-collision among surfaces: vertices against triangles and edges against edges, of kLanes pairs
// of squares at a time.
//
// With the closest points Σ a_i x_i and Σ b_k y_k (a, b >= 0, each summing to 1), n from the other's
// to the own, and d their distance: what is nearer than h is pushed apart by
//
//   Δx_i = n (h - d) w_i a_i / (Σ w a² + Σ w b²)
//
// and the velocity into the other is lost in the same shares, and of the velocity along it up to μ
// times as much; of several pairs their mean, each weighing (h - d) h/d, so that between two layers
// the nearer one has its way.
#include "physics/kernels/surface.h"

#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::Square;
using physics::SquareChange;
using physics::SquaresTouching;
using physics::SquaresWithin;
using physics::SurfacePairs;
using physics::Vertex;

constexpr float kTiny = 1e-20f;
// Of the thickness: weights of pairs nearer than that grow no further.
constexpr float kClosest = 0.01f;
// Columns or rows from which on squares of one sheet are no neighbours.
constexpr float kApart = 2.5f;

constexpr int kEdges[3][2] = {{0, 1}, {0, 2}, {1, 2}}, kFaces[2][3] = {{0, 1, 2}, {1, 3, 2}};
constexpr int kSquare = sizeof(Square) / sizeof(float), kVertex = sizeof(Vertex) / sizeof(float);

// SquareChange of kLanes pairs.
struct Change {
  Wide push[4][3], gain[4][3], weight[4];
};
constexpr int kFloats = sizeof(SquareChange) / sizeof(float);
static_assert(sizeof(Change) == kFloats * sizeof(Wide));

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

// What squares are made of, relative to the A of the first of the two.
struct Shape {
  Wide3 x[4];
  Edge edge[3];
  Face face[2];
};

// The closest points of two squares, as shares of the corners A, B, C, D of each.
struct Closest {
  Wide at[2][4];
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
  Wide best = select(inside, dot(above, above), wide(physics::kOutOfReach));
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

// kLanes pairs of squares.
class Pairs {
 public:
  WEFT_INLINE Pairs(const SurfacePairs& given, int at) : given_(given) {
    const std::int32_t* const number[2] = {given.owner + at, given.neighbour + at};
    Wide4 place[2];
    for (int n = 0; n < 2; ++n) {
      const auto* const corners = (const float*)given.squares->corner;
      const Wide4 corner = records_at(corners, kSquare, number[n]);
      corner_[n][0] = (WideInt)corner.xyz.x;
      corner_[n][1] = (WideInt)corner.xyz.y;
      corner_[n][2] = (WideInt)corner.xyz.z;
      corner_[n][3] = (WideInt)corner.last;
      place[n] = records_at(given.squares->place, kSquare, number[n]);
      for (int c = 0; c < 4; ++c) shape_[n].x[c] = vertex_part(&Vertex::x, n, c).xyz;
    }
    const Wide3 origin = shape_[0].x[0];
    for (int n = 0; n < 2; ++n) {
      for (Wide3& x : shape_[n].x) x = x - origin;
      fill_shape(shape_[n]);
    }
    const auto &p = place[0], &q = place[1];
    const WideInt beside = (abs(q.xyz.x - p.xyz.x) < kApart) & (abs(q.xyz.y - p.xyz.y) < kApart);
    const Wide thickness = 0.5f * (q.xyz.z + p.xyz.z);
    held_ = select(beside, min(thickness, wide(given.close)), thickness);
    held_squared_ = held_ * held_;
    friction_ = 0.5f * (q.last + p.last);
    near_squared_ = wide(physics::kOutOfReach);
    valid_ = lanes_below(given.touching ? given.pairs - at : 0);
  }

  // The vertex of each against a triangle of the other.
  WEFT_INLINE void vertex(int n) {
    for (int own = 0; own < 2; ++own) {
      const auto [i, j, k] = kFaces[n];
      const auto joined = same(own, 0, i) | same(own, 0, j) | same(own, 0, k);
      Wide share[3];
      const Wide square = vertex_face(shape_[own].x[0], shape_[1 - own].face[n], share);
      const WideInt touch = met(square, joined);
      if (!any(touch)) continue;
      Closest c{};
      c.at[own][0] = wide(1);
      c.at[1 - own][i] = share[0], c.at[1 - own][j] = share[1], c.at[1 - own][k] = share[2];
      push(c, touch);
    }
  }

  WEFT_INLINE void edge(int n, int m) {
    const auto [i, j] = kEdges[n];
    const auto [k, l] = kEdges[m];
    Wide s, t;
    const Wide square =
        edge_edge(shape_[0].x[i], shape_[0].edge[n], shape_[1].x[k], shape_[1].edge[m], s, t);
    const WideInt touch =
        met(square, same(0, i, k) | same(0, i, l) | same(0, j, k) | same(0, j, l));
    if (!any(touch)) return;
    Closest c{};
    c.at[0][i] = 1.0f - s, c.at[0][j] = s;
    c.at[1][k] = 1.0f - t, c.at[1][l] = t;
    push(c, touch);
  }

  WEFT_INLINE Wide near_squared() const {
    const Wide reach = held_ + given_.beyond;
    return select(near_squared_ < reach * reach, near_squared_, wide(physics::kOutOfReach));
  }

  // Writes what those that touch want, `at` being the number of the first; returns how many.
  WEFT_INLINE int put_touching(int at, SquaresTouching* to) const {
    int count = 0;
    if (!any(touched_)) return count;
    for (unsigned set = bits(touched_); set != 0; set &= set - 1) {
      const int lane = __builtin_ctz(set);
      SquaresTouching& one = to[count++];
      one.pair = at + lane;
      float* const out = &one.change[0].push[0][0];
      const float* const from = (const float*)change_ + lane;
      for (int f = 0; f < 2 * kFloats; ++f) out[f] = from[f * kLanes];
    }
    return count;
  }

 private:
  // Whether a corner of one is the same particle as a corner of the other.
  WEFT_INLINE WideInt same(int n, int corner, int other) const {
    return corner_[n][corner] == corner_[1 - n][other];
  }

  // Four floats of a corner's particle: x and w, or v.
  WEFT_INLINE Wide4 vertex_part(float (Vertex::*part)[3], int n, int c) const {
    return records_at(given_.vertices->*part, kVertex, (const std::int32_t*)&corner_[n][c]);
  }

  // Takes a distance squared into account; returns where it is less than the thickness.
  WEFT_INLINE WideInt met(Wide square, WideInt joined) {
    const Wide apart = select(joined, wide(physics::kOutOfReach), square);
    near_squared_ = min(near_squared_, apart);
    return (apart < held_squared_) & valid_;
  }

  // Not inlined: few pairs touch, and there are thirteen kinds.
  __attribute__((noinline)) void push(const Closest& c, WideInt touch) {
    if (!any(touched_))
      for (Change& change : change_) change = Change{};
    touched_ = touched_ | touch;
    Wide3 off = wide3(0, 0, 0), u = wide3(0, 0, 0);
    Wide mass{}, w[2][4];
    for (int n = 0; n < 2; ++n) {
      const float sign = n == 0 ? 1 : -1;
      for (int k = 0; k < 4; ++k) {
        const Wide share = c.at[n][k] * sign;
        w[n][k] = vertex_part(&Vertex::x, n, k).last;
        off = off + shape_[n].x[k] * share;
        u = u + vertex_part(&Vertex::v, n, k).xyz * share;
        mass = mass + w[n][k] * (share * share);
      }
    }
    // Nothing is pushed where the distance or all inverse masses are 0.
    const Wide distance = sqrt(dot(off, off));
    const Wide3 normal = off * (1.0f / max(distance, wide(kTiny)));
    const Wide depth = held_ - distance;
    const Wide closeness = held_ / max(distance, held_ * kClosest);
    const Wide into = dot(u, normal), lost = max(Wide{}, -into);
    const Wide3 slide = u - normal * into;
    const Wide sliding = sqrt(dot(slide, slide));
    const Wide rubbed = select(sliding > 1e-12f, min(wide(1), friction_ * lost / sliding), Wide{});
    const Wide3 gain = normal * lost - slide * rubbed, moved = normal * depth;
    const Wide3 nothing = wide3(0, 0, 0);
    const Wide per_mass = 1.0f / max(mass, wide(kTiny));
    for (int n = 0; n < 2; ++n)
      for (int k = 0; k < 4; ++k) {
        const Wide weight = depth * closeness * c.at[n][k];
        const Wide part = weight * (w[n][k] * c.at[n][k] * per_mass) * (n == 0 ? 1.0f : -1.0f);
        add(change_[n].push[k], select(touch, moved * part, nothing));
        add(change_[n].gain[k], select(touch, gain * part, nothing));
        change_[n].weight[k] = change_[n].weight[k] + select(touch, weight, Wide{});
      }
  }

  WEFT_INLINE static void add(Wide (&sum)[3], Wide3 more) {
    sum[0] = sum[0] + more.x, sum[1] = sum[1] + more.y, sum[2] = sum[2] + more.z;
  }

  const SurfacePairs& given_;
  Shape shape_[2];
  WideInt corner_[2][4], valid_, touched_{};
  Wide held_, held_squared_, friction_, near_squared_;
  Change change_[2];  // filled where any has touched
};

}  // namespace

int squares_within(const SquaresWithin& given) {
  const SquaresWithin s = given;
  constexpr int kStride = sizeof(physics::SquareBox) / sizeof(float);
  int count = 0;
  for (int k = 0; k < s.pairs; k += kLanes) {
    const auto low = [&](const std::int32_t* of) {
      return records_at(s.boxes->low, kStride, of + k);
    };
    const auto high = [&](const std::int32_t* of) {
      return records_at(s.boxes->high, kStride, of + k).xyz;
    };
    const Wide4 p = low(s.owner), q = low(s.neighbour);
    const Wide3 a = p.xyz - high(s.neighbour), b = q.xyz - high(s.owner);
    const Wide3 gap{max(max(a.x, b.x), Wide{}), max(max(a.y, b.y), Wide{}),
                    max(max(a.z, b.z), Wide{})};
    const WideInt within =
        (dot(gap, gap) < s.range * s.range) & (p.last + q.last > 0.0f) & lanes_below(s.pairs - k);
    store_lanes(s.within_owner + count, bits(within), lanes_at(s.owner + k));
    count += store_lanes(s.within_neighbour + count, bits(within), lanes_at(s.neighbour + k));
  }
  for (int l = 0; l < kLanes; ++l) s.within_owner[count + l] = s.within_neighbour[count + l] = 0;
  return count;
}

int surface_pairs(const SurfacePairs& given) {
  int touching = 0;
  for (int k = 0; k < given.pairs; k += kLanes) {
    Pairs pairs(given, k);
    for (int n = 0; n < 2; ++n) pairs.vertex(n);
    for (int n = 0; n < 3; ++n)
      for (int m = 0; m < 3; ++m) pairs.edge(n, m);
    store(given.near_squared + k, pairs.near_squared());
    if (given.touching) touching += pairs.put_touching(k, given.touching + touching);
  }
  return touching;
}

}  // namespace weft::WEFT_KERNELS
