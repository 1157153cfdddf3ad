// Bodies of all shapes, and motions of theirs.
#pragma once

#include <numbers>
#include <vector>

#include "made_up_bodies.h"
#include "physics/contact/body/body_surface.h"
#include "weft/shape.h"

namespace weft {

inline constexpr double kDegree = std::numbers::pi / 180, kGravity = 9.81;

inline std::vector<Shape> shapes() {
  MeshBody ball;
  ball.shape = tests::ball(160, 120, 0.3);
  ball.translate = {0.05, -0.02, 0.1};
  ball.rotate = {10, 20, 30};
  ball.surface = surface_of(ball);
  return {Sphere{{0.05, -0.02, 0.1}, 0.3},
          Plane{{0, 0.1, 0}, {0.1, 1, -0.1}},
          Capsule{{-0.2, 0, 0.1}, {0.3, 0.1, 0}, 0.2},
          Box{{0.05, 0, 0}, {0.3, 0.2, 0.4}, {20, -35, 50}, 0.08},
          Cylinder{{-0.3, 0, 0.1}, {0.4, 0.1, 0}, 0.25, 0.08},
          TaperedCapsule{{-0.2, 0, 0.1}, {0.3, 0.1, 0}, 0.25, 0.15},
          ball};
}

// Turned about a line through `about` along `axis`, by Rodrigues' formula.
inline Vec3 turned_point(const Vec3& p, const Vec3& about, const Vec3& axis, double angle) {
  const Vec3 n = times(axis, 1 / length(axis)), r = minus(p, about);
  return plus(about,
              plus(times(r, std::cos(angle)), plus(times(cross(n, r), std::sin(angle)),
                                                   times(n, dot(n, r) * (1 - std::cos(angle))))));
}

// A motion of rate [rad/s] from the start on, along a straight path.
struct Motion {
  Vec3 axis, about, velocity;
  double rate;
  void give(Collider& c, double seconds) const {
    c.rotate = {axis, about, {{0, 0}, {seconds, rate * seconds / kDegree}}};
    const Vec3 place = place_of(c.shape);
    if (velocity != Vec3{}) c.keys = {{0, place}, {seconds, plus(place, times(velocity, seconds))}};
  }
  Vec3 seen(const Vec3& p, double t) const {
    return turned_point(minus(p, times(velocity, t)), about, axis, -rate * t);
  }
  Vec3 in_scene(const Vec3& p, double t) const {
    return plus(turned_point(p, about, axis, rate * t), times(velocity, t));
  }
};

inline std::vector<Motion> motions() {
  return {{{0, 1, 0}, {0.05, 0, 0.1}, {}, 2.5},
          {{1, 0.2, -0.3}, {0, 0, 0}, {0.2, 0.1, -0.1}, -1.5},
          {{0.3, 2, 1}, {0.3, -0.2, 0.4}, {}, 1.2}};
}

}  // namespace weft
