// Contact among surfaces: vertices against triangles and edges against edges, of kLanes pairs of
// squares at a time.
//
// Contacts are a vertex above a triangle and two edges that pass each other, with the common normal n:
// what lies beside a triangle or beyond an edge's end is the business of the triangle and edge that it
// is above, and would only be hindered from sliding there. Held they are min(h, ρ/2) apart, h the mean
// of two thicknesses and ρ how far apart the two points are on the flat sheet, if on one: a sheet is
// nowhere nearer itself than its own shape, and may bend as tightly as layers h apart ask for (ρ = π h/2).
//
// What may pass through is judged by the closest points wherever they lie: n separates two things at
// first, and does so all the way when n·(x_i - x_k) > 0 for their corners in the end.
#include "physics/kernels/surface.h"

#include "physics/kernels/records.h"
#include "physics/kernels/row_kernels.h"

namespace weft::WEFT_KERNELS {

namespace {

using physics::kKindsOfPair;
using physics::Square;
using physics::SquareGaps;
using physics::SurfaceContact;
using physics::SurfacePairs;
using physics::SurfaceSearch;

constexpr float kTiny = 1e-20f, kOutOfReach = 1e18f;  // m²
// Shares: how far beside a triangle a vertex still counts as above it; and how near to parallel (sine
// squared) two edges have no normal of their own, and the sides of a triangle make none.
constexpr float kBeside = 0.02f, kParallel = 1e-3f, kFlat = 1e-5f;
constexpr float kLeastLeft = 0.1f;  // of a distance, when something may pass
// Of the longest edge, that a vertex beside a triangle may be farther from it than above its plane (kBeside, along
// two sides), and rounding.
constexpr float kFartherBeside = 3 * kBeside;

constexpr int kEdges[3][2] = {{0, 1}, {0, 2}, {1, 2}}, kFaces[2][3] = {{0, 1, 2}, {1, 3, 2}};
constexpr int kRecord = 4;  // floats

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

// A vertex above a triangle: shares of its corners, and the distance squared from its plane.
WEFT_INLINE Wide vertex_above(Wide3 p, const Face& t, Wide (&share)[3]) {
  const Edge &e = t.side[0], &f = t.side[1];
  const Wide3 d = p - t.corner[0];
  const Wide de = dot(d, e.along), df = dot(d, f.along);
  share[1] = (f.square * de - t.between * df) * t.inverse;
  share[2] = (e.square * df - t.between * de) * t.inverse;
  share[0] = 1.0f - share[1] - share[2];
  const WideInt above = (t.area > max(kFlat * (e.square * f.square), wide(kTiny))) &
                        (min(min(share[0], share[1]), share[2]) > -kBeside);
  const Wide3 off = d - e.along * share[1] - f.along * share[2];
  return select(above, dot(off, off), wide(kOutOfReach));
}

// Two edges that pass each other.
WEFT_INLINE Wide edges_pass(Wide3 p, const Edge& e, Wide3 q, const Edge& f, Wide& s, Wide& t) {
  const Wide3 r = p - q;
  const Wide ef = dot(e.along, f.along), er = dot(e.along, r), fr = dot(f.along, r);
  const Wide both = e.square * f.square, area = both - ef * ef;
  const Wide inverse = 1.0f / max(area, wide(kTiny));
  s = (ef * fr - er * f.square) * inverse;
  t = (e.square * fr - ef * er) * inverse;
  const WideInt pass = (area > kParallel * both) & (min(s, t) >= 0.0f) & (max(s, t) <= 1.0f) &
                       (min(e.square, f.square) > 2 * kTiny);
  const Wide3 off = r + e.along * s - f.along * t;
  return select(pass, dot(off, off), wide(kOutOfReach));
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
  Wide best = select(inside, dot(above, above), wide(kOutOfReach));
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
template <SurfaceSearch kSearch>
class Pairs {
 public:
  WEFT_INLINE Pairs(const SurfacePairs& given, int at, SurfaceContact* found)
      : given_(given), at_(at), found_(found) {
    const std::int32_t* const number[2] = {given.owner + at, given.neighbour + at};
    Wide3 low = wide3(kOutOfReach, kOutOfReach, kOutOfReach), high = low * wide(-1);
    for (int n = 0; n < 2; ++n) {
      const auto* const corners = (const float*)given.squares->corner;
      const Wide4 corner = records_at(corners, kRecord, number[n]);
      corner_[n][0] = (WideInt)corner.xyz.x;
      corner_[n][1] = (WideInt)corner.xyz.y;
      corner_[n][2] = (WideInt)corner.xyz.z;
      corner_[n][3] = (WideInt)corner.last;
      for (int c = 0; c < 4; ++c) {
        const Wide4 place = record(given.place->x, n, c);
        shape_[n].x[c] = place.xyz;
        half_held_[n] = place.last;
        moved_[n][c] = record(given.moved->u, n, c).xyz;
        const Wide3 u = moved_[n][c];
        low = {min(low.x, u.x), min(low.y, u.y), min(low.z, u.z)};
        high = {max(high.x, u.x), max(high.y, u.y), max(high.z, u.z)};
      }
    }
    const Wide3 origin = shape_[0].x[0], spread = high - low;
    for (int n = 0; n < 2; ++n) {
      for (Wide3& x : shape_[n].x) x = x - origin;
      fill_shape(shape_[n]);
    }
    thickness_ = half_held_[0] + half_held_[1];
    // What is farther apart than that at the start comes nowhere near.
    const Wide far = thickness_ * given.reach + sqrt(dot(spread, spread));
    far_squared_ = far * far;
    valid_ = lanes_below(given.pairs - at);
  }

  // The vertex of each against a triangle of the other.
  WEFT_INLINE void vertex(int n) {
    for (int own = 0; own < 2; ++own) {
      const auto [i, j, k] = kFaces[n];
      const auto joined = same(own, 0, i) | same(own, 0, j) | same(own, 0, k);
      Wide share[3];
      const Face& face = shape_[1 - own].face[n];
      const Wide square = kSearch == SurfaceSearch::contacts
                              ? vertex_above(shape_[own].x[0], face, share)
                              : vertex_face(shape_[own].x[0], face, share);
      const WideInt near = met(square, joined);
      if (!any(near)) continue;
      Closest c{};
      c.at[own][0] = wide(1);
      c.at[1 - own][i] = share[0], c.at[1 - own][j] = share[1], c.at[1 - own][k] = share[2];
      const int body[4][2] = {{own, 0}, {1 - own, i}, {1 - own, j}, {1 - own, k}};
      add(2 * n + own, 1, body, c, near);
    }
  }

  WEFT_INLINE void edge(int n, int m) {
    const auto [i, j] = kEdges[n];
    const auto [k, l] = kEdges[m];
    Wide s, t;
    const Wide3 p = shape_[0].x[i], q = shape_[1].x[k];
    const Edge &e = shape_[0].edge[n], &f = shape_[1].edge[m];
    const Wide square = kSearch == SurfaceSearch::contacts ? edges_pass(p, e, q, f, s, t)
                                                           : edge_edge(p, e, q, f, s, t);
    const WideInt near = met(square, same(0, i, k) | same(0, i, l) | same(0, j, k) | same(0, j, l));
    if (!any(near)) return;
    Closest c{};
    c.at[0][i] = 1.0f - s, c.at[0][j] = s;
    c.at[1][k] = 1.0f - t, c.at[1][l] = t;
    const int body[4][2] = {{0, i}, {0, j}, {1, k}, {1, l}};
    add(4 + 3 * n + m, 2, body, c, near);
  }

  SurfaceContact* found() const { return found_; }

 private:
  // Whether a corner of one is the same particle as a corner of the other.
  WEFT_INLINE WideInt same(int n, int corner, int other) const {
    return corner_[n][corner] == corner_[1 - n][other];
  }

  WEFT_INLINE Wide4 record(const float* records, int n, int c) const {
    return records_at(records, kRecord, (const std::int32_t*)&corner_[n][c]);
  }

  WEFT_INLINE WideInt met(Wide square, WideInt joined) const {
    return (select(joined, wide(kOutOfReach), square) < far_squared_) & valid_;
  }

  // The distance at rest of the two points; far where they are of two sheets.
  WEFT_INLINE Wide rest_distance(const Closest& c) const {
    Wide x{}, y{}, z{}, sheet[2];
    for (int n = 0; n < 2; ++n)
      for (int k = 0; k < 4; ++k) {
        const Wide4 rest = record(&given_.rest->x, n, k);
        const Wide share = c.at[n][k] * (n == 0 ? 1.0f : -1.0f);
        x = x + rest.xyz.x * share;
        y = y + rest.xyz.y * share;
        z = z + rest.xyz.z * share;
        sheet[n] = rest.last;
      }
    return select(sheet[0] == sheet[1], sqrt(x * x + y * y + z * z), wide(kOutOfReach));
  }

  // Not inlined: few are near, and there are thirteen kinds. `body` are the four that take part, the
  // first `owners` of them on one side.
  __attribute__((noinline)) void add(int kind, int owners, const int (&body)[4][2],
                                     const Closest& c, WideInt near) {
    Wide3 off = wide3(0, 0, 0);
    for (int n = 0; n < 2; ++n)
      for (int k = 0; k < 4; ++k)
        off = off + shape_[n].x[k] * (c.at[n][k] * (n == 0 ? 1.0f : -1.0f));
    // To the side of the first bodies.
    if (body[0][0] == 1) off = off * wide(-1);
    const Wide distance = max(sqrt(dot(off, off)), wide(1e-12f));
    const Wide3 normal = off * (1.0f / distance);
    Wide nearest[2] = {wide(kOutOfReach), wide(-kOutOfReach)};
    for (int b = 0; b < 4; ++b) {
      const Wide u = dot(normal, moved_[body[b][0]][body[b][1]]);
      if (b < owners)
        nearest[0] = min(nearest[0], u);
      else
        nearest[1] = max(nearest[1], u);
    }
    const Wide approach = min(Wide{}, nearest[0] - nearest[1]);
    const Wide held = min(thickness_, 0.5f * rest_distance(c));
    const WideInt wanted =
        kSearch == SurfaceSearch::contacts
            ? near & (distance + approach < held * given_.reach)
            : near & (approach < 0.0f) &
                  (distance + approach < max(distance * kLeastLeft, held * given_.floor));
    for (unsigned set = bits(wanted); set != 0; set &= set - 1)
      put(kind, owners, body, c, __builtin_ctz(set), normal, distance, held);
  }

  void put(int kind, int owners, const int (&body)[4][2], const Closest& c, int lane,
           const Wide3& normal, const Wide& distance, const Wide& held) {
    SurfaceContact& one = *found_++;
    one.pair = at_ + lane;
    one.kind = kind;
    for (int b = 0; b < 4; ++b) {
      one.body[b] = corner_[body[b][0]][body[b][1]][lane];
      one.share[b] = c.at[body[b][0]][body[b][1]][lane] * (b < owners ? 1.0f : -1.0f);
    }
    one.normal[0] = normal.x[lane], one.normal[1] = normal.y[lane], one.normal[2] = normal.z[lane];
    one.distance = distance[lane];
    one.held = held[lane];
  }

  const SurfacePairs& given_;
  const int at_;
  SurfaceContact* found_;
  Shape shape_[2];
  Wide3 moved_[2][4];
  WideInt corner_[2][4], valid_;
  Wide half_held_[2], thickness_, far_squared_;
};

// The least distance of kLanes pairs of squares, of what they have not in common.
WEFT_INLINE Wide gap(const SquareGaps& given, int at) {
  Shape shape[2];
  WideInt corner[2][4];
  const std::int32_t* const number[2] = {given.owner + at, given.neighbour + at};
  for (int n = 0; n < 2; ++n) {
    const Wide4 four = records_at((const float*)given.squares->corner, kRecord, number[n]);
    corner[n][0] = (WideInt)four.xyz.x, corner[n][1] = (WideInt)four.xyz.y;
    corner[n][2] = (WideInt)four.xyz.z, corner[n][3] = (WideInt)four.last;
    for (int c = 0; c < 4; ++c)
      shape[n].x[c] = records_at(given.place->x, kRecord, (const std::int32_t*)&corner[n][c]).xyz;
  }
  const Wide3 origin = shape[0].x[0];
  Wide longest{}, least = wide(kOutOfReach);
  for (int n = 0; n < 2; ++n) {
    for (Wide3& x : shape[n].x) x = x - origin;
    fill_shape(shape[n]);
    for (const Face& face : shape[n].face)
      for (const Edge& side : face.side) longest = max(longest, side.square);
  }
  const auto add = [&](Wide square, WideInt joined) {
    least = min(least, select(joined, wide(kOutOfReach), square));
  };
  for (int own = 0; own < 2; ++own)
    for (int n = 0; n < 2; ++n) {
      const auto [i, j, k] = kFaces[n];
      const WideInt vertex = corner[own][0];
      const WideInt* const other = corner[1 - own];
      Wide share[3];
      add(vertex_face(shape[own].x[0], shape[1 - own].face[n], share),
          (vertex == other[i]) | (vertex == other[j]) | (vertex == other[k]));
    }
  for (int n = 0; n < 3; ++n)
    for (int m = 0; m < 3; ++m) {
      const auto [i, j] = kEdges[n];
      const auto [k, l] = kEdges[m];
      Wide s, t;
      add(edge_edge(shape[0].x[i], shape[0].edge[n], shape[1].x[k], shape[1].edge[m], s, t),
          (corner[0][i] == corner[1][k]) | (corner[0][i] == corner[1][l]) |
              (corner[0][j] == corner[1][k]) | (corner[0][j] == corner[1][l]));
    }
  return sqrt(least) - kFartherBeside * sqrt(longest);
}

template <SurfaceSearch kSearch>
WEFT_INLINE int search(const SurfacePairs& given) {
  SurfaceContact* found = given.found;
  for (int k = 0; k < given.pairs; k += kLanes) {
    Pairs<kSearch> pairs(given, k, found);
    for (int n = 0; n < 2; ++n) pairs.vertex(n);
    for (int n = 0; n < 3; ++n)
      for (int m = 0; m < 3; ++m) pairs.edge(n, m);
    found = pairs.found();
  }
  return int(found - given.found);
}

}  // namespace

int surface_pairs(const SurfacePairs& given) {
  return given.search == SurfaceSearch::contacts ? search<SurfaceSearch::contacts>(given)
                                                 : search<SurfaceSearch::passing>(given);
}

void square_gaps(const SquareGaps& given) {
  for (int k = 0; k < given.pairs; k += kLanes) store(given.gap + k, gap(given, k));
}

}  // namespace weft::WEFT_KERNELS
