// Colliders in motion (moving_collider.h).
#include "physics/contact/moving_collider.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/body/body_surface.h"
#include "physics/model/load.h"
#include "physics/model/path.h"
#include "physics/step/keeper.h"
#include "weft/mesh.h"

namespace weft {

using namespace physics;

bool resolves(const Cloth& cloth, const Collider& collider) {
  const double feature = std::visit([](const auto& s) { return feature_of(s); }, collider.shape);
  return feature + collider.offset > kSmallFeature * longest_edge(cloth);
}

namespace physics {
namespace {

constexpr double kStrain = 0.2;  // SpeculativeCulling's

// How fast the surface of a collider turns about a point at most, ever [m/s].
double surface_speed(const Collider& collider, const Vec3& about) {
  constexpr double kEver = 1e9;  // s
  const double turn = fastest_turn(collider.rotate, 0, kEver);
  return turn == 0 ? 0 : turn * lever_of(collider, about);
}

}  // namespace

double longest_edge(const Cloth& cloth) {
  if (!cloth.mesh.given()) return std::hypot(spacing_u(cloth.grid), spacing_v(cloth.grid));
  const std::vector<Vec3> x = placed_vertices(cloth.mesh);
  double longest = 0;  // squared
  for (const auto& t : cloth.mesh.shape->triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 e = minus(x[std::size_t(t[(k + 1) % 3])], x[std::size_t(t[k])]);
      longest = std::max(longest, dot(e, e));
    }
  return std::sqrt(longest);
}

AllowedDepth::AllowedDepth(const Cloth& cloth, const Collider& collider)
    : edge_(longest_edge(cloth)), at_rest_(0), stretched_(kSlack * edge_), harmless_(0) {
  if (!resolves(cloth, collider)) return;
  const double radius =
      collider.offset + std::visit([](const auto& s) { return feature_of(s); }, collider.shape);
  const double half = kAtRest * edge_ / 2;
  constexpr double kMargin = 1.1;  // corners are on the surface to rounding, and to second order
  at_rest_ = kMargin * half * half / (radius + std::sqrt(radius * radius - half * half));
  stretched_ = std::max(kTight * edge_, collider.offset / 2);
  // s(e) = stretched_ / kMargin
  const double deep = std::min(stretched_ / kMargin, radius);
  harmless_ = std::max(kAtRest * edge_, 2 * std::sqrt(deep * (2 * radius - deep)));
}

double AllowedDepth::at(double longest) const {
  const double left = (kStretched - longest / edge_) / (kStretched - kAtRest);
  return std::max(stretched_, at_rest_ * std::clamp(left, 0.0, 1.0));
}

bool caught_by_triangles(const Collider& collider) {
  const bool flat =
      std::isinf(std::visit([](const auto& s) { return feature_of(s); }, collider.shape));
  return collider.friction.model == FrictionModel::coulomb && !flat;
}

MovingCollider::MovingCollider(const ClothParts& parts, const Collider& collider,
                               const StartInside& start, bool by_triangles)
    : collider_(collider),
      body_(surface_of(collider)),
      start_(start),
      by_triangles_(by_triangles),
      growth_(kPulledFrames * parts.scene.time.frame) {
  CollideRow& r = constants_;
  r.friction_static = float(collider.friction.statik);
  r.friction_dynamic = float(collider.friction.dynamic);
  r.offset = float(collider.offset);
  r.bias = float(collider.friction.bias);
  r.resolved = resolves(parts.cloth, collider);
  std::visit(
      [&](const auto& shape) {
        const Vec3 place = place_of(shape);
        r.shape = constants_of(shape);
        r.cx = float(place[0]);
        r.cy = float(place[1]);
        r.cz = float(place[2]);
      },
      collider.shape);
  if (const Rotation& turn = collider.rotate; !turn.keys.empty())
    rim_ = surface_speed(collider, place_of(collider.shape));
  follow_keys();
}

Vec3 ColliderRow::carried(const Vec3& about_place, const Vec3& v) const {
  const Vec3 u{ux, uy, uz};
  if (!turns) return u;
  const Vec3 before = minus(about_place, times(minus(v, u), dt));
  Vec3 velocity = u;
  for (std::size_t k = 0; k < 3; ++k)
    velocity[k] += dot({turning[k][0], turning[k][1], turning[k][2]}, before);
  return velocity;
}

void MovingCollider::follow_keys() {
  double along = 0;
  for (std::size_t n = 1; n < collider_.keys.size(); ++n) {
    const Key &a = collider_.keys[n - 1], &b = collider_.keys[n];
    const Vec3 e = minus(b.position, a.position);
    along = std::max(along, length(e) / (b.time - a.time));
  }
  fastest_ = along + deepest() / growth_ + (body_ ? body_->fastest() : 0);
  if (!collider_.rotate.keys.empty()) fastest_ += surface_speed(collider_, collider_.rotate.about);
}

double MovingCollider::deepest() const {
  if (collider_.friction.model == FrictionModel::course) return 0;
  return by_triangles_ ? std::max(start_.deepest_particle, start_.deepest_triangle)
                       : start_.deepest_particle;
}

ColliderRow MovingCollider::row(const ClothParts& parts, int j, const Substep& s) const {
  Particles& l = parts.particles;
  ColliderRow r{constants_, s.time};
  r.columns = l.count(j);
  r.x = l.x.row(j);
  r.v = l.v.row(j);
  r.w = l.w(j);
  r.dt = float(s.dt);
  r.inverse_dt = float(1 / s.dt);
  r.damped = float(std::min(1.0, collider_.friction.damping * s.dt));
  const double grown = (s.time - start_.time) / growth_;
  if (grown < 1) r.offset -= float(deepest() * (1 - grown));
  if (body_) {
    r.body.now = body_->at(s.time);
    r.body.before = body_->moves() ? body_->at(s.time - s.dt) : r.body.now;
    r.body.travel = body_->travel(s.time - s.dt, s.time);
  }
  if (moves_rigidly(collider_)) place(r, s);
  return r;
}

void MovingCollider::place(ColliderRow& r, const Substep& s) const {
  const Placement now(collider_, s.time);
  const RigidMotion motion(collider_, s.time, s.dt);
  r.cx = float(now.place[0]);
  r.cy = float(now.place[1]);
  r.cz = float(now.place[2]);
  r.ux = float(motion.velocity[0]);
  r.uy = float(motion.velocity[1]);
  r.uz = float(motion.velocity[2]);
  if (!now.turned) return;
  r.turn = now.turn;
  r.turns = motion.turns;
  r.rim = float(rim_);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t m = 0; m < 3; ++m) r.turning[k][m] = float(motion.turning[k][m]);
  // Kernels look at meshes as these see themselves (BodyProbe).
  if (!body_)
    std::visit([&](const auto& shape) { r.shape = constants_of(shape); },
               turned(collider_.shape, now.turn, {}));
}

namespace {

// What a load, a gas, gives to a particle of the cloth as it starts, at the time when that is most [m/s²].
double greatest_acceleration(const ClothParts& parts) {
  const Load* const load = parts.model.load();
  if (!load) return 0;
  double greatest = 0;
  const auto look = [&](double time) {
    std::vector<Vec3> a(std::size_t(particle_count(parts.cloth)));
    load->add_accelerations(time, a);
    for (const Vec3& one : a) greatest = std::max(greatest, length(one));
  };
  look(0);
  for (const auto& key : parts.cloth.pressure.keys) look(key.time);
  return greatest;
}

}  // namespace

SpeculativeCulling::SpeculativeCulling(const ClothParts& parts, double collider_speed)
    : rows_(parts.particles.rows), acceleration_(1), collider_speed_(collider_speed) {
  acceleration_ += parts.model.pull().acceleration * kStrain;
  acceleration_ += 2 * (greatest_gravity(parts.scene) + greatest_acceleration(parts));
}

void SpeculativeCulling::restart(double collider_speed) {
  collider_speed_ = collider_speed;
  for (Row& row : rows_) row.resume = row.ran;
}

void SpeculativeCulling::keep(Keeper& keeper) {
  keeper(rows_);
  keeper(collider_speed_);
}

bool SpeculativeCulling::skip(int j, const Substep& s) {
  Row& row = rows_[j];
  ++row.all;
  // A substep that is not later than the last one: the state was set back.
  const bool skipped = s.time > row.ran && s.time < row.resume;
  row.skipped += skipped;
  return skipped;
}

double SpeculativeCulling::approach(double speed, double time) const {
  return 2 * (speed + collider_speed_) * time + acceleration_ * time * time / 2;
}

RowReach SpeculativeCulling::reach_at(int j, double time) const {
  const Row& row = rows_[j];
  return {float(row.reach.clearance - approach(row.reach.speed, time - row.ran)), row.reach.speed};
}

void SpeculativeCulling::found(int j, const Substep& s, const RowReach& reach, double stretch) {
  const double pull = std::max(1.0, (stretch - 1) / kStrain);
  const double speed = 2 * (reach.speed + collider_speed_), a = pull * acceleration_;
  const double c = std::max(0.0, double(reach.clearance));
  // A plane that turns is infinitely fast far off.
  const double wait = std::isinf(speed) ? 0 : (std::sqrt(speed * speed + 2 * a * c) - speed) / a;
  rows_[j].ran = s.time;
  rows_[j].resume = s.time + wait;
  rows_[j].reach = reach;
}

double SpeculativeCulling::share() const {
  std::int64_t skipped = 0, all = 0;
  for (const Row& row : rows_) {
    skipped += row.skipped;
    all += row.all;
  }
  return all > 0 ? double(skipped) / double(all) : 0;
}

}  // namespace physics
}  // namespace weft
