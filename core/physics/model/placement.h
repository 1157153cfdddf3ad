// Where colliders stand at a time, and how they come there: turned about the axis of their rotation as the scene has
// them, and then moved, axis and all, along their keys.
#pragma once

#include "weft/scene.h"
#include "weft/turn.h"

namespace weft::physics {

struct Placement {
  Vec3 place{};         // m; of the shape's own place (ShapeValue::place)
  bool turned = false;  // whether it ever turns
  Matrix turn{};        // then: from the shape as the scene has it

  Placement(const Collider& collider, double time);

  // A direction or a point about the place, as the shape sees it, and a direction of the shape in the scene.
  Vec3 into(const Vec3& way) const { return turned ? times_transpose(turn, way) : way; }
  Vec3 out_of(const Vec3& way) const { return turned ? times(turn, way) : way; }
  // A point of the scene, as the shape sees it from its place.
  Vec3 seen(const Vec3& point) const { return into(minus(point, place)); }
  // And back.
  Vec3 in_scene(const Vec3& seen) const { return plus(place, out_of(seen)); }
};

// How a collider moves over the substep that ends at a time: what was p off its place when it began has the mean
// velocity `velocity` + `turning` p.
struct RigidMotion {
  Vec3 velocity{};     // m/s; of its place
  bool turns = false;  // in this substep
  Matrix turning{};    // 1/s
  Vec3 spin{};         // rad/s
  Vec3 about{};        // m; a point on the axis, from the place

  RigidMotion() = default;
  RigidMotion(const Collider& collider, double time, double dt);

  // Of the point of the collider where a particle was that has come to p, seen from the place, with velocity v [m/s].
  // So the path of a particle, seen from the collider as it stands at the end, is dt (v - carried).
  Vec3 carried(const Vec3& p, const Vec3& v, double dt) const {
    if (!turns) return velocity;
    const Vec3 before = minus(p, times(minus(v, velocity), dt));
    return plus(velocity, times(turning, before));
  }
  // Of what is p off the place and moves with velocity `past` as seen from the collider: towards the axis, and aside of
  // its way [m/s²].
  Vec3 acceleration(const Vec3& p, const Vec3& past) const {
    if (!turns) return {};
    return plus(cross(spin, cross(spin, minus(p, about))), times(cross(spin, past), 2));
  }
};

// How far a collider has come along its keys, its axis with it [m].
Vec3 along_keys(const Collider& collider, double time);

// Whether a collider's place or its turn ever changes.
inline bool moves_rigidly(const Collider& collider) {
  return !collider.keys.empty() || !collider.rotate.keys.empty();
}

// The greatest speed of its turn between two times [rad/s].
double fastest_turn(const Rotation& rotation, double from, double to);

}  // namespace weft::physics
