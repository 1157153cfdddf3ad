// The camera: turns about a point, moves with it, comes nearer, and frames what it is given. Its eye stays above
// a floor.
#pragma once

#include <limits>

#include "picture/linear.h"

namespace weft::viewer {

class Camera {
 public:
  // The height below which the eye does not go [m]; -infinity: it goes anywhere.
  void set_floor(float height) { floor_ = height; }

  // Fits the box into the view, keeping the direction; `clear`: the share of the view's height, about its
  // middle, that nothing covers.
  void frame(const Bounds& bounds, float aspect, float clear = 1);

  // A shift by fractions of the view's height, so that what is grabbed follows the pointer.
  void pan(float x, float y);
  // A turn by angles [rad], right and up are positive, about a point of the scene, which stays where it is in
  // the picture. Over the floor it goes no lower.
  void orbit(float azimuth, float elevation, Vec3f about);
  // One notch of the wheel is 1: nearer. What is seen through (x, y), -1 … 1, stays there.
  void zoom(float notches);
  void zoom(float notches, float x, float y, float aspect);

  Vec3f eye() const;
  Vec3f target() const { return target_; }
  Vec3f forward() const { return normalized(target_ - eye()); }
  Vec3f right() const { return normalized(cross(forward(), {0, 1, 0})); }
  Vec3f up() const { return cross(right(), forward()); }
  float distance() const { return distance_; }
  float fov() const { return kFov; }
  void turn_to(float azimuth, float elevation);

  Mat4 view() const { return look_at(eye(), target_, {0, 1, 0}); }
  Mat4 projection(float aspect) const;
  // The direction through a point of the view, x and y in -1 … 1.
  Vec3f ray(float x, float y, float aspect) const;

 private:
  static constexpr float kFov = 0.6f;  // rad, bottom to top

  float lowest() const;
  void stay_above();

  Vec3f target_{};
  float azimuth_ = 0.52f, elevation_ = 0.3f;  // rad
  float distance_ = 3;
  float floor_ = -std::numeric_limits<float>::infinity();
};

}  // namespace weft::viewer
