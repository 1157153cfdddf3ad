// The parameters of what moves: paths, turns, and what follows a body.
#include <imgui.h>

#include <algorithm>

#include "panel/panel.h"
#include "panel/parameters.h"
#include "panel/theme.h"
#include "scene/schema.h"
#include "weft/shape.h"

namespace weft::viewer {

namespace {

constexpr const char* kPlaces = "Time [s], and x, y, z then";
constexpr const char* kAngles = "Time [s], and the angle then [degrees]";

}  // namespace

void Parameters::collider_path(const std::string& pointer, const Json& value) {
  const auto& bodies = workspace_->frame_data().bodies;
  const std::size_t number = std::stoul(pointer.substr(std::string("/colliders/").size()));
  if (number >= bodies.size()) return;  // not simulated yet
  Json keys = value;
  const FrameData& now = workspace_->frame_data();
  const Vec3 place = place_of(moved(bodies[number].shape, now.origin));
  if (pointer.ends_with("/rotate/keys")) {
    if (!draw_path("turn", pointer, keys, now.time, {0}, kAngles)) return;
    // One that begins to turn does so about itself.
    const Collider& body = workspace_->document().scene().colliders[number];
    if (value.empty() && body.rotate.about == Vec3{})
      change(pointer.substr(0, pointer.rfind('/')) + "/about", Json(place_of(body.shape)));
    return change(pointer, keys);
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

// Its path, its turn and what it follows; true when one has changed.
bool Parameters::pin_values(const std::string& place, Json& pin, const Vec3& at) {
  const double now = workspace_->frame_data().time;
  const auto keys_of = [](const Json& of) {
    const Json* known = text::member(of, "keys");
    return known ? *known : Json::array();
  };
  bool changed = false;
  if (Json keys = keys_of(pin);
      draw_path("path", place + "/keys", keys, now, {at.begin(), at.end()}, kPlaces)) {
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

}  // namespace weft::viewer
