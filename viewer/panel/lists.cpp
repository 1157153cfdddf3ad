// Lists of the scene: paths, pins, cuts, and, as a line of text, those that have no controls of their own.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "panel/panel.h"
#include "panel/parameters.h"
#include "panel/theme.h"

namespace weft::viewer {

using text::Json;

namespace {

constexpr std::size_t kMostPins = 100;
constexpr const char* kPlaces = "Time [s], and x, y, z then";
constexpr const char* kAngles = "Time [s], and the angle then [degrees]";
constexpr const char* kOffsets = "Time [s], and how far each is from its start: x, y, z";

std::size_t number_in(const std::string& pointer, const std::string& before) {
  return std::stoul(pointer.substr(before.size()));
}

Json keys_of(const Json& of) {
  const Json* known = text::member(of, "keys");
  return known ? *known : Json::array();
}

std::string name_of_pin(const Json& pin) {
  if (const Json* group = text::member(pin, "group")) return "group " + group->get<std::string>();
  if (pin.contains("box")) return "box";
  if (const Json* vertices = text::member(pin, "vertices"))
    return "pin of " + std::to_string(vertices->size());
  const Json& at = pin.at("at");
  return "pin " + (at.is_number() ? at.dump() : at[0].dump() + ", " + at[1].dump());
}

// The middle of the particles; nothing while the cloth that is shown is another.
std::optional<Vec3> middle(const std::vector<int>& particles, const ClothCopy& shown) {
  Vec3 sum{};
  for (const int p : particles) {
    if (p >= shown.columns * shown.rows) return {};
    sum = plus(sum, to_double(shown.position(p)));
  }
  const double share = 1 / static_cast<double>(std::max<std::size_t>(particles.size(), 1));
  return Vec3{sum[0] * share, sum[1] * share, sum[2] * share};
}

}  // namespace

// A branch that a search for a place opens.
bool Parameters::opened(const std::string& label, const std::string& pointer) const {
  if (filter_.starts_with('/')) ImGui::SetNextItemOpen(true);
  const bool open =
      ImGui::TreeNodeEx((label + "###" + pointer).c_str(), ImGuiTreeNodeFlags_NoTreePushOnOpen);
  mark(pointer);
  return open;
}

bool Parameters::list(const std::string& pointer, const std::string& key, const Json& value) {
  if (key == "pins") {
    pins(pointer, value);
  } else if (key == "cuts" && !value.empty()) {
    cuts(pointer, value);
  } else if (key == "keys") {
    if (pointer.starts_with("/colliders"))
      collider_path(pointer, value);
    else if (pointer.ends_with("/pressure/keys"))
      share_path(pointer, value);
    else
      vector_path(pointer, value);
  } else {
    return false;
  }
  return true;
}

// As in a file, on one line, taken with Enter.
void Parameters::as_text(const std::string& pointer, const std::string& label, const Json& value) {
  constexpr std::size_t kMost = 500;  // items: a longer line would cost more than all else here
  if (value.size() > kMost) {
    ImGui::Text("%s: %zu, in the file", label.c_str(), value.size());
    return;
  }
  std::string text = value.dump();
  if (!ImGui::InputText((label + "##" + pointer).c_str(), &text,
                        ImGuiInputTextFlags_EnterReturnsTrue))
    return;
  std::vector<Fault> faults;
  const Json entered = text::parse(text, faults);
  if (faults.empty())
    change(pointer, entered);
  else
    workspace_->messages.warn("Not changed: " + faults.front().what, workspace_->now());
}

void Parameters::collider_path(const std::string& pointer, const Json& value) {
  const FrameData& now = workspace_->frame_data();
  const std::size_t number = number_in(pointer, "/colliders/");
  if (number >= now.bodies.size()) return;  // not simulated yet
  Json keys = value;
  const Vec3 place = place_of(moved(now.bodies[number].shape, now.origin));
  if (pointer.ends_with("/rotate/keys")) {
    if (!draw_path("turn", pointer, keys, now.time, {0}, kAngles)) return;
    // One that begins to turn does so about itself.
    const Collider& body = workspace_->document().scene().colliders[number];
    const std::string about = pointer.substr(0, pointer.rfind('/')) + "/about";
    if (value.empty() && body.rotate.about == Vec3{})
      workspace_->edit({{about, Json(place_of(body.shape))}, {pointer, keys}});
    else
      change(pointer, keys);
    return;
  }
  if (draw_path("path", pointer, keys, now.time, {place.begin(), place.end()}, kPlaces))
    change(pointer, keys);
}

// A vector over time; without keys it is what it was at the last one.
void Parameters::vector_path(const std::string& pointer, const Json& value) {
  Json keys = value;
  if (!draw_path("over time", pointer, keys, workspace_->frame_data().time, {0, 0, 0}, kPlaces))
    return;
  const std::string vector = pointer.substr(0, pointer.rfind('/'));
  if (keys.empty())
    change(vector, Json{value[0][1], value[0][2], value[0][3]});
  else
    change(pointer, keys);
}

void Parameters::share_path(const std::string& pointer, const Json& value) {
  Json keys = value;
  if (draw_path("over time", pointer, keys, workspace_->frame_data().time, {1},
                "Time [s], and the share then"))
    change(pointer, keys);
}

// Which particles it holds; one alone is chosen with the tool. True when that has changed.
bool Parameters::pin_holds(const std::string& place, Json& pin) {
  const Json before = pin;
  if (Json* group = pin.contains("group") ? &pin["group"] : nullptr) {
    std::string name = group->get<std::string>();
    if (ImGui::InputText(("group##" + place).c_str(), &name, ImGuiInputTextFlags_EnterReturnsTrue))
      *group = name;
    mark(place + "/group");
  }
  for (std::size_t corner = 0; corner < 2 && pin.contains("box"); ++corner) {
    auto values = pin["box"][corner].get<Vec3>();
    const std::string name = corner == 0 ? "corner" : "opposite corner";
    if (ImGui::DragScalarN((name + "##" + place).c_str(), ImGuiDataType_Double, values.data(), 3,
                           0.01f, nullptr, nullptr, "%.4g"))
      pin["box"][corner] = values;
    mark(place + "/box/" + std::to_string(corner));
  }
  return pin != before;
}

// Its path, its turn and what it follows; true when one has changed.
bool Parameters::pin_moves(const std::string& place, Json& pin, const Vec3& at) {
  const double now = workspace_->frame_data().time;
  const bool one = pin.contains("at");
  bool changed = false;
  const std::vector<double> start =
      one ? std::vector(at.begin(), at.end()) : std::vector<double>(3);
  if (Json keys = keys_of(pin);
      draw_path("path", place + "/keys", keys, now, start, one ? kPlaces : kOffsets)) {
    pin["keys"] = keys;
    changed = true;
  }
  const Json turn = pin.value("rotate", Json{{"axis", {0, 1, 0}}, {"about", at}});
  if (Json keys = keys_of(turn); draw_path("turn", place + "/rotate", keys, now, {0}, kAngles)) {
    pin["rotate"] = turn;
    pin["rotate"]["keys"] = keys;
    changed = true;
  }
  if (pin.contains("rotate"))
    for (const char* which : {"axis", "about"}) {
      auto vector = turn.value(which, Vec3{});
      const std::string label = std::string(which) + "##" + place;
      if (ImGui::DragScalarN(label.c_str(), ImGuiDataType_Double, vector.data(), 3, 0.01f)) {
        pin["rotate"][which] = vector;
        changed = true;
      }
      mark(place + "/rotate/" + which);
    }
  int follow = pin.value("follow", -1);
  const int last = static_cast<int>(workspace_->document().scene().colliders.size()) - 1;
  if (last >= 0 &&
      ImGui::SliderInt(("follows##" + place).c_str(), &follow, -1, last,
                       follow < 0 ? "nothing" : "body %d", ImGuiSliderFlags_AlwaysClamp)) {
    pin["follow"] = follow;
    changed = true;
  }
  mark(place + "/follow");
  return changed;
}

// A pin that has its place on the cloth alone is that.
void Parameters::pin(const std::string& pointer, const Json& value, std::size_t number,
                     std::size_t p) {
  const std::string place = text::join(pointer, std::to_string(p));
  // Another control may have changed the document in this turn.
  const auto& cloths = workspace_->document().scene().cloths;
  if (number >= cloths.size() || p >= cloths[number].pins.size()) return;
  const std::vector<int> held = held_particles(cloths[number], cloths[number].pins[p]);
  const std::optional<Vec3> at = middle(held, workspace_->frame_data().cloths[number]);
  Json pin = value.is_object() ? value : Json{{"at", value}};
  if (!at || !opened(name_of_pin(pin), place)) return;
  const bool holds = pin_holds(place, pin);
  if (const Json* several = text::member(pin, "vertices")) {
    as_text(place + "/vertices", "particles", *several);
    mark(place + "/vertices");
  }
  if (!pin_moves(place, pin, workspace_->in_scene(to_float(*at))) && !holds) return;
  // What moves nothing is left out.
  if (pin.contains("keys") && pin["keys"].empty()) pin.erase("keys");
  if (pin.contains("rotate") && pin["rotate"]["keys"].empty()) pin.erase("rotate");
  if (pin.value("follow", 0) < 0) pin.erase("follow");
  change(place, pin.size() == 1 && pin.contains("at") ? pin["at"] : pin);
}

void Parameters::pins(const std::string& pointer, const Json& value) {
  const std::size_t number = number_in(pointer, "/cloths/");
  const bool open = opened("pins: " + std::to_string(value.size()), pointer);
  tooltip(
      "The tool Pin holds particles; as text: [i, j], a mesh's number, or {\"vertices\": [..]}, "
      "{\"group\": \"name\"}, {\"box\": [[x, y, z], [x, y, z]]}");
  const FrameData& now = workspace_->frame_data();
  if (!open || number >= now.cloths.size()) return;
  ImGui::Indent(6);
  for (std::size_t p = 0; p < std::min(value.size(), kMostPins); ++p)
    pin(pointer, value[p], number, p);
  if (value.size() > kMostPins) ImGui::TextColored(kQuiet, "… %zu more", value.size() - kMostPins);
  as_text(pointer, "as text", value);
  mark(pointer + " text");
  ImGui::Unindent(6);
}

// Which lines the cloth is cut along; each can be sewn up again.
void Parameters::cuts(const std::string& pointer, const Json& value) {
  if (!opened("cuts: " + std::to_string(value.size()), pointer)) return;
  std::size_t gone = value.size();
  for (std::size_t k = 0; k < std::min<std::size_t>(value.size(), kMostPins); ++k) {
    const Json &from = value[k].front(), &to = value[k].back();
    ImGui::Text("%.1f, %.1f  to  %.1f, %.1f: %zu points", from[0].get<double>(),
                from[1].get<double>(), to[0].get<double>(), to[1].get<double>(), value[k].size());
    ImGui::SameLine();
    ImGui::PushID(static_cast<int>(k));
    if (ImGui::SmallButton("×")) gone = k;
    mark(pointer + " remove " + std::to_string(k));
    ImGui::PopID();
  }
  if (gone == value.size()) return;
  Json left = value;
  left.erase(gone);
  change(pointer, left);
}

}  // namespace weft::viewer
