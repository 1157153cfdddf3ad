// Where the scene stands: its floor, its size, and what a camera should frame.
#pragma once

#include "picture/frame_data.h"

namespace weft::viewer {

struct Setting {
  bool has_ground = false;
  bool solid = false;  // the floor is a plane of the scene; else it only shows where things are
  float ground = 0;    // m, height of the floor
  Bounds room;         // what the cloth is likely to reach, and the colliders
  float size = 1;      // m
};

// From the start of a scene. The floor is the scene's own level plane, or lies below the reach of
// cloth that is held; cloth that nothing holds falls without a floor.
Setting setting_of(const FrameData& start);

// The cloth and the colliders as they are now; and without what has left the scene.
Bounds visible_bounds(const FrameData& frame_data);
Bounds seen_bounds(const FrameData& frame_data, const Setting& setting);

// Whether the plane is the floor, drawn as such.
bool is_level(const Plane& plane);
// Whether a point lies on the side that the cloth is kept to.
bool in_front_of(const Plane& plane, Vec3f point);

}  // namespace weft::viewer
