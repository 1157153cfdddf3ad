// Bodies and carried cloth.
#include "hands/pusher.h"

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

// Two directions across an axis.
std::pair<Vec3f, Vec3f> across(std::size_t axis) {
  return {kAxes[(axis + 1) % 3], kAxes[(axis + 2) % 3]};
}

float distance_to(ImVec2 p, const ScreenPoint& a, const ScreenPoint& b) {
  return a.seen && b.seen ? distance_to(p, ImVec2{a.x, a.y}, ImVec2{b.x, b.y}) : 1e9f;
}

std::string place_key(const Shape& shape) {
  constexpr const char* keys[] = {"sphere/center", "plane/point", "capsule/a",
                                  "box/center",    "cylinder/a",  "mesh/translate"};
  return keys[shape.index()];
}

}  // namespace

// A scene whose pins move is about its cloth, others about their first body.
void Pusher::follow_scene(const Workspace& workspace) {
  const Scene& scene = workspace.document().scene();
  const bool there = chosen_ < static_cast<int>(scene.colliders.size());
  if (scene_ == workspace.document().path() && there) return;
  scene_ = workspace.document().path();
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

Pusher::Outline Pusher::ring(const Workspace& workspace, const Area& area, Vec3f at,
                             std::size_t axis) {
  const Projector project(workspace.camera, area);
  const float r = length_of(workspace.camera, area, at, kRing);
  const auto [u, v] = across(axis);
  Outline outline;
  for (std::size_t k = 0; k < outline.size(); ++k) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(k) /
                        static_cast<float>(outline.size() - 1);
    outline[k] = project(at + u * (r * std::cos(angle)) + v * (r * std::sin(angle)));
  }
  return outline;
}

ScreenPoint Pusher::square(const Workspace& workspace, const Area& area, Vec3f at) {
  const float r = length_of(workspace.camera, area, at, kSquare) / std::numbers::sqrt2_v<float>;
  const Projector project(workspace.camera, area);
  return project(at + (workspace.camera.right() + workspace.camera.up()) * r);
}

bool Pusher::take_gizmo(const Workspace& workspace, const Area& area, float x, float y) {
  if (chosen_ < 0 || !has_body(workspace)) return false;
  const Vec3f at = place(workspace);
  const Ray ray = ray_through(workspace.camera, area, x, y);
  const Shape& shape = workspace.frame_data().bodies[static_cast<std::size_t>(chosen_)].shape;
  const ScreenPoint corner = square(workspace, area, at);
  if (can_size(shape) && corner.seen && std::hypot(corner.x - x, corner.y - y) <= kReach)
    return take(workspace, Grip::square, 0, ray);
  const Projector project(workspace.camera, area);
  const float reach = length_of(workspace.camera, area, at, kArrow);
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (distance_to({x, y}, project(at), project(at + kAxes[axis] * reach)) <= kReach)
      return take(workspace, Grip::arrow, axis, ray);
  for (std::size_t axis = 0; axis < 3 && can_turn(shape); ++axis) {
    const Outline outline = ring(workspace, area, at, axis);
    for (std::size_t k = 1; k < outline.size(); ++k)
      if (distance_to({x, y}, outline[k - 1], outline[k]) <= kReach)
        return take(workspace, Grip::ring, axis, ray);
  }
  return false;
}

bool Pusher::take(const Workspace& workspace, Grip grip, std::size_t axis, const Ray& ray) {
  take_body(workspace, chosen_, place(workspace));
  held_ = grip;
  axis_ = axis;
  grip_ = on_plane(ray, start_, normal_of(workspace.camera.forward()));
  return true;
}

void Pusher::take_body(const Workspace& workspace, int body, Vec3f point) {
  scene_ = workspace.document().path();
  chosen_ = body;
  held_ = Grip::across;
  grip_ = point;
  start_ = now_ = place(workspace);
  reshaped_ = false;
  const auto number = static_cast<std::size_t>(body);
  if (number < workspace.document().scene().colliders.size())
    shape_ = workspace.document().scene().colliders[number].shape;
}

// Of the plane in which the pointer moves: across the view, or along the arrow, or the ring's own.
Vec3f Pusher::normal_of(Vec3f forward) const {
  const Vec3f axis = kAxes[axis_];
  if (held_ == Grip::arrow) return normalized(cross(axis, cross(forward, axis)));
  return held_ == Grip::ring ? axis : forward;
}

void Pusher::drag(Workspace& workspace, const Ray& ray) {
  if (chosen_ < 0 || !has_body(workspace)) return;
  const Vec3f to = on_plane(ray, grip_, normal_of(workspace.camera.forward()));
  if (held_ == Grip::ring || held_ == Grip::square) return reshape(workspace, to);
  Vec3f by = to - grip_;
  if (held_ == Grip::arrow) by = kAxes[axis_] * dot(by, kAxes[axis_]);
  if (!(start_ + by == now_)) move_body(workspace, start_ + by);
}

// By the angle, or the ratio of the distances from the middle, between where it was taken and the pointer.
void Pusher::reshape(Workspace& workspace, Vec3f to) {
  constexpr double kLeast = 0.02, kMost = 50;
  const auto number = static_cast<std::size_t>(chosen_);
  Scene scene = workspace.document().scene();
  if (to == now_ || number >= scene.colliders.size()) return;
  now_ = to;
  const Vec3f from = grip_ - start_, now = to - start_;
  Shape& shape = scene.colliders[number].shape;
  const std::string name = kShapeNames[shape.index()];
  if (held_ == Grip::square) {
    const double factor = static_cast<double>(length(now) / std::max(length(from), 1e-6f));
    shape = sized(shape_, std::clamp(factor, kLeast, kMost));
  } else {
    const float angle = std::atan2(dot(cross(from, now), kAxes[axis_]), dot(from, now));
    shape = turned(shape_, axis_, static_cast<double>(angle));
  }
  const std::string what = held_ == Grip::square ? "size " : "turn ";
  reshaped_ = workspace.edit(scene, what + name, reshaped_) || reshaped_;
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
                           pin_json(scene.cloths[c], particle_number(scene.cloths[c], pin))});
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
  if (chosen_ >= 0 && has_body(workspace)) {
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
  const Shape& shape = workspace.frame_data().bodies[static_cast<std::size_t>(chosen_)].shape;
  for (std::size_t axis = 0; axis < 3 && can_turn(shape); ++axis) {
    const Outline outline = ring(workspace, area, at, axis);
    for (std::size_t k = 1; k < outline.size(); ++k)
      if (const ScreenPoint& a = outline[k - 1], &b = outline[k]; a.seen && b.seen)
        list.AddLine({a.x, a.y}, {b.x, b.y}, kAxisColors[axis] & kFaint, 2);
  }
  if (const ScreenPoint p = square(workspace, area, at); can_size(shape) && p.seen)
    list.AddRectFilled({p.x - 6, p.y - 6}, {p.x + 6, p.y + 6}, IM_COL32(255, 255, 255, 230), 2);
}

}  // namespace weft::viewer
