// Handles on the screen, of one size wherever they stand.
#include "hands/gizmo.h"

#include <imgui.h>

#include <numbers>

namespace weft::viewer {

namespace {

constexpr float kArrow = 80;   // length on the screen
constexpr float kRing = 108;   // radius there
constexpr float kSquare = 68;  // from the middle to the square, to the right and up in equal parts
constexpr float kReach = 9;    // how near the pointer must come
constexpr ImU32 kAxisColors[3] = {IM_COL32(235, 87, 87, 255), IM_COL32(111, 207, 151, 255),
                                  IM_COL32(86, 156, 255, 255)};
constexpr ImU32 kFaint = IM_COL32(255, 255, 255, 150);  // of the rings

using Outline = std::array<ScreenPoint, 49>;

// The length in the scene that shows as `pixels` at the point.
float length_of(const Camera& camera, const Area& area, Vec3f at, float pixels) {
  const float depth = dot(at - camera.eye(), camera.forward());
  return pixels / area.height * 2 * depth * std::tan(camera.fov() / 2);
}

float distance_to(ImVec2 p, ImVec2 a, ImVec2 b) {
  const float ex = b.x - a.x, ey = b.y - a.y, square = ex * ex + ey * ey;
  const float t =
      square > 0 ? std::clamp(((p.x - a.x) * ex + (p.y - a.y) * ey) / square, 0.0f, 1.0f) : 0;
  return std::hypot(p.x - a.x - t * ex, p.y - a.y - t * ey);
}

float distance_to(ImVec2 p, const ScreenPoint& a, const ScreenPoint& b) {
  return a.seen && b.seen ? distance_to(p, ImVec2{a.x, a.y}, ImVec2{b.x, b.y}) : 1e9f;
}

Outline ring(const Camera& camera, const Area& area, Vec3f at, std::size_t axis) {
  const Projector project(camera, area);
  const float r = length_of(camera, area, at, kRing);
  const Vec3f u = kAxes[(axis + 1) % 3], v = kAxes[(axis + 2) % 3];
  Outline outline;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) /
                        static_cast<float>(outline.size() - 1);
    outline[k] = project(at + u * (r * std::cos(angle)) + v * (r * std::sin(angle)));
  }
  return outline;
}

ScreenPoint square(const Camera& camera, const Area& area, Vec3f at) {
  const float r = length_of(camera, area, at, kSquare) / std::numbers::sqrt2_v<float>;
  return Projector(camera, area)(at + (camera.right() + camera.up()) * r);
}

}  // namespace

std::optional<Grip> grip_under(const Camera& camera, const Area& area, Vec3f at, Handles handles,
                               float x, float y) {
  const Projector project(camera, area);
  const ScreenPoint corner = square(camera, area, at);
  if (handles.square && corner.seen && std::hypot(corner.x - x, corner.y - y) <= kReach)
    return Grip{Grip::Kind::square, 0};
  const float reach = length_of(camera, area, at, kArrow);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (distance_to({x, y}, project(at), project(at + kAxes[axis] * reach)) <= kReach)
      return Grip{Grip::Kind::arrow, axis};
  for (std::size_t axis = 0; axis < 3 && handles.rings; ++axis) {
    const Outline outline = ring(camera, area, at, axis);
    for (std::size_t k = 1; k < outline.size(); ++k)
      if (distance_to({x, y}, outline[k - 1], outline[k]) <= kReach)
        return Grip{Grip::Kind::ring, axis};
  }
  return std::nullopt;
}

void draw_handles(const Camera& camera, const Area& area, Vec3f at, Handles handles,
                  ImDrawList& list) {
  const Projector project(camera, area);
  const float reach = length_of(camera, area, at, kArrow);
  const ScreenPoint from = project(at);
  for (std::size_t k = 0; k < 3; ++k) {
    const ScreenPoint to = project(at + kAxes[k] * reach);
    if (!from.seen || !to.seen) continue;
    const float dx = to.x - from.x, dy = to.y - from.y, l = std::hypot(dx, dy);
    if (l < 6) continue;  // towards the eye
    const ImVec2 tip{to.x, to.y}, u{dx / l, dy / l};
    list.AddLine({from.x, from.y}, tip, kAxisColors[k], 3);
    list.AddTriangleFilled({tip.x + 10 * u.x, tip.y + 10 * u.y}, {tip.x - 5 * u.y, tip.y + 5 * u.x},
                           {tip.x + 5 * u.y, tip.y - 5 * u.x}, kAxisColors[k]);
  }
  list.AddCircleFilled({from.x, from.y}, 5, IM_COL32(255, 255, 255, 230));
  for (std::size_t axis = 0; axis < 3 && handles.rings; ++axis) {
    const Outline outline = ring(camera, area, at, axis);
    for (std::size_t k = 1; k < outline.size(); ++k)
      if (const ScreenPoint& a = outline[k - 1], &b = outline[k]; a.seen && b.seen)
        list.AddLine({a.x, a.y}, {b.x, b.y}, kAxisColors[axis] & kFaint, 2);
  }
  if (const ScreenPoint p = square(camera, area, at); handles.square && p.seen)
    list.AddRectFilled({p.x - 6, p.y - 6}, {p.x + 6, p.y + 6}, IM_COL32(255, 255, 255, 230), 2);
}

}  // namespace weft::viewer
