// Bodies, cloths, and what is held of them.
#include "hands/pusher.h"

#include <imgui.h>

#include "edit/cloth_place.h"
#include "panel/theme.h"
#include "weft/shape.h"

namespace weft::viewer {

// A scene whose pins move is about its cloth, others about their first body.
void Pusher::follow_scene(const Workspace& workspace) {
  const Scene& scene = workspace.document().scene();
  const bool gone =
      chosen_ && chosen_->number >= (is(Kind::body) ? scene.colliders.size() : scene.cloths.size());
  if (scene_ == workspace.document().path() && !gone) return;
  scene_ = workspace.document().path();
  bool carried = false;
  for (const Cloth& cloth : scene.cloths)
    for (const Pin& pin : cloth.pins) carried = carried || pin.moves();
  chosen_ = Part{Kind::cloth, 0};
  for (std::size_t n = scene.colliders.size(); n-- > 0 && !carried;)
    if (!std::holds_alternative<Plane>(scene.colliders[n].shape)) chosen_ = Part{Kind::body, n};
}

// A part that was just added is not simulated yet.
bool Pusher::there(const Workspace& workspace) const {
  if (!chosen_) return false;
  const FrameData& now = workspace.frame_data();
  const Scene& scene = workspace.document().scene();
  return is(Kind::body) ? chosen_->number < std::min(now.bodies.size(), scene.colliders.size())
                        : chosen_->number < std::min(now.cloths.size(), scene.cloths.size());
}

// Of a cloth: the middle of the box about it.
Vec3f Pusher::place(const Workspace& workspace) const {
  const FrameData& now = workspace.frame_data();
  if (is(Kind::body)) return to_float(place_of(now.bodies[chosen_->number].shape));
  Bounds bounds;
  const ClothCopy& cloth = now.cloths[chosen_->number];
  for (int p = 0; p < cloth.columns * cloth.rows; ++p) bounds.add(cloth.position(p));
  return bounds.center();
}

Handles Pusher::handles(const Workspace& workspace) const {
  if (is(Kind::cloth)) return {};
  const Shape& shape = workspace.frame_data().bodies[chosen_->number].shape;
  return {can_turn(shape), can_size(shape)};
}

bool Pusher::take_handle(const Workspace& workspace, const Area& area, float x, float y) {
  if (!there(workspace)) return false;
  const auto grip = grip_under(workspace.camera, area, place(workspace), handles(workspace), x, y);
  if (!grip) return false;
  take(workspace, *grip, {});
  grip_ = on_plane(ray_through(workspace.camera, area, x, y), start_,
                   normal_of(workspace.camera.forward()));
  return true;
}

void Pusher::take_body(const Workspace& workspace, int body, Vec3f point) {
  chosen_ = Part{Kind::body, static_cast<std::size_t>(body)};
  take(workspace, {}, point);
}

void Pusher::take(const Workspace& workspace, Grip grip, Vec3f point) {
  scene_ = workspace.document().path();
  held_ = grip;
  grip_ = point;
  start_ = now_ = place(workspace);
  before_ = workspace.document().scene();
  joined_ = false;
}

// Of the plane in which the pointer moves: across the view, or along the arrow, or the ring's own.
Vec3f Pusher::normal_of(Vec3f forward) const {
  const Vec3f axis = kAxes[held_.axis];
  if (held_.kind == Grip::Kind::arrow) return normalized(cross(axis, cross(forward, axis)));
  return held_.kind == Grip::Kind::ring ? axis : forward;
}

// How far the part goes while the pointer goes to a point.
Vec3f Pusher::shift(Vec3f to) const {
  const Vec3f by = to - grip_, axis = kAxes[held_.axis];
  return held_.kind == Grip::Kind::arrow ? axis * dot(by, axis) : by;
}

void Pusher::drag(Workspace& workspace, const Ray& ray) {
  if (!there(workspace)) return;
  const Vec3f to = on_plane(ray, grip_, normal_of(workspace.camera.forward()));
  const bool moves = held_.kind == Grip::Kind::arrow || held_.kind == Grip::Kind::across;
  if (!moves || is(Kind::cloth)) return reshape(workspace, to);
  if (!(start_ + shift(to) == now_)) move_body(workspace, start_ + shift(to));
}

// As the part was when it was taken, moved, turned or sized by what lies between there and the pointer: the
// angle about the middle, or the ratio of the distances from it.
void Pusher::reshape(Workspace& workspace, Vec3f to) {
  constexpr double kLeast = 0.02, kMost = 50;
  if (to == now_ || to == grip_) return;
  now_ = to;
  Scene scene = before_;
  const Vec3f from = grip_ - start_, now = to - start_;
  const double factor =
      std::clamp(static_cast<double>(length(now) / std::max(length(from), 1e-6f)), kLeast, kMost);
  const auto angle =
      static_cast<double>(std::atan2(dot(cross(from, now), kAxes[held_.axis]), dot(from, now)));
  const bool sizes = held_.kind == Grip::Kind::square, turns = held_.kind == Grip::Kind::ring;
  std::string name = "cloth";
  if (is(Kind::body)) {
    Shape& shape = scene.colliders[chosen_->number].shape;
    shape = sizes ? sized(shape, factor) : turned(shape, held_.axis, angle);
    name = kShapeNames[shape.index()];
  } else {
    Cloth& cloth = scene.cloths[chosen_->number];
    cloth = sizes   ? sized(cloth, factor)
            : turns ? turned(cloth, held_.axis, angle)
                    : moved(cloth, to_double(shift(to)));
    if (!joined_ && workspace.frame_data().frame > 0)
      workspace.messages.tell("The cloth starts elsewhere: the scene starts anew", workspace.now());
  }
  const std::string what = sizes ? "size " : turns ? "turn " : "move ";
  joined_ = workspace.edit(scene, what + name, joined_) || joined_;
}

void Pusher::move_body(Workspace& workspace, Vec3f to) {
  now_ = to;
  moved_ = true;
  Input input{.kind = Input::Kind::move_collider};
  input.collider = static_cast<int>(chosen_->number);
  input.a = workspace.in_scene(to);
  workspace.give(input);
}

void Pusher::let_go(Workspace& workspace) {
  if (!moved_ || !is(Kind::body) || !there(workspace)) return;
  moved_ = false;
  const Collider& collider = workspace.document().scene().colliders[chosen_->number];
  const std::string place = "/colliders/" + std::to_string(chosen_->number);
  const Vec3 to = workspace.in_scene(now_);
  const std::string shape = place + "/" + kShapeNames[collider.shape.index()] + "/";
  std::vector<Document::Change> changes{{place + "/keys", text::Json::array()}};
  // The other end of an axis comes along.
  Collider still = collider;
  still.keys.clear();
  const Vec3 by = minus(to, place_of(shape_at(still, workspace.frame_data().time)));
  const Shape there = moved(collider.shape, by);
  if (!collider.rotate.keys.empty())
    changes.push_back({place + "/rotate/about", text::Json(plus(collider.rotate.about, by))});
  for_each_value(there, [&](const char* key, const auto& value, ShapeValue is) {
    if constexpr (std::is_same_v<decltype(value), const Vec3&>) {
      if (is == ShapeValue::place || is == ShapeValue::point)
        changes.push_back({shape + key, value});
    }
  });
  workspace.edit(changes, false, std::string("move ") + kShapeNames[collider.shape.index()]);
}

void Pusher::carry(Workspace& workspace, Vec3f velocity) {
  const Scene& scene = workspace.document().scene();
  std::vector<Document::Change> changes;  // pins leave their paths
  for (std::size_t c = 0; c < scene.cloths.size(); ++c)
    for (std::size_t p = 0; p < scene.cloths[c].pins.size(); ++p)
      if (const Pin& pin = scene.cloths[c].pins[p]; pin.moves())
        changes.push_back({"/cloths/" + std::to_string(c) + "/pins/" + std::to_string(p),
                           still_pin_json(scene.cloths[c], pin)});
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
  if (is(Kind::body) && there(workspace)) {
    if (!moved_) now_ = place(workspace);
    pushing_ = true;
    move_body(workspace, now_ + velocity * static_cast<float>(seconds));
  } else if (is(Kind::cloth)) {
    carry(workspace, velocity);
    carrying_ = true;
  }
}

void Pusher::draw(const Workspace& workspace, const Area& area, ImDrawList& list) const {
  if (!there(workspace)) return;
  const Vec3f at = place(workspace);
  draw_handles(workspace.camera, area, at, handles(workspace), list);
  const ScreenPoint middle = Projector(workspace.camera, area)(at);
  if (middle.seen) mark("handles", {middle.x, middle.y});
}

}  // namespace weft::viewer
