// What lies under the pointer: rays against the cloth's triangles and the colliders.
#pragma once

#include <optional>

#include "picture/camera.h"
#include "picture/frame_data.h"

namespace weft::viewer {

struct Ray {
  Vec3f origin, direction;  // of unit length
};

// Where the picture is in the window, in the panel's units from the top left.
struct Area {
  float x = 0, y = 0, width = 1, height = 1;
  float aspect() const { return width / height; }
};

Ray ray_through(const Camera& camera, const Area& area, float x, float y);

// The point in the window, how far it lies before the eye [m], and whether it lies there at all.
struct ScreenPoint {
  float x = 0, y = 0, depth = 0;
  bool seen = false;
};
class Projector {
 public:
  Projector(const Camera& camera, const Area& area);
  ScreenPoint operator()(Vec3f p) const;

 private:
  Mat4 matrix_;
  Area area_;
};

struct ClothHit {
  int cloth = 0, particle = 0;  // the nearest of the triangle
  Vec3f point;
  float distance = 0;  // m along the ray
};
std::optional<ClothHit> pick_cloth(const FrameData& frame_data, const Ray& ray);

struct BodyHit {
  int body = 0;  // number of the collider
  Vec3f point;
  float distance = 0;
};
// Planes are passed over.
std::optional<BodyHit> pick_body(const FrameData& frame_data, const Ray& ray);

// The point of the plane through `on`, facing the ray's camera, under the ray.
Vec3f on_plane(const Ray& ray, Vec3f on, Vec3f normal);

}  // namespace weft::viewer
