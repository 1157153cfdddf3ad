// What a press of the pointer begins, by tool; and what goes on until it is let go.
#include "hands/hands.h"

#include <imgui.h>

#include <set>

#include "panel/theme.h"
#include "picture/surface.h"

namespace weft::viewer {

namespace {

constexpr double kPull = 2000;  // N/m, of the hand's spring
constexpr float kTurn = 3.2f;   // rad, by a drag over the picture's height
constexpr std::size_t kMostMarks = 400;
constexpr float kStep = 4;   // pixels, of a stroke
constexpr float kClick = 5;  // pixels: a lasso no larger is a click

// Whether the point lies in the polygon (even-odd rule).
bool inside(const std::vector<std::array<float, 2>>& polygon, float x, float y) {
  bool in = false;
  for (std::size_t k = 0, l = polygon.size() - 1; k < polygon.size(); l = k++) {
    const auto [ax, ay] = polygon[k];
    const auto [bx, by] = polygon[l];
    if ((ay > y) != (by > y) && x < (bx - ax) * (y - ay) / (by - ay) + ax) in = !in;
  }
  return in;
}

void draw_path(ImDrawList& list, const std::vector<std::array<float, 2>>& points, ImU32 color,
               bool closed) {
  for (std::size_t k = 1; k < points.size(); ++k)
    list.AddLine({points[k - 1][0], points[k - 1][1]}, {points[k][0], points[k][1]}, color, 2);
  if (closed && points.size() > 2)
    list.AddLine({points.back()[0], points.back()[1]}, {points[0][0], points[0][1]}, color, 1);
}

}  // namespace

void Hands::update(Workspace& workspace, const Area& area, const Pointer& pointer) {
  if (pointer.inside && pointer.wheel != 0)
    workspace.camera.zoom(pointer.wheel, 2 * (pointer.x - area.x) / area.width - 1,
                          1 - 2 * (pointer.y - area.y) / area.height, area.aspect());
  watch_waiting(workspace);
  if (pointer.inside && pointer.pressed) press(workspace, area, pointer);
  const bool free = drag_ == Drag::none;
  if (pointer.inside && pointer.right && free) panning_ = true;
  if (!pointer.right) panning_ = false;
  if (panning_ || drag_ == Drag::pan)
    workspace.camera.pan(pointer.dx / area.height, -pointer.dy / area.height);
  const bool orbits = (pointer.middle && pointer.inside && free) || drag_ == Drag::orbit;
  if (orbits && !pivot_) pivot_ = pivot(workspace, area, pointer);
  if (!orbits) pivot_.reset();
  if (orbits)
    workspace.camera.orbit(kTurn * pointer.dx / area.height, kTurn * pointer.dy / area.height,
                           *pivot_);
  if (!free) drag(workspace, area, pointer);
  if (pointer.released || (!pointer.left && !pointer.pressed && drag_ != Drag::none))
    release(workspace, area);
}

// What lies under the pointer, else what the camera looks at.
Vec3f Hands::pivot(const Workspace& workspace, const Area& area, const Pointer& pointer) {
  const Ray ray = ray_through(workspace.camera, area, pointer.x, pointer.y);
  const auto cloth = pick_cloth(workspace.frame_data(), ray);
  const auto body = pick_body(workspace.frame_data(), ray);
  if (cloth && (!body || cloth->distance < body->distance)) return cloth->point;
  return body ? body->point : workspace.camera.target();
}

void Hands::press(Workspace& workspace, const Area& area, const Pointer& pointer) {
  const Ray ray = ray_through(workspace.camera, area, pointer.x, pointer.y);
  if (pointer.ctrl || pointer.alt) {
    drag_ = pointer.ctrl ? Drag::pan : Drag::orbit;
    return;
  }
  drag_ = Drag::orbit;
  let_go(workspace);
  const auto cloth = pick_cloth(workspace.frame_data(), ray);
  if (tool == Tool::pin || pointer.shift) {
    drag_ = Drag::lasso;
    lasso_ = {{pointer.x, pointer.y}};
    return;
  }
  if (tool == Tool::ball) {
    shoot(workspace, ray);
    drag_ = Drag::none;
    return;
  }
  if (tool == Tool::cut) {
    drag_ = Drag::cut;
    stroke_.begin(pointer.x, pointer.y);
    joined_ = false;
    cuts_.clear();
    const std::vector<Cloth>& cloths = workspace.document().scene().cloths;
    for (const Cloth& c : cloths) cuts_.push_back(c.cuts);
    if (std::any_of(cloths.begin(), cloths.end(), [](const Cloth& c) { return c.mesh.given(); }))
      workspace.messages.tell("Meshes are cut in this run alone; a new start makes them whole",
                              workspace.now());
    return;
  }
  if (tool == Tool::move && pusher.take_handle(workspace, area, pointer.x, pointer.y)) {
    drag_ = Drag::body;
    return;
  }
  const auto body = pick_body(workspace.frame_data(), ray);
  const bool cloth_first = cloth && (!body || cloth->distance <= body->distance);
  if (cloth_first && tool == Tool::move) {
    pusher.choose(Part{Kind::cloth, static_cast<std::size_t>(cloth->cloth)});
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
  const auto moved = [&](const std::array<float, 2>& from) {
    return std::hypot(pointer.x - from[0], pointer.y - from[1]) >= kStep;
  };
  if (drag_ == Drag::lasso && moved(lasso_.back())) lasso_.push_back({pointer.x, pointer.y});
  if (drag_ != Drag::cut || !moved(stroke_.points().back())) return;
  cut_meshes(workspace, area, ray);
  if (stroke_.go_on(workspace.frame_data(), workspace.camera, area, pointer.x, pointer.y))
    cut(workspace);
}

void Hands::release(Workspace& workspace, const Area& area) {
  if (drag_ == Drag::lasso) take_lasso(workspace, area);
  if (drag_ == Drag::cloth) {
    const FrameData& now = workspace.frame_data();
    waiting_ = Waiting{workspace.document().path(), now.frame, now.time};
    if (!workspace.telemetry().paused)
      let_go(workspace);
    else
      workspace.messages.tell("The hand pulls when the scene goes on; a click lets go",
                              workspace.now());
  }
  if (drag_ == Drag::body) pusher.let_go(workspace);
  stroke_.end();
  lasso_.clear();
  drag_ = Drag::none;
}

void Hands::let_go(Workspace& workspace) {
  if (waiting_) workspace.give(Input{.kind = Input::Kind::release});
  waiting_.reset();
}

// It is done when the point has come near, or cannot.
void Hands::watch_waiting(Workspace& workspace) {
  constexpr float kNear = 0.02f;  // sizes of the scene
  constexpr double kLongest = 2;  // s
  if (!waiting_) return;
  const FrameData& now = workspace.frame_data();
  const auto cloth = static_cast<std::size_t>(held_.cloth);
  if (waiting_->scene != workspace.document().path() || now.frame < waiting_->frame ||
      cloth >= now.cloths.size() ||
      held_.particle >= now.cloths[cloth].columns * now.cloths[cloth].rows) {
    waiting_.reset();  // another scene, or a new start: no hand is there
    return;
  }
  const float away = length(now.cloths[cloth].position(held_.particle) - target_);
  const bool moved = now.frame > waiting_->frame;
  if (moved && (away < kNear * workspace.setting().size || now.time - waiting_->since > kLongest))
    let_go(workspace);
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

// The stroke so far, as one change of the scene.
void Hands::cut(Workspace& workspace) {
  std::vector<Document::Change> changes;
  for (std::size_t c = 0; c < cuts_.size(); ++c) {
    std::vector<CutLine> all = cuts_[c];
    all.insert(all.end(), stroke_.lines(c).begin(), stroke_.lines(c).end());
    changes.push_back({"/cloths/" + std::to_string(c) + "/cuts", all});
  }
  joined_ = workspace.edit(changes, joined_, "cut") || joined_;
}

// What the stroke's last step crosses of a mesh; beside the cloth it goes on across the view.
void Hands::cut_meshes(Workspace& workspace, const Area& area, const Ray& to) const {
  constexpr double kWidth = 0.02;  // of the spacing
  const auto [x, y] = stroke_.points().back();
  const Ray rays[] = {ray_through(workspace.camera, area, x, y), to};
  std::optional<ClothHit> hits[2];
  for (std::size_t n = 0; n < 2; ++n) {
    hits[n] = pick_cloth(workspace.frame_data(), rays[n]);
    const auto& cloths = workspace.frame_data().cloths;
    if (hits[n] && !cloths[static_cast<std::size_t>(hits[n]->cloth)].mesh) hits[n].reset();
  }
  if (!hits[0] && !hits[1]) return;
  const ClothHit& met = hits[0] ? *hits[0] : *hits[1];
  const auto end = [&](std::size_t n) {
    const Vec3f beside = on_plane(rays[n], met.point, workspace.camera.forward());
    return workspace.in_scene(hits[n] ? hits[n]->point : beside);
  };
  const Scene& scene = workspace.document().scene();
  Input input{.kind = Input::Kind::cut};
  input.a = end(0), input.b = end(1);
  input.amount = kWidth * spacing_of(scene.cloths[static_cast<std::size_t>(met.cloth)]);
  workspace.give(input);
}

void Hands::choose_newest(const Workspace& workspace, Kind kind) {
  tool = Tool::move;
  const Scene& scene = workspace.document().scene();
  pusher.choose(
      Part{kind, (kind == Kind::body ? scene.colliders.size() : scene.cloths.size()) - 1});
}

// A small one is a click on the nearest particle.
void Hands::take_lasso(Workspace& workspace, const Area& area) const {
  const FrameData& frame_data = workspace.frame_data();
  std::vector<std::vector<int>> chosen(frame_data.cloths.size());
  const float x = lasso_.front()[0], y = lasso_.front()[1];
  const bool click = std::all_of(lasso_.begin(), lasso_.end(), [&](const auto& p) {
    return std::hypot(p[0] - x, p[1] - y) <= kClick;
  });
  if (click) {
    const auto hit = pick_cloth(frame_data, ray_through(workspace.camera, area, x, y));
    if (hit) chosen[static_cast<std::size_t>(hit->cloth)] = {hit->particle};
  } else {
    const Projector project(workspace.camera, area);
    for (std::size_t c = 0; c < chosen.size(); ++c)
      for (int p = 0; p < frame_data.cloths[c].columns * frame_data.cloths[c].rows; ++p)
        if (const ScreenPoint at = project(frame_data.cloths[c].position(p));
            at.seen && inside(lasso_, at.x, at.y))
          chosen[c].push_back(p);
  }
  toggle_pins(workspace, chosen);
}

void Hands::toggle_pins(Workspace& workspace,
                        const std::vector<std::vector<int>>& particles) const {
  const Scene& scene = workspace.document().scene();
  std::vector<Document::Change> changes;
  std::size_t pinned = 0, all = 0;
  std::vector<std::set<int>> held(particles.size());
  for (std::size_t c = 0; c < particles.size() && c < scene.cloths.size(); ++c) {
    for (const Pin& pin : scene.cloths[c].pins)
      for (const int p : held_particles(scene.cloths[c], pin)) held[c].insert(p);
    for (const int p : particles[c]) pinned += held[c].count(p);
    all += particles[c].size();
  }
  const bool release = all > 0 && pinned == all;
  for (std::size_t c = 0; c < particles.size() && c < scene.cloths.size(); ++c) {
    const std::string place = "/cloths/" + std::to_string(c) + "/pins";
    const Cloth& cloth = scene.cloths[c];
    const std::set<int> chosen(particles[c].begin(), particles[c].end());
    text::Json pins = text::Json::array();
    const text::Json& before = workspace.document().json()[text::Json::json_pointer(place)];
    for (std::size_t k = 0; k < before.size(); ++k) {
      const std::vector<int> held_here = held_particles(cloth, cloth.pins[k]);
      const text::Json left =
          release ? remaining_pin_json(before[k], held_here, chosen) : before[k];
      if (!left.is_null()) pins.push_back(left);
    }
    for (const int p : chosen)
      if (!release && !held[c].contains(p)) pins.push_back(pin_json(cloth, p));
    if (!chosen.empty()) changes.push_back({place, pins});
  }
  if (!changes.empty()) workspace.edit(changes, false, release ? "unpin" : "pin");
}

namespace {

// What a ball is to meet: a point, and how fast it moves [m/s].
struct Mark {
  Vec3f point, velocity;
};
std::optional<Mark> mark_under(const FrameData& frame_data, const Ray& ray) {
  const auto cloth = pick_cloth(frame_data, ray);
  const auto body = pick_body(frame_data, ray);
  if (cloth && (!body || cloth->distance <= body->distance)) {
    const ClothCopy& copy = frame_data.cloths[static_cast<std::size_t>(cloth->cloth)];
    const std::size_t p = copy.at(cloth->particle);
    return Mark{cloth->point, {copy.vx[p], copy.vy[p], copy.vz[p]}};
  }
  if (body) return Mark{body->point, {}};
  return std::nullopt;
}

}  // namespace

// A ball on a path of free flight from the eye, p + v t + g t²/2, until it lies on the floor: such that it
// meets what is clicked where that will be then.
void Hands::shoot(Workspace& workspace, const Ray& ray) const {
  constexpr double kSeconds = 2.5, kEvery = 1.0 / 30;
  const Setting& setting = workspace.setting();
  const double radius = 0.06 * setting.size, start = workspace.frame_data().time;
  const Vec3 g = workspace.document().scene().gravity;
  const Vec3f eye = ray.origin + ray.direction * (0.3f * workspace.camera.distance());
  const Vec3 from = workspace.in_scene(eye);
  const float speed = 2.2f * setting.size;
  Vec3 velocity = to_double(ray.direction * speed);
  if (const auto mark = mark_under(workspace.frame_data(), ray)) {
    const float flight = std::max(length(mark->point - eye) / speed, 0.05f);
    const Vec3f way = mark->point + mark->velocity * flight - eye;
    velocity = to_double((way - to_float(g) * (0.5f * flight * flight)) * (1 / flight));
  }
  const double lowest = workspace.frame_data().origin[1] + setting.ground + radius;
  text::Json keys = text::Json::array();
  for (double t = 0; t <= kSeconds; t += kEvery) {
    Vec3 p{};
    for (std::size_t k = 0; k < 3; ++k)
      p[k] = std::clamp(from[k] + velocity[k] * t + 0.5 * g[k] * t * t, -9999.0, 9999.0);
    const bool landed = setting.solid && p[1] < lowest;
    if (landed) p[1] = lowest;
    keys.push_back({start + t, p[0], p[1], p[2]});
    if (landed) break;
  }
  const text::Json ball{{"sphere", {{"center", from}, {"radius", radius}}},
                        {"friction", 0.3},
                        {"offset", 0.02 * radius},
                        {"keys", keys}};
  workspace.edit({{"/colliders/-", ball}}, false, "ball");
}

void Hands::draw(const Workspace& workspace, const Area& area, ImDrawList& list) const {
  const Projector project(workspace.camera, area);
  constexpr float kApart = 9;  // pixels between marks: many are a dotted line, not a bar
  ScreenPoint last{-1e6f, -1e6f, 0, false};
  std::size_t marks = 0;
  for (const ClothCopy& cloth : workspace.frame_data().cloths)
    for (int j = 0; j < cloth.rows; ++j)
      for (int i = 0; i < cloth.columns && marks < kMostMarks; ++i) {
        if (cloth.inverse_mass[cloth.at(i, j)] != 0) continue;
        const ScreenPoint p = project(cloth.position(j * cloth.columns + i));
        if (!p.seen || std::hypot(p.x - last.x, p.y - last.y) < kApart) continue;
        last = p;
        ++marks;
        list.AddCircleFilled({p.x, p.y}, 4, IM_COL32(20, 22, 28, 200));
        list.AddCircleFilled({p.x, p.y}, 2.6f, IM_COL32(255, 209, 102, 255));
      }
  if (drag_ == Drag::cloth || waiting_) {
    const ClothCopy& cloth = workspace.frame_data().cloths[static_cast<std::size_t>(held_.cloth)];
    const ScreenPoint a = project(cloth.position(held_.particle)), b = project(target_);
    if (a.seen && b.seen) list.AddLine({a.x, a.y}, {b.x, b.y}, IM_COL32(255, 255, 255, 160), 1.5f);
    if (a.seen) list.AddCircle({a.x, a.y}, 7, IM_COL32(255, 255, 255, 220), 0, 2);
    if (b.seen) list.AddCircleFilled({b.x, b.y}, 5, IM_COL32(255, 255, 255, 220));
    if (b.seen) mark("hand", {b.x, b.y});
  }
  draw_path(list, stroke_.points(), IM_COL32(255, 107, 107, 230), false);
  draw_path(list, lasso_, IM_COL32(255, 209, 102, 230), true);
  if (tool == Tool::move) pusher.draw(workspace, area, list);
}

}  // namespace weft::viewer
