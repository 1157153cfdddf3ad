// Placing the floor and guessing the room a scene needs.
#include "picture/setting.h"

namespace weft::viewer {

namespace {

// How long a sheet is, or a mesh as it starts.
float side_of(const Cloth& cloth, const ClothCopy& copy) {
  if (!cloth.mesh.given())
    return std::max(length(to_float(cloth.grid.u)), length(to_float(cloth.grid.v)));
  Bounds bounds;
  for (int p = 0; p < copy.columns; ++p) bounds.add(copy.position(p));
  const Vec3f size = bounds.high - bounds.low;
  return std::max({size.x, size.y, size.z});
}

// How far down the cloth can hang, from its pins or draped over the colliders.
float reach_of(const Cloth& cloth, const ClothCopy& copy, const Bounds& bodies, bool& held) {
  const float side = side_of(cloth, copy);
  float lowest = 1e30f;
  if (!cloth.pins.empty()) {
    float highest = -1e30f;
    for (const Pin& pin : cloth.pins)
      for (const int p : held_particles(cloth, pin))
        highest = std::max(highest, copy.position(p).y);
    lowest = highest - 1.08f * side;
    held = true;
  } else if (!bodies.empty()) {
    lowest = bodies.high.y - 0.6f * side;
    held = true;
  }
  return lowest;
}

}  // namespace

bool is_level(const Plane& plane) {
  const Vec3f n = normalized(to_float(plane.normal));
  return n.y > 0.98f;
}

bool in_front_of(const Plane& plane, Vec3f point) {
  return dot(to_float(plane.normal), point - to_float(plane.point)) > 0;
}

Setting setting_of(const FrameData& start) {
  Setting setting;
  const Scene& scene = *start.scene;
  Bounds bodies;
  for (const Collider& collider : scene.colliders)
    for (const double time : {0.0, scene.time.seconds / 2, scene.time.seconds})
      bodies.add(collider_bounds({collider_at(collider, time)}));
  setting.room = cloth_bounds(start);
  setting.room.add(bodies);

  float lowest = setting.room.low.y;
  bool held = false;
  for (std::size_t c = 0; c < scene.cloths.size() && c < start.cloths.size(); ++c)
    lowest = std::min(lowest, reach_of(scene.cloths[c], start.cloths[c], bodies, held));
  setting.has_ground = held;
  setting.ground = lowest - 0.02f * setting.room.radius();
  for (const Collider& collider : scene.colliders)
    if (const Plane* plane = std::get_if<Plane>(&collider.shape); plane && is_level(*plane)) {
      setting.has_ground = setting.solid = true;
      setting.ground = static_cast<float>(plane->point[1]);
    }
  // What falls on a floor lies there as wide as it is.
  const Bounds above = setting.room;
  if (setting.has_ground)
    setting.room.add(Vec3f{above.center().x, setting.ground, above.center().z});
  if (setting.solid)
    for (const Vec3f& corner : {above.low, above.high})
      setting.room.add(Vec3f{corner.x, setting.ground, corner.z});
  setting.size = 2 * setting.room.radius();
  return setting;
}

Bounds seen_bounds(const FrameData& frame_data, const Setting& setting) {
  constexpr float kGone = 1.5f;  // sizes of the scene
  const Vec3f center = setting.room.center();
  const auto stays = [&](Vec3f p) { return length(p - center) < kGone * setting.size; };
  Bounds bounds;
  for (const ClothCopy& cloth : frame_data.cloths)
    for (int p = 0; p < cloth.columns * cloth.rows; ++p)
      if (const Vec3f at = cloth.position(p); stays(at)) bounds.add(at);
  for (const Collider& body : frame_data.bodies)
    if (const Bounds one = collider_bounds({body}); !one.empty() && stays(one.center()))
      bounds.add(one);
  return bounds.empty() ? setting.room : bounds;
}

Bounds visible_bounds(const FrameData& frame_data) {
  Bounds bounds = cloth_bounds(frame_data);
  bounds.add(collider_bounds(frame_data.bodies));
  return bounds;
}

}  // namespace weft::viewer
