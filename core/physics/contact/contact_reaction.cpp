#include "physics/contact/contact_reaction.h"

#include <algorithm>
#include <cmath>

#include "physics/contact/body/body_passage.h"
#include "physics/contact/body/body_surface.h"
#include "physics/contact/collider_stage.h"
#include "physics/contact/friction.h"
#include "physics/model/placement.h"

namespace weft::physics {
namespace {

constexpr double kRounding = 1e-6;  // m, and of the distance from zero
constexpr double kAtRest = 1e-2;    // of what a substep adds to the velocity into the surface

// What friction leaves of an acceleration along a surface onto which it is pressed [m/s²].
Vec3 rubbed(const Friction& friction, const Vec3& along, double pressed) {
  if (friction.model == FrictionModel::course) return times(along, 1 - friction.dynamic);
  const double taken = taken_by_friction(friction.statik, friction.dynamic, length(along), pressed);
  return taken == 1 ? Vec3{} : times(along, 1 - taken);
}

// What a point is off a collider at least [m]: of a mesh known by less work than the distance.
double least_distance(const BodySurface* body, double time, const Vec3& p) {
  return body ? std::sqrt(body->at(time).bounds().square_from(p)) : 0;
}

// Of the surface nearest to p, beside the collider's, over the substep that ends at a time [m/s].
Vec3 velocity_at(const BodySurface& body, double time, double dt, const Vec3& p) {
  if (!body.moves()) return {};
  const BodyPassage passage{body.at(time - dt), body.at(time), 0};
  const BodyMoment::Point point = passage.now.nearest(p);
  return times(passage.way(point.triangle, point.weights), 1 / dt);
}

// What makes a velocity along the surface at p, where the normal is n, follow it for a substep [m/s²].
double turning_of(const Shape& shape, double time, const Vec3& p, const Vec3& n, const Vec3& along,
                  double dt) {
  const Vec3 way = times(along, dt);
  const Vec3 next = nearest_at(shape, time, plus(p, way)).normal;
  return std::max(0.0, dot(minus(next, n), way)) / (dt * dt);
}

// What a particle that rests on a surface at p, or slides along it, keeps of an acceleration a; all of
// it where it does neither. v is its velocity as seen from the collider.
Vec3 supported(const Collider& c, double time, bool chords, const Vec3& p, const Nearest& surface,
               const Vec3& v, const Vec3& a, const Lag& lag) {
  constexpr int kRounds = 3;  // turning and friction depend on each other, hardly
  const Vec3& n = surface.normal;
  const double inward = -dot(a, n), off = dot(v, n);
  const Vec3 along = plus(a, times(n, inward)), sliding = minus(v, times(n, off));
  double turning = 0;
  for (int round = 0; chords && round < kRounds; ++round) {
    const Vec3 gained = times(rubbed(c.friction, along, inward - turning), lag.behind);
    turning = turning_of(c.shape, time, p, n, plus(sliding, gained), lag.dt);
  }
  const double pressed = inward - turning;
  // On a chord it was off the surface half a substep ago, by so much.
  const double was_off = off + turning * (lag.dt / 2 - lag.behind);
  if (pressed <= 0 || std::abs(was_off) > (turning + kAtRest * pressed) * lag.dt) return a;
  return minus(rubbed(c.friction, along, pressed), times(n, turning));
}

}  // namespace

void support(const Scene& scene, const Cloth& cloth, double time, const Lag& lag,
             const Particles& l, std::vector<Vec3>& a) {
  for (const Collider& c : scene.colliders) {
    if (c.cuts) continue;
    const Placement placement(c, time);
    const RigidMotion motion(c, time, lag.dt);
    const BodySurface* body = surface_of(c);
    const bool chords = c.friction.model == FrictionModel::coulomb && resolves(cloth, c);
    l.for_each([&](int j, int i) {
      if (l.w(j, i) <= 0) return;
      const Vec3 x = l.position(j, i), p = placement.seen(x);
      Vec3& own = a[std::size_t(l.number(j, i))];
      // A substep ends on the surface, or off a curved one by what it went into it before.
      const double rounding =
          kRounding * std::max({1.0, std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
      const Vec3 v{l.v.at(0, j, i), l.v.at(1, j, i), l.v.at(2, j, i)};
      const Vec3 off = minus(x, placement.place), past = minus(v, motion.carried(off, v, lag.dt));
      // What goes along with the collider, or slides over it, has this.
      const Vec3 going = motion.acceleration(off, past);
      const Vec3 seen = placement.into(minus(own, going));
      const double most = length(seen) * lag.dt * lag.dt;
      if (least_distance(body, time, p) > c.offset + rounding + most) return;
      const Nearest surface = nearest_at(c.shape, time, p);
      const double inward = -dot(seen, surface.normal);
      if (inward > 0 && surface.distance < c.offset + rounding + inward * lag.dt * lag.dt) {
        const Vec3 local = body ? velocity_at(*body, time, lag.dt, p) : Vec3{};
        const Vec3 sliding = minus(placement.into(past), local);
        const Vec3 left = supported(c, time, chords, p, surface, sliding, seen, lag);
        own = plus(placement.out_of(left), going);
      }
    });
  }
}

}  // namespace weft::physics
