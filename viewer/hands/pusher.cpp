// Bodies and carried cloth.
#include "hands/pusher.h"

#include <imgui.h>

namespace weft::viewer {

namespace {

constexpr float kArrow = 80;  // length on the screen
constexpr float kReach = 9;   // how near the pointer must come
constexpr ImU32 kAxisColors[3] = {IM_COL32(235, 87, 87, 255), IM_COL32(111, 207, 151, 255),
                                  IM_COL32(86, 156, 255, 255)};
constexpr Vec3f kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

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

std::string place_key(const Shape& shape) {
  constexpr const char* keys[] = {"sphere/center", "plane/point", "capsule/a", "box/center",
                                  "cylinder/a"};
  return keys[shape.index()];
}

}  // namespace

// A scene whose pins move is about its cloth, others about their first body.
void Pusher::follow_scene(const Workspace& workspace) {
  if (scene_ == workspace.document().path() && has_body(workspace)) return;
  scene_ = workspace.document().path();
  const Scene& scene = workspace.document().scene();
  bool carried = false;
  for (const Cloth& cloth : scene.cloths)
    for (const Pin& pin : cloth.pins) carried = carried || pin.moves();
  chosen_ = kCloth;
  for (std::size_t n = scene.colliders.size(); n-- > 0 && !carried;)
    if (!std::holds_alternative<Plane>(scene.colliders[n].shape)) chosen_ = static_cast<int>(n);
}

bool Pusher::has_body(const Workspace& workspace) const {
  return chosen_ < static_cast<int>(workspace.frame_data().bodies.size());
}

Vec3f Pusher::place(const Workspace& workspace) const {
  return to_float(place_of(workspace.frame_data().bodies[static_cast<std::size_t>(chosen_)].shape));
}

bool Pusher::take_arrow(const Workspace& workspace, const Area& area, float x, float y) {
  if (chosen_ < 0 || !has_body(workspace)) return false;
  const Projector project(workspace.camera, area);
  const Vec3f at = place(workspace);
  const float reach = length_of(workspace.camera, area, at, kArrow);
  const ScreenPoint from = project(at);
  for (const Vec3f axis : kAxes) {
    const ScreenPoint to = project(at + axis * reach);
    if (!from.seen || !to.seen) continue;
    if (distance_to({x, y}, {from.x, from.y}, {to.x, to.y}) > kReach) continue;
    take_body(workspace, chosen_, at);
    axis_ = axis;
    grip_ = on_plane(ray_through(workspace.camera, area, x, y), at,
                     normalized(cross(axis, cross(workspace.camera.forward(), axis))));
    return true;
  }
  return false;
}

void Pusher::take_body(const Workspace& workspace, int body, Vec3f point) {
  scene_ = workspace.document().path();
  chosen_ = body;
  axis_ = {};
  grip_ = point;
  start_ = now_ = place(workspace);
}

void Pusher::drag(Workspace& workspace, const Ray& ray) {
  if (chosen_ < 0 || !has_body(workspace)) return;
  const Vec3f forward = workspace.camera.forward();
  const bool along = !(axis_ == Vec3f{});
  const Vec3f normal = along ? normalized(cross(axis_, cross(forward, axis_))) : forward;
  Vec3f by = on_plane(ray, grip_, normal) - grip_;
  if (along) by = axis_ * dot(by, axis_);
  const Vec3f to = start_ + by;
  if (!(to == now_)) move_body(workspace, to);
}

void Pusher::move_body(Workspace& workspace, Vec3f to) {
  now_ = to;
  moved_ = true;
  Input input{.kind = Input::Kind::move_collider};
  input.collider = chosen_;
  input.a = workspace.in_scene(to);
  workspace.give(input);
}

void Pusher::let_go(Workspace& workspace) {
  if (!moved_ || !has_body(workspace)) return;
  moved_ = false;
  const auto number = static_cast<std::size_t>(chosen_);
  if (number >= workspace.document().scene().colliders.size()) return;
  const Collider& collider = workspace.document().scene().colliders[number];
  const std::string place = "/colliders/" + std::to_string(chosen_);
  const Vec3 to = workspace.in_scene(now_);
  std::vector<Document::Change> changes{{place + "/" + place_key(collider.shape), to},
                                        {place + "/keys", text::Json::array()}};
  // The other end of an axis comes along.
  const Vec3 from = place_of(collider.shape);
  const Shape there = moved(collider.shape, {to[0] - from[0], to[1] - from[1], to[2] - from[2]});
  if (const Capsule* capsule = std::get_if<Capsule>(&there))
    changes.push_back({place + "/capsule/b", capsule->b});
  if (const Cylinder* cylinder = std::get_if<Cylinder>(&there))
    changes.push_back({place + "/cylinder/b", cylinder->b});
  workspace.edit(changes, false, std::string("move ") + kShapeNames[collider.shape.index()]);
}

void Pusher::carry(Workspace& workspace, Vec3f velocity) {
  const Scene& scene = workspace.document().scene();
  std::vector<Document::Change> changes;  // pins leave their paths
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    for (std::size_t p = 0; p < scene.cloths[c].pins.size(); ++p)
      if (const Pin& pin = scene.cloths[c].pins[p]; pin.moves())
        changes.push_back({"/cloths/" + std::to_string(c) + "/pins/" + std::to_string(p),
                           text::Json{pin.i, pin.j}});
  if (!changes.empty()) {
    workspace.edit(changes);
    return;
  }
  for (std::size_t c = 0; c < scene.cloths.size(); ++c) {
    Input input{.kind = Input::Kind::carry};
    input.cloth = static_cast<int>(c);
    input.a = to_double(velocity);
    workspace.give(input);
  }
}

void Pusher::push(Workspace& workspace, Vec3f direction, double seconds) {
  follow_scene(workspace);
  if (direction == Vec3f{}) {
    if (pushing_) let_go(workspace);
    if (carrying_) carry(workspace, {});
    pushing_ = carrying_ = false;
    return;
  }
  const Camera& camera = workspace.camera;
  const Vec3f level = normalized(Vec3f{camera.forward().x, 0, camera.forward().z});
  const float speed = 0.35f * workspace.setting().size;  // m/s
  const Vec3f velocity =
      (camera.right() * direction.x + Vec3f{0, 1, 0} * direction.y - level * direction.z) * speed;
  if (chosen_ >= 0) {
    if (!moved_) now_ = place(workspace);
    pushing_ = true;
    move_body(workspace, now_ + velocity * static_cast<float>(seconds));
  } else if (chosen_ == kCloth) {
    carry(workspace, velocity);
    carrying_ = true;
  }
}

void Pusher::draw(const Workspace& workspace, const Area& area, ImDrawList& list) const {
  if (chosen_ < 0 || !has_body(workspace)) return;
  const Projector project(workspace.camera, area);
  const Vec3f at = place(workspace);
  const float reach = length_of(workspace.camera, area, at, kArrow);
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
}

}  // namespace weft::viewer
