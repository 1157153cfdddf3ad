// Stage "collider_faces": a collider with features smaller than the mesh is caught by the triangles
// that it would slip through between the particles (seed 000 names this failure).
//
// The point p = Σ b_k x_k of a triangle deepest in the collider is lifted out by `depth` along the
// normal there, each corner by its share:  x_k += w_k b_k / (Σ w b²) n depth.  It rubs like a
// particle: p's velocity into the surface is lost, friction shortens the rest. Beside a held corner the
// others are long levers; none is moved by more than kMostLever times the depth at once.
#include <algorithm>
#include <cmath>
#include <limits>

#include "physics/clamp_to_int.h"
#include "physics/path.h"
#include "physics/stages/colliders.h"

namespace weft::physics {
namespace {

constexpr int kProjections = 12;  // between triangle and core
constexpr int kMostPlaces = 16;   // on the way of a fast collider
constexpr double kSlack = 1e-3;   // of an edge: a triangle may be as deep
constexpr double kDeep = 3e-2;    // of an edge: one that was as deep is looked at again at once
constexpr int kTurns = 8;         // of one triangle in a substep
constexpr double kMostLever = 2;  // the greatest share of a corner; 1.37 where masses are equal

using Weights = std::array<double, 3>;

// One triangle's corners, seen from the collider's place at the end of the substep.
struct Corners {
  Triangle x, path;  // and how far each came in this substep
  Vec3 at(const Weights& b) const {
    return plus(plus(times(x[0], b[0]), times(x[1], b[1])), times(x[2], b[2]));
  }
};

// The point of a triangle nearest to q (Ericson, Real-Time Collision Detection, 5.1.5).
Weights nearest_on(const Triangle& t, const Vec3& q) {
  const Vec3 ab = minus(t[1], t[0]), ac = minus(t[2], t[0]), aq = minus(q, t[0]);
  const double d1 = dot(ab, aq), d2 = dot(ac, aq);
  if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
  const Vec3 bq = minus(q, t[1]);
  const double d3 = dot(ab, bq), d4 = dot(ac, bq);
  if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double s = d1 / std::max(d1 - d3, 1e-300);
    return {1 - s, s, 0};
  }
  const Vec3 cq = minus(q, t[2]);
  const double d5 = dot(ab, cq), d6 = dot(ac, cq);
  if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double s = d2 / std::max(d2 - d6, 1e-300);
    return {1 - s, 0, s};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double s = (d4 - d3) / std::max((d4 - d3) + (d5 - d6), 1e-300);
    return {0, 1 - s, s};
  }
  const double sum = va + vb + vc;
  return {va / sum, vb / sum, vc / sum};
}

struct Deepest {
  Weights weights{};
  Nearest nearest;
};

// The point of a triangle nearest to the core of a shape, by alternating projections between the two.
// They end early at a plane that holds the two further apart than `enough`.
struct Approach {
  Weights weights{1 / 3., 1 / 3., 1 / 3.};
  bool apart = false;  // a plane was found between the two
  bool far = false;    // and it holds them apart by enough
};
template <class Shape>
Approach approach(const Shape& shape, const Corners& c, double enough, double edge) {
  Approach a;
  Core core = core_of(shape, c.at(a.weights));
  for (int n = 0; n < kProjections; ++n) {
    const Weights before = a.weights;
    a.weights = nearest_on(c.x, core.nearest);
    const Vec3 here = c.at(a.weights);
    core = core_of(shape, here);
    const Vec3 way = minus(here, core.nearest);
    const double square = dot(way, way);
    double least = 1e300;
    for (const Vec3& x : c.x) least = std::min(least, dot(way, minus(x, here)));
    const double gap = (square + least) / std::sqrt(std::max(square, 1e-300));
    a.apart |= gap > 1e-6 * edge;  // more than rounding
    a.far = a.apart && gap >= enough;
    const Vec3 change = minus(a.weights, before);
    if (a.far || dot(change, change) < 1e-12) break;
  }
  return a;
}

// The deepest point of a triangle in a shape. One that cuts the core is first moved out of it, along the
// way of least overlap.
template <class Shape>
Deepest deepest_on(const Shape& shape, Corners c, double offset, double edge) {
  const double radius = core_of(shape, c.x[0]).radius;
  Approach a = approach(shape, c, radius + offset, edge);
  if (a.far) return {a.weights, {offset, {}}};
  if (!a.apart) {
    if (const Overlap overlap = overlap_of(shape, c.x); overlap.depth > 0) {
      for (Vec3& x : c.x) x = plus(x, times(overlap.normal, overlap.depth + 1e-3 * edge));
      a = approach(shape, c, std::numeric_limits<double>::infinity(), edge);
      return {a.weights, {-overlap.depth - radius, overlap.normal}};
    }
  }
  return {a.weights, nearest_of(shape, c.at(a.weights))};
}

struct Touch {
  Weights weights{};
  Vec3 normal{};
  double depth = 0;  // m; > 0: to be lifted by, at the end of the substep
};

// The first contact on the way of the triangle, seen from the collider.
template <class Shape>
Touch first_touch(const Shape& shape, double offset, const Corners& end, int places, double edge) {
  for (int n = 1; n <= places; ++n) {
    const double left = 1 - double(n) / places;
    Corners c = end;
    for (int k = 0; k < 3; ++k) c.x[k] = minus(end.x[k], times(end.path[k], left));
    const Deepest d = deepest_on(shape, c, offset, edge);
    if (d.nearest.distance >= offset) continue;
    const double beyond = dot(minus(c.at(d.weights), end.at(d.weights)), d.nearest.normal);
    return {d.weights, d.nearest.normal, offset - d.nearest.distance + std::max(0.0, beyond)};
  }
  return {};
}

// A shape in its own axes: a box is looked at there.
struct Upright {
  Shape shape;
  std::array<Vec3, 3> axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

  explicit Upright(const Shape& given) : shape(given) {
    if (auto* box = std::get_if<Box>(&shape)) {
      const ShapeConstants turned = constants_of(*box);
      for (int k = 0; k < 3; ++k)
        axes[k] = {turned.turn[3 * k], turned.turn[3 * k + 1], turned.turn[3 * k + 2]};
      box->rotation = {};
    }
  }
  Vec3 into(const Vec3& p) const { return {dot(axes[0], p), dot(axes[1], p), dot(axes[2], p)}; }
  Vec3 out_of(const Vec3& p) const {
    return plus(plus(times(axes[0], p[0]), times(axes[1], p[1])), times(axes[2], p[2]));
  }
};

bool caught_by_triangles(const Cloth& cloth, const Collider& collider) {
  return collider.friction.model == FrictionModel::coulomb && !resolves(cloth, collider);
}

class ColliderFaces final : public RowStage {
 public:
  ColliderFaces(const ClothParts& parts, const Collider& collider)
      : RowStage("collider_faces", "triangles of the sheet against its small features", 1,
                 2 * std::int64_t(parts.lattice.columns - 1) * (parts.lattice.rows - 1),
                 "triangles"),
        parts_(parts),
        collider_(parts, collider, true),
        far_(parts, collider_.fastest()),
        upright_(collider.shape),
        edge_(longest_edge(parts.cloth.grid)) {}

  void reserve_slots(int slots) override {
    bound_ = Rows(slots, parts_.lattice.stride);
    room_ = AlignedArray<std::int32_t>(room() * std::size_t(slots));
  }
  std::size_t bytes() const override {
    return bound_.bytes() + room_.size() * sizeof(std::int32_t);
  }
  double idle() const override { return far_.share(); }
  void follow(const Collider& collider) override {
    if (&collider != &collider_.collider()) return;
    collider_.follow_keys();
    far_.restart(collider_.fastest());
  }

  void run(int j, const Substep& s) override {
    Lattice& l = parts_.lattice;
    if (j + 1 >= l.rows || far_.skip(j, s)) return;
    FacesRow f;
    f.row = collider_.row(parts_, j, s);
    f.x_next = l.x.row(j + 1);
    f.v_next = l.v.row(j + 1);
    f.edge = float(edge_);
    f.slack = float(kSlack * edge_);
    const Row3 bound = bound_.row(s.slot);
    f.bound[0] = bound.x;
    f.bound[1] = bound.y;
    f.room = room_.data() + room() * std::size_t(s.slot);
    RowReach reach = parts_.kernels.below_faces[collider_.shape()](f);
    // The way of a substep matters only where it is long against the collider.
    const float way = reach.speed * f.row.dt;
    const float near = way > 0.5f * f.row.shape.thin ? way : float(-kSlack * edge_);
    // Between its corners a triangle may be nearer by as much as an edge, stretched by half.
    reach.clearance -= float(1.5 * edge_);
    far_.found(j, s, reach);
    for (int i = 0; i + 1 < l.columns; ++i) {
      if (f.bound[0][i] < near) lift(f.row, {j, j, j + 1}, {i, i + 1, i});
      if (f.bound[1][i] < near) lift(f.row, {j, j + 1, j + 1}, {i + 1, i + 1, i});
    }
  }

 private:
  // An edge or a corner of the collider leaves a triangle by one of its sides after another.
  void lift(const CollideRow& r, const std::array<int, 3>& j, const std::array<int, 3>& i) {
    for (int n = 0; n < kTurns && touch(r, j, i); ++n) continue;
  }

  // Lifts one triangle out once; whether it may be in by another side still.
  bool touch(const CollideRow& r, const std::array<int, 3>& j, const std::array<int, 3>& i) {
    Lattice& l = parts_.lattice;
    const Vec3 place{r.cx, r.cy, r.cz}, u{r.ux, r.uy, r.uz};
    std::array<Vec3, 3> v;
    Corners c;
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      v[k] = minus({l.v.at(0, j[k], i[k]), l.v.at(1, j[k], i[k]), l.v.at(2, j[k], i[k])}, u);
      c.x[k] = upright_.into(
          minus({l.x.at(0, j[k], i[k]), l.x.at(1, j[k], i[k]), l.x.at(2, j[k], i[k])}, place));
      c.path[k] = upright_.into(times(v[k], r.dt));
      longest = std::max(longest, std::sqrt(dot(c.path[k], c.path[k])));
    }
    Touch touch = std::visit(
        [&](const auto& shape) {
          const double size = std::max(feature_of(shape) + r.offset, 0.02 * edge_);
          const int places = clamp_to_int(std::ceil(2 * longest / size), 1, kMostPlaces);
          // It rests as deep as may be: lifted all the way it would fall back and ring.
          return first_touch(shape, r.offset - kSlack * edge_, c, places, edge_);
        },
        upright_.shape);
    if (touch.depth <= 0) return false;
    touch.normal = upright_.out_of(touch.normal);
    std::array<double, 3> share;
    double mobility = 0, greatest = 0;
    Vec3 speed{};
    for (int k = 0; k < 3; ++k) {
      share[k] = l.w(j[k], i[k]) * touch.weights[k];
      mobility += share[k] * touch.weights[k];
      greatest = std::max(greatest, share[k]);
      speed = plus(speed, times(v[k], touch.weights[k]));
    }
    if (mobility <= 0) return false;
    const bool lever = greatest > kMostLever * mobility;
    const double scale = lever ? kMostLever / greatest : 1 / mobility;
    const auto [moved, gained] = rub(r, touch, speed);
    for (int k = 0; k < 3; ++k)
      for (int m = 0; m < 3; ++m) {
        l.x.at(m, j[k], i[k]) = coordinate(l.x.at(m, j[k], i[k]) + scale * share[k] * moved[m]);
        l.v.at(m, j[k], i[k]) = float(l.v.at(m, j[k], i[k]) + scale * share[k] * gained[m]);
      }
    return !lever && touch.depth > kDeep * edge_;
  }

  // Changes of position and velocity of the touching point, as a particle's in collide.h.
  static std::pair<Vec3, Vec3> rub(const CollideRow& r, const Touch& touch, const Vec3& speed) {
    const double into = dot(speed, touch.normal);
    const Vec3 tangential = minus(speed, times(touch.normal, into));
    const double distance = std::sqrt(dot(tangential, tangential)) * r.dt;
    const double pressed = std::max(0.0, -into * r.dt);
    const double rubbed = distance <= r.friction_static * pressed
                              ? 1
                              : std::min(1.0, r.friction_dynamic * pressed / distance);
    const Vec3 lost = times(tangential, -rubbed);
    return {plus(times(touch.normal, touch.depth), times(lost, r.dt)),
            plus(times(touch.normal, std::max(0.0, -into)), lost)};
  }

  std::size_t room() const { return 2 * std::size_t(parts_.lattice.stride) + 16; }

  ClothParts parts_;
  MovingCollider collider_;
  OutOfReach far_;
  Upright upright_;
  double edge_;  // m, longest of a flat triangle
  Rows bound_;
  AlignedArray<std::int32_t> room_;
};

}  // namespace

void find_triangles_inside(const Cloth& cloth, const Lattice& l, const Collider& collider,
                           StartInside& found) {
  if (collider.cuts || !caught_by_triangles(cloth, collider)) return;
  const double edge = longest_edge(cloth.grid);
  const Upright upright(collider.shape);
  const Vec3 place = collider.keys.empty()
                         ? std::visit([](const auto& s) { return place_of(s); }, collider.shape)
                         : position_at(collider.keys, found.time);
  const auto look = [&](const std::array<int, 3>& j, const std::array<int, 3>& i) {
    Corners c{};
    bool moves = false;
    for (int k = 0; k < 3; ++k) {
      c.x[k] = minus({l.x.at(0, j[k], i[k]), l.x.at(1, j[k], i[k]), l.x.at(2, j[k], i[k])}, place);
      c.x[k] = upright.into(c.x[k]);
      moves |= l.w(j[k], i[k]) > 0;
    }
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3 side = minus(c.x[(k + 1) % 3], c.x[k]);
      longest = std::max(longest, std::sqrt(dot(side, side)));
    }
    const double depth = std::visit(
        [&](const auto& shape) {
          // No point of a triangle is further from a corner than its longest side.
          if (!moves || nearest_of(shape, c.x[0]).distance > collider.offset + longest) return 0.0;
          return collider.offset - deepest_on(shape, c, collider.offset, edge).nearest.distance;
        },
        upright.shape);
    found.deepest_triangle = std::max(found.deepest_triangle, depth);
    found.triangles += depth > kTouchingStart;
  };
  for (int j = 0; j + 1 < l.rows; ++j)
    for (int i = 0; i + 1 < l.columns; ++i) {
      look({j, j, j + 1}, {i, i + 1, i});
      look({j, j + 1, j + 1}, {i + 1, i + 1, i});
    }
  if (found.triangles == 0) found.deepest_triangle = 0;
}

std::unique_ptr<RowStage> make_collider_faces(const ClothParts& parts, const Collider& collider) {
  if (!caught_by_triangles(parts.cloth, collider)) return nullptr;
  return std::make_unique<ColliderFaces>(parts, collider);
}

}  // namespace weft::physics
