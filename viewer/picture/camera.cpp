// Orbiting camera; y is always up in the picture.
#include "picture/camera.h"

#include <numbers>

namespace weft::viewer {

void Camera::turn_to(float azimuth, float elevation) {
  azimuth_ = std::remainder(azimuth, 2 * std::numbers::pi_v<float>);
  elevation_ = std::clamp(elevation, -1.5f, 1.5f);
}

// The nearest distance from which all corners of the box are inside the view.
void Camera::frame(const Bounds& bounds, float aspect, float clear) {
  if (bounds.empty()) return;
  target_ = bounds.center();
  const Vec3f f = forward(), r = right(), u = up();
  const float tan_x = std::tan(kFov / 2) * aspect, tan_y = std::tan(kFov / 2) * clear;
  float needed = 0.05f;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3f p = Vec3f{(corner & 1) != 0 ? bounds.high.x : bounds.low.x,
                          (corner & 2) != 0 ? bounds.high.y : bounds.low.y,
                          (corner & 4) != 0 ? bounds.high.z : bounds.low.z} -
                    target_;
    const float across = std::max(std::abs(dot(p, r)) / tan_x, std::abs(dot(p, u)) / tan_y);
    needed = std::max(needed, across - dot(p, f));
  }
  distance_ = needed * 1.1f;
  stay_above();
}

// So far above the floor that the near plane does not meet it.
float Camera::lowest() const {
  return floor_ + 0.02f * distance_;
}

// The whole camera is lifted: it looks the same way.
void Camera::stay_above() {
  target_.y += std::max(0.0f, lowest() - eye().y);
}

// The eye is `high` above and `back` behind the point, in the camera's own directions, so that it stands at
// high cos(e) + back sin(e) = r sin(e + angle) over it, at elevation e.
void Camera::orbit(float azimuth, float elevation, Vec3f about) {
  const Vec3f from = target_ - about;
  const float across = dot(from, right()), high = dot(from, up()), deep = dot(from, forward());
  const float back = distance_ - deep, r = std::hypot(high, back);
  float next = elevation_ + elevation;
  if (const float sine = (lowest() - about.y) / r; elevation < 0 && std::abs(sine) < 1)
    next = std::max(next, std::min(elevation_, std::asin(sine) - std::atan2(high, back)));
  turn_to(azimuth_ - azimuth, next);
  target_ = about + right() * across + up() * high + forward() * deep;
  stay_above();
}

void Camera::pan(float x, float y) {
  const float height = 2 * distance_ * std::tan(kFov / 2);
  target_ = target_ - right() * (x * height) + up() * (y * height);
  stay_above();
}

void Camera::zoom(float notches) {
  distance_ = std::clamp(distance_ * std::pow(0.88f, notches), 1e-3f, 1e5f);
}

void Camera::zoom(float notches, float x, float y, float aspect) {
  const float before = distance_;
  zoom(notches);
  const float t = std::tan(kFov / 2) * (before - distance_);
  target_ = target_ + right() * (x * t * aspect) + up() * (y * t);
  stay_above();
}

Vec3f Camera::eye() const {
  return target_ + distance_ * Vec3f{std::sin(azimuth_) * std::cos(elevation_),
                                     std::sin(elevation_),
                                     std::cos(azimuth_) * std::cos(elevation_)};
}

Mat4 Camera::projection(float aspect) const {
  return perspective(kFov, aspect, distance_ * 0.02f, distance_ * 60);
}

Vec3f Camera::ray(float x, float y, float aspect) const {
  const float t = std::tan(kFov / 2);
  return normalized(forward() + right() * (x * t * aspect) + up() * (y * t));
}

}  // namespace weft::viewer
