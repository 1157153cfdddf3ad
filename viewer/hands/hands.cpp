// What a press of the pointer begins, by tool; and what goes on until it is let go.
#include "hands/hands.h"

#include <imgui.h>

namespace weft::viewer {

namespace {

constexpr double kPull = 2000;  // N/m, of the hand's spring
constexpr float kTurn = 3.2f;   // rad, by a drag over the picture's height
constexpr std::size_t kMostMarks = 400;

}  // namespace

void Hands::update(Workspace& workspace, const Area& area, const Pointer& pointer) {
  if (pointer.inside && pointer.wheel != 0) workspace.camera.zoom(pointer.wheel);
  if (pointer.inside && pointer.pressed) press(workspace, area, pointer);
  const bool free = drag_ == Drag::none;
  if (pointer.inside && pointer.right && free) panning_ = true;
  if (!pointer.right) panning_ = false;
  if (panning_ || drag_ == Drag::pan)
    workspace.camera.pan(pointer.dx / area.height, -pointer.dy / area.height);
  if ((pointer.middle && pointer.inside && free) || drag_ == Drag::orbit)
    workspace.camera.orbit(kTurn * pointer.dx / area.height, kTurn * pointer.dy / area.height);
  if (!free) drag(workspace, area, pointer);
  if (pointer.released || (!pointer.left && !pointer.pressed && drag_ != Drag::none))
    release(workspace);
}

void Hands::press(Workspace& workspace, const Area& area, const Pointer& pointer) {
  const Ray ray = ray_through(workspace.camera, area, pointer.x, pointer.y);
  if (pointer.ctrl || pointer.alt) {
    drag_ = pointer.ctrl ? Drag::pan : Drag::orbit;
    return;
  }
  drag_ = Drag::orbit;
  const auto cloth = pick_cloth(workspace.frame_data(), ray);
  if (tool == Tool::pin || pointer.shift) {
    if (cloth) toggle_pin(workspace, *cloth);
    if (cloth) drag_ = Drag::none;
    return;
  }
  if (tool == Tool::ball) {
    shoot(workspace, ray);
    drag_ = Drag::none;
    return;
  }
  if (tool == Tool::cut) {
    drag_ = Drag::cut;
    stroke_ = {{pointer.x, pointer.y, cloth}};
    return;
  }
  if (tool == Tool::move && pusher.take_arrow(workspace, area, pointer.x, pointer.y)) {
    drag_ = Drag::body;
    return;
  }
  const auto body = pick_body(workspace.frame_data(), ray);
  const bool cloth_first = cloth && (!body || cloth->distance <= body->distance);
  if (cloth_first && tool == Tool::move) {
    pusher.choose(Pusher::kCloth);
  } else if (cloth_first) {
    drag_ = Drag::cloth;
    held_ = *cloth;
    grab(workspace, ray);
  } else if (body) {
    drag_ = Drag::body;
    pusher.take_body(workspace, body->body, body->point);
  }
}

void Hands::drag(Workspace& workspace, const Area& area, const Pointer& pointer) {
  const Ray ray = ray_through(workspace.camera, area, pointer.x, pointer.y);
  if (drag_ == Drag::cloth) grab(workspace, ray);
  if (drag_ == Drag::body) pusher.drag(workspace, ray);
  if (drag_ != Drag::cut) return;
  const StrokePoint& last = stroke_.back();
  if (std::hypot(pointer.x - last.x, pointer.y - last.y) < 6) return;
  const auto hit = pick_cloth(workspace.frame_data(), ray);
  stroke_.push_back({pointer.x, pointer.y, hit});
  cut(workspace);
}

void Hands::release(Workspace& workspace) {
  if (drag_ == Drag::cloth) workspace.give(Input{.kind = Input::Kind::release});
  if (drag_ == Drag::body) pusher.let_go(workspace);
  stroke_.clear();
  drag_ = Drag::none;
}

// The particle follows the pointer in the plane across the view through where it was taken.
void Hands::grab(Workspace& workspace, const Ray& ray) {
  const Vec3f target = on_plane(ray, held_.point, workspace.camera.forward());
  if (target == target_ && !(target == held_.point)) return;
  target_ = target;
  Input input{.kind = Input::Kind::grab};
  input.cloth = held_.cloth, input.particle = held_.particle;
  input.a = workspace.in_scene(target);
  input.amount = kPull;
  workspace.give(input);
}

// Between the last two points of the stroke that lie on the cloth.
void Hands::cut(Workspace& workspace) {
  const auto& from = stroke_[stroke_.size() - 2].hit;
  const auto& to = stroke_.back().hit;
  if (!from || !to || from->cloth != to->cloth) return;
  const auto& cloths = workspace.frame_data().scene->cloths;
  Input input{.kind = Input::Kind::cut};
  input.a = workspace.in_scene(from->point);
  input.b = workspace.in_scene(to->point);
  input.amount = 0.2 * spacing_of(cloths[static_cast<std::size_t>(to->cloth)]);
  workspace.give(input);
}

void Hands::toggle_pin(Workspace& workspace, const ClothHit& hit) const {
  const ClothCopy& cloth = workspace.frame_data().cloths[static_cast<std::size_t>(hit.cloth)];
  const bool held = cloth.inverse_mass[cloth.at(hit.particle)] == 0;
  Input input{.kind = held ? Input::Kind::unpin : Input::Kind::pin};
  input.cloth = hit.cloth, input.particle = hit.particle;
  workspace.give(input);
}

// A ball on a path of free flight from the eye, p + v t + g t²/2, until it lies on the floor.
void Hands::shoot(Workspace& workspace, const Ray& ray) const {
  constexpr double kSeconds = 2.5, kEvery = 1.0 / 30;
  const Setting& setting = workspace.setting();
  const double radius = 0.06 * setting.size, start = workspace.frame_data().time;
  const Vec3 g = workspace.document().scene().gravity;
  const Vec3 from =
      workspace.in_scene(ray.origin + ray.direction * (0.3f * workspace.camera.distance()));
  const Vec3 velocity = to_double(ray.direction * (2.2f * setting.size));
  const double lowest = workspace.frame_data().origin[1] + setting.ground + radius;
  text::Json keys = text::Json::array();
  for (double t = 0; t <= kSeconds; t += kEvery) {
    Vec3 p{};
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = std::clamp(from[k] + velocity[k] * t + 0.5 * g[k] * t * t, -9999.0, 9999.0);
    const bool landed = setting.has_ground && p[1] < lowest;
    if (landed) p[1] = lowest;
    keys.push_back({start + t, p[0], p[1], p[2]});
    if (landed) break;
  }
  const text::Json ball{{"sphere", {{"center", from}, {"radius", radius}}},
                        {"friction", 0.3},
                        {"offset", 0.02 * radius},
                        {"keys", keys}};
  workspace.edit({{"/colliders/-", ball}});
}

void Hands::draw(const Workspace& workspace, const Area& area, ImDrawList& list) const {
  const Projector project(workspace.camera, area);
  std::size_t marks = 0;
  for (const ClothCopy& cloth : workspace.frame_data().cloths)
    for (int j = 0; j < cloth.rows; ++j)
      for (int i = 0; i < cloth.columns && marks < kMostMarks; ++i) {
        if (cloth.inverse_mass[cloth.at(i, j)] != 0) continue;
        ++marks;
        const ScreenPoint p = project(cloth.position(j * cloth.columns + i));
        if (!p.seen) continue;
        list.AddCircleFilled({p.x, p.y}, 4, IM_COL32(20, 22, 28, 200));
        list.AddCircleFilled({p.x, p.y}, 2.6f, IM_COL32(255, 209, 102, 255));
      }
  if (drag_ == Drag::cloth) {
    const ClothCopy& cloth = workspace.frame_data().cloths[static_cast<std::size_t>(held_.cloth)];
    const ScreenPoint a = project(cloth.position(held_.particle)), b = project(target_);
    if (a.seen && b.seen) list.AddLine({a.x, a.y}, {b.x, b.y}, IM_COL32(255, 255, 255, 160), 1.5f);
    if (a.seen) list.AddCircle({a.x, a.y}, 7, IM_COL32(255, 255, 255, 220), 0, 2);
  }
  for (std::size_t k = 1; k < stroke_.size(); ++k)
    list.AddLine({stroke_[k - 1].x, stroke_[k - 1].y}, {stroke_[k].x, stroke_[k].y},
                 IM_COL32(255, 107, 107, 230), 2);
  if (tool == Tool::move) pusher.draw(workspace, area, list);
}

}  // namespace weft::viewer
