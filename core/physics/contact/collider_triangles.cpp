// What all cloths have in common: when a row's triangles are looked at, and how one is lifted.
#include "physics/contact/collider_triangles.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "physics/contact/friction.h"
#include "physics/model/clamp_to_int.h"
#include "physics/step/keeper.h"

namespace weft::physics {
namespace {

constexpr int kMostPlaces = 16;  // on the way of a fast collider
constexpr double kDeep = 3e-2;   // of an edge: one that was as deep is looked at again at once
constexpr int kPasses = 2;       // over a row of stretched triangles: a lift moves those beside it
constexpr int kTurns = 8;        // of one triangle in a substep
// Of an edge: how near a triangle at rest is known. An edge of it that lies along an edge of the body is
// nearest anywhere along that; the exact point jumps from end to end as it turns, and sheets draped over
// boxes swing for ever. Projections come to a point that moves as the triangle does.
constexpr double kSteady = 1e-2;
constexpr double kMostLever = 2;  // the greatest share of a corner; 1.37 where masses are equal
constexpr double kSudden = 5;     // m/s; of a blow by something else than the collider
constexpr double kShort = 1.5;    // times the flat ones: edges that need no reach of their own

}  // namespace

// The first contact on the way of the triangle, seen from the collider.
ColliderTriangles::Touch ColliderTriangles::first_touch(const DeepestOnBody& d, double offset) {
  if (d.nearest.distance >= offset) return {};
  return {d.weights, d.nearest.normal, offset - d.nearest.distance, d.way};
}
template <class Shape>
ColliderTriangles::Touch ColliderTriangles::first_touch(const Shape& shape, double offset,
                                                        const Corners& end, int places, double edge,
                                                        double tolerance) {
  for (int n = 1; n <= places; ++n) {
    const double left = 1 - double(n) / places;
    Corners c = end;
    for (int k = 0; k < 3; ++k) c.x[k] = minus(end.x[k], times(end.path[k], left));
    const Deepest d = deepest_on(shape, c, offset, edge, tolerance);
    if (d.nearest.distance >= offset) continue;
    const double beyond = dot(minus(c.at(d.weights), end.at(d.weights)), d.nearest.normal);
    return {d.weights, d.nearest.normal, offset - d.nearest.distance + std::max(0.0, beyond)};
  }
  return {};
}

std::pair<Vec3, Vec3> ColliderTriangles::rub(const CollideRow& r, const Touch& touch,
                                             const Vec3& speed) {
  const double into = dot(speed, touch.normal);
  const Vec3 tangential = minus(speed, times(touch.normal, into));
  const double distance = length(tangential) * r.dt;
  const double pressed = std::max(0.0, -into * r.dt);
  const double taken = taken_by_friction(r.friction_static, r.friction_dynamic, distance, pressed);
  const Vec3 lost = times(tangential, -taken);
  return {plus(times(touch.normal, touch.depth), times(lost, r.dt)),
          plus(times(touch.normal, std::max(0.0, -into)), lost)};
}

ColliderTriangles::ColliderTriangles(const ClothParts& parts, const Collider& collider,
                                     const StartInside& start, const SpeculativeCulling& particles,
                                     std::int64_t triangles)
    : ColliderRowStage(parts, collider, start, true,
                       resolves(parts.cloth, collider) ? "stretched_faces" : "collider_faces",
                       resolves(parts.cloth, collider)
                           ? "triangles of the sheet where it is stretched"
                           : "triangles of the sheet against its small features",
                       1, triangles, "triangles"),
      cloth_(parts),
      particles_(particles),
      resolved_(resolves(parts.cloth, collider)),
      upright_(collider.shape),
      edge_(longest_edge(parts.cloth)),
      allowed_(parts.cloth, collider),
      lengths_(std::size_t(parts.particles.rows)) {
  if (const BodySurface* surface = surface_of(collider))
    features_ = std::make_unique<FeatureProbe>(*surface, parts);
}

void ColliderTriangles::restart() {
  ColliderRowStage::restart();
  if (features_) features_->forget();
  std::fill(lengths_.begin(), lengths_.end(), Length{});
}

void ColliderTriangles::keep(Keeper& keeper) {
  ColliderRowStage::keep(keeper);
  keeper(lengths_);
}

RowReach ColliderTriangles::reach_of_particles(int j, const Substep& s) const {
  const int next = std::min(j + 1, cloth_.particles.rows - 1);
  const RowReach a = particles_.reach_at(j, s.time), b = particles_.reach_at(next, s.time);
  return {std::min(a.clearance, b.clearance), std::max(a.speed, b.speed)};
}

int ColliderTriangles::passes(double longest) const {
  return longest > AllowedDepth::kStretched * edge_ ? kPasses : 1;
}

bool ColliderTriangles::lift(const ColliderRow& r, const std::array<int, 3>& j,
                             const std::array<int, 3>& i, std::size_t first) {
  bool moved = false, on = true;
  for (int n = 0; n < kTurns && on; ++n) {
    const Touch touch = find(r, j, i, first);
    on = touch.depth > 0 && lift_once(r, touch, j, i);
    moved |= touch.depth > 0;
  }
  return moved;
}

bool ColliderTriangles::touches(const ColliderRow& r, const std::array<int, 3>& j,
                                const std::array<int, 3>& i, std::size_t first) {
  return find(r, j, i, first).depth > 0;
}

void ColliderTriangles::keep_out(int j, const Substep& s) {
  if (is_harmless(j, s) || far_.skip(j, s)) return;
  Length& length = lengths_[std::size_t(j)];
  const bool known = length.known(s.time);
  const double longest = known ? length.longest : greatest(cloth_.particles.x, j);
  const double small = resolved_ ? allowed_.harmless() : kShort * edge_;
  const bool harmless = resolved_ && longest <= small;
  RowReach row = harmless ? reach_of_particles(j, s) : look(j, s, longest);
  if (!known) length = {longest, s.time, s.time + time_to_grow(j, small - longest), harmless};
  // A triangle's points are no nearer than its corners by more than an edge.
  row.clearance -= float(std::max(kShort * edge_, longest));
  far_.found(j, s, row, longest / edge_);
}

double ColliderTriangles::time_to_grow(int j, double by) const {
  return std::max(0.0, by) / (2 * greatest(cloth_.particles.v, j) + kSudden + collider_.fastest());
}

// Velocity of a corner past the collider.
Vec3 ColliderTriangles::past(const ColliderRow& r, int j, int i) const {
  const Particles& l = cloth_.particles;
  const Vec3 own{l.v.at(0, j, i), l.v.at(1, j, i), l.v.at(2, j, i)};
  return minus(own, r.carried(r.about_place(l.position(j, i)), own));
}

ColliderTriangles::Touch ColliderTriangles::find(const ColliderRow& r, const std::array<int, 3>& j,
                                                 const std::array<int, 3>& i, std::size_t first) {
  Corners c;
  for (int k = 0; k < 3; ++k) {
    c.x[k] = r.into(r.about_place(cloth_.particles.position(j[k], i[k])));
    c.path[k] = r.into(times(past(r, j[k], i[k]), r.dt));
  }
  std::span<const int> features;
  if (features_) features = features_->about(r, c, edge_, j[first], i[first]);
  if (features_ && features.empty()) return {};
  double path = 0;
  for (int k = 0; k < 3; ++k) {
    c.x[k] = upright_.into(c.x[k]);
    c.path[k] = upright_.into(c.path[k]);
    path = std::max(path, length(c.path[k]));
  }
  // It rests as deep as may be: lifted all the way it would fall back and ring.
  const double longest = longest_side(c.x);
  const double offset = r.offset - allowed_.at(longest);
  const bool stretched = longest > AllowedDepth::kStretched * edge_;
  Touch touch = std::visit(
      [&](const auto& shape) {
        if constexpr (std::is_same_v<decltype(shape), const MeshBody&>)
          return first_touch(deepest_among(features, r.body, c, offset, edge_), offset);
        else {
          const double size = std::max(feature_of(shape) + r.offset, 0.02 * edge_);
          const int places = clamp_to_int(std::ceil(2 * path / size), 1, kMostPlaces);
          return first_touch(shape, offset, c, places, edge_, stretched ? kExact : kSteady);
        }
      },
      upright_.shape);
  touch.normal = r.out_of(upright_.out_of(touch.normal));
  touch.way = r.out_of(touch.way);
  return touch;
}

bool ColliderTriangles::lift_once(const ColliderRow& r, const Touch& touch,
                                  const std::array<int, 3>& j, const std::array<int, 3>& i) {
  Particles& l = cloth_.particles;
  std::array<double, 3> share;
  double mobility = 0, greatest = 0;
  Vec3 speed{};
  for (int k = 0; k < 3; ++k) {
    share[k] = l.w(j[k], i[k]) * touch.weights[k];
    mobility += share[k] * touch.weights[k];
    greatest = std::max(greatest, share[k]);
    speed = plus(speed, times(past(r, j[k], i[k]), touch.weights[k]));
  }
  speed = minus(speed, times(touch.way, r.inverse_dt));
  if (mobility <= 0) return false;
  const bool lever = greatest > kMostLever * mobility;
  const double scale = lever ? kMostLever / greatest : 1 / mobility;
  const auto [moved, gained] = rub(r, touch, speed);
  for (int k = 0; k < 3; ++k)
    for (int m = 0; m < 3; ++m) {
      l.x.at(m, j[k], i[k]) = coordinate(l.x.at(m, j[k], i[k]) + scale * share[k] * moved[m]);
      l.v.at(m, j[k], i[k]) = float(l.v.at(m, j[k], i[k]) + scale * share[k] * gained[m]);
    }
  // Corners and edges of a mesh may come through side by side.
  return !lever && touch.depth > (features_ ? AllowedDepth::kSlack : kDeep) * edge_;
}

}  // namespace weft::physics
