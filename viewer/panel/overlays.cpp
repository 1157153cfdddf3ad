// Small windows over the picture: tools, play and time, the corner's figures, legend, messages, keys.
#include <algorithm>
#include <cstdio>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

namespace {

constexpr float kMargin = 12;

// A button that shows whether it is on.
bool choice(const char* label, bool on) {
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(kAccent.x, kAccent.y, kAccent.z, 0.8f));
  const bool pressed = ImGui::Button(label);
  if (on) ImGui::PopStyleColor();
  return pressed;
}

std::string with_keys(const char* about, const Keys& keys, Action action) {
  return std::string(about) + "  (" + keys.names_of(action) + ")";
}

}  // namespace

void draw_tools(Hands& hands, const Area& area, const Keys& keys) {
  struct Entry {
    const char* label;
    Tool tool;
    Action action;
    const char* about;
  };
  static constexpr Entry kEntries[] = {
      {"Drag", Tool::hand, Action::hand, "Pull the cloth or a body with the left button"},
      {"Pin", Tool::pin, Action::pin,
       "Click on the cloth: holds a point, or lets it go; drag: a lasso around several"},
      {"Cut", Tool::cut, Action::cut, "Draw a stroke: severs all cloth that it passes over"},
      {"Move", Tool::move, Action::move,
       "Choose a cloth or a body: arrows move it, rings turn it, the square sizes it; arrow keys "
       "move a "
       "body and carry what is held of the cloth"},
      {"Ball", Tool::ball, Action::ball, "Click to shoot a ball into the scene"},
  };
  begin_overlay("tools", area.x + kMargin, area.y + kMargin, 0, 0);
  for (const Entry& entry : kEntries) {
    if (entry.tool != Tool::hand) ImGui::SameLine();
    if (choice(entry.label, hands.tool == entry.tool)) hands.tool = entry.tool;
    mark(entry.label);
    tooltip(with_keys(entry.about, keys, entry.action).c_str());
  }
  ImGui::End();
}

namespace {

void draw_past(Workspace& workspace, float width) {
  const Telemetry& v = workspace.telemetry();
  const int last = v.kept - 1;
  int at = last - v.back;
  ImGui::SetNextItemWidth(width);
  ImGui::BeginDisabled(last < 1);
  char text[32];
  std::snprintf(text, sizeof text, "%.2f s", workspace.frame_data().time);
  if (ImGui::SliderInt("##past", &at, 0, std::max(last, 1), text, ImGuiSliderFlags_NoInput))
    workspace.go_back(last - at);
  ImGui::EndDisabled();
  mark("past");
  char about[128];
  std::snprintf(about, sizeof about,
                "The last %.1f s are kept: drag to go back; going on forgets "
                "what came after",
                v.kept_s);
  tooltip(about);
}

}  // namespace

void draw_transport(Workspace& workspace, const Area& area, const Keys& keys) {
  const Telemetry& v = workspace.telemetry();
  begin_overlay("transport", area.x + area.width / 2, area.y + area.height - kMargin, 0.5f, 1);
  if (ImGui::Button("Reset")) workspace.reset();
  mark("Reset");
  tooltip(with_keys("Start the scene anew", keys, Action::reset).c_str());
  ImGui::SameLine();
  const float width = ImGui::CalcTextSize("Pause").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(kAccent.x, kAccent.y, kAccent.z, 0.8f));
  if (ImGui::Button(v.paused ? "Play" : "Pause", {width, 0})) workspace.play(v.paused);
  ImGui::PopStyleColor();
  tooltip(with_keys("Pause or go on", keys, Action::pause).c_str());
  ImGui::SameLine();
  if (ImGui::Button("Step")) workspace.step();
  tooltip(with_keys("One frame", keys, Action::step).c_str());
  ImGui::SameLine();
  const float em = ImGui::GetFontSize();
  draw_past(workspace, std::clamp(area.width - 22 * em, 4 * em, 10 * em));
  ImGui::SameLine();
  static constexpr double kSpeeds[] = {0.0625, 0.125, 0.25, 0.5, 1, 2, 4};
  char text[16];
  std::snprintf(text, sizeof text, "%g ×", v.speed);
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 5);
  if (ImGui::BeginCombo("##speed", text)) {
    for (const double speed : kSpeeds) {
      std::snprintf(text, sizeof text, "%g ×", speed);
      if (ImGui::Selectable(text, speed == v.speed)) workspace.set_speed(speed);
    }
    ImGui::EndCombo();
  }
  tooltip("Speed of time");
  ImGui::End();
}

void draw_corner(const Workspace& workspace, const History& history, const Area& area) {
  const Telemetry& v = workspace.telemetry();
  begin_overlay("corner", area.x + area.width - kMargin, area.y + kMargin, 1, 0);
  ImGui::Text("%.0f/s", history.turns_per_second);
  ImGui::SameLine();
  ImGui::TextColored(kQuiet, "|");
  ImGui::SameLine();
  ImGui::Text("frame simulated in %.2f ms", v.frame_ms);
  const bool late = !v.paused && v.frames > 0 && v.pace < 0.93 * v.speed;
  if (v.paused)
    ImGui::TextColored(kAccent, v.back > 0 ? "in the past" : "paused");
  else if (late)
    ImGui::TextColored(kBad, "slower than asked for: %.2g × real time", v.pace);
  else
    ImGui::TextColored(kGood, "real time × %.2g", v.speed);
  if (v.recording) ImGui::TextColored(kBad, "recording");
  ImGui::End();
}

namespace {

// Which colour is which direction of the springs' force, and what the whole scale is worth.
void draw_force_legend(const Workspace& workspace) {
  ImGui::TextUnformatted("Force of the springs");
  const std::pair<const char*, ImVec4> axes[] = {
      {"x", {1, 0.35f, 0.3f, 1}}, {"y", {0.4f, 0.9f, 0.4f, 1}}, {"z", {0.45f, 0.6f, 1, 1}}};
  for (const auto& [name, color] : axes) {
    ImGui::TextColored(color, "%s", name);
    ImGui::SameLine();
  }
  const Cloth& cloth = workspace.document().scene().cloths.front();
  const double weight =
      particle_mass(cloth, 0, 0) * length(to_float(workspace.document().scene().gravity));
  const auto scale = static_cast<double>(workspace.settings.force_scale);
  if (workspace.look->name == "phong_force")
    ImGui::TextColored(kQuiet, "direction alone");
  else
    ImGui::TextColored(kQuiet, "full at %.3g N: %.3g weights of a particle", 4 * weight / scale,
                       4 / scale);
}

}  // namespace

void draw_legend(const Workspace& workspace, const Area& area) {
  const bool strains = workspace.look->strains, forces = workspace.look->forces;
  const bool lines = workspace.look->draw == Look::Draw::lines;
  if (!strains && !lines && !forces) return;
  const float em = ImGui::GetFontSize();
  // The transport, where there is no room beside.
  const float above = area.width < 56 * em ? 4 * em : 0;
  begin_overlay("legend", area.x + area.width - kMargin, area.y + area.height - kMargin - above, 1,
                1);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float size = ImGui::GetFontSize();
  if (forces) {
    draw_force_legend(workspace);
  } else if (lines) {
    const LookSettings& s = workspace.settings;
    const std::tuple<const char*, bool, ImU32> kinds[] = {
        {"structural", s.structural, IM_COL32(38, 63, 137, 255)},
        {"shear", s.shear, IM_COL32(225, 124, 38, 255)},
        {"bend", s.bend, IM_COL32(38, 178, 97, 255)}};
    for (const auto& [name, shown, color] : kinds) {
      if (!shown) continue;
      const ImVec2 at = ImGui::GetCursorScreenPos();
      list.AddLine({at.x, at.y + size / 2}, {at.x + 1.6f * size, at.y + size / 2}, color, 3);
      ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 2.2f * size);
      ImGui::TextUnformatted(name);
    }
  } else {
    ImGui::TextUnformatted("Strain");
    const ImVec2 at = ImGui::GetCursorScreenPos();
    // As heat() of common.glsl, in the screen's colours.
    static constexpr ImU32 kHeat[] = {IM_COL32(39, 70, 173, 255), IM_COL32(39, 178, 194, 255),
                                      IM_COL32(149, 224, 89, 255), IM_COL32(249, 210, 39, 255),
                                      IM_COL32(225, 48, 39, 255)};
    const float width = 11 * size, step = width / 4;
    for (int k = 0; k < 4; ++k)
      list.AddRectFilledMultiColor({at.x + step * static_cast<float>(k), at.y},
                                   {at.x + step * static_cast<float>(k + 1), at.y + size}, kHeat[k],
                                   kHeat[k + 1], kHeat[k + 1], kHeat[k]);
    ImGui::Dummy({width, size});
    const double range = 100 * static_cast<double>(workspace.settings.strain_range);
    ImGui::Text("0");
    ImGui::SameLine(width / 2);
    ImGui::Text("%.3g %%", range / 2);
    ImGui::SameLine(width - 2 * size);
    ImGui::Text("%.3g %%", range);
  }
  ImGui::End();
}

// What to try first, fading after some seconds or once a hand has pulled.
void draw_hints(const Area& area, double seconds) {
  constexpr double kWhole = 9, kFade = 3;  // s
  const auto alpha = static_cast<float>(std::clamp((kWhole + kFade - seconds) / kFade, 0.0, 1.0));
  if (alpha <= 0 || area.width < 30 * ImGui::GetFontSize()) return;
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, alpha);
  begin_overlay("hints", area.x + area.width / 2,
                area.y + area.height - 5.5f * ImGui::GetFontSize(), 0.5f, 1);
  ImGui::TextUnformatted("Pull the cloth: left drag on it");
  ImGui::TextUnformatted("Look around: left drag beside it, and the wheel");
  ImGui::TextUnformatted("Cut, pin, throw a ball: 3, 2, 5    all keys: H");
  mark("hints");
  ImGui::End();
  ImGui::PopStyleVar();
}

void draw_messages(Messages& messages, const Area& area) {
  if (messages.news().empty() && messages.faults().empty()) return;
  begin_overlay("messages", area.x + kMargin, area.y + area.height - 5 * kMargin, 0, 1);
  const float room = area.width - 2 * kMargin - 2 * ImGui::GetStyle().WindowPadding.x;
  ImGui::PushTextWrapPos(std::min(room, std::max(area.width * 0.6f, 32 * ImGui::GetFontSize())));
  for (const auto& [topic, text] : messages.faults()) ImGui::TextColored(kBad, "%s", text.c_str());
  for (const Messages::News& news : messages.news()) {
    if (news.bad)
      ImGui::TextColored(kBad, "%s", news.text.c_str());
    else
      ImGui::TextUnformatted(news.text.c_str());
  }
  mark("message");
  ImGui::PopTextWrapPos();
  const bool pointed = ImGui::IsWindowHovered();
  ImGui::End();
  if (pointed && ImGui::IsMouseClicked(0)) messages.dismiss();
}

void draw_help(bool& open, const Keys& keys) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  if (ImGui::Begin("Keys and mouse", &open,
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                       ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav)) {
    static constexpr const char* kMouse[][2] = {
        {"Left drag", "the tool; beside the cloth: orbit"},
        {"Middle or Alt+left drag", "orbit"},
        {"Right or Ctrl+left drag", "pan"},
        {"Wheel", "nearer, farther"},
        {"Shift+click", "pin or unpin"},
        {"Drop a file",
         "a scene, a picture as texture, a mesh (.obj, .ply, .glb, .gltf) as cloth or body"},
        {"Click on a message", "dismisses it"},
    };
    if (ImGui::BeginTable("mouse", 2)) {
      for (const auto& line : kMouse) {
        ImGui::TableNextColumn();
        ImGui::TextColored(kAccent, "%s", line[0]);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(line[1]);
      }
      ImGui::EndTable();
    }
    ImGui::Separator();
    if (ImGui::BeginTable("keys", size.x < 50 * ImGui::GetFontSize() ? 2 : 4)) {
      for (std::size_t a = 0; a < kActions; ++a) {
        ImGui::TableNextColumn();
        ImGui::TextColored(kAccent, "%s", keys.names_of(static_cast<Action>(a)).c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%s   ", kActionTexts[a].about.data());
      }
      ImGui::EndTable();
    }
    ImGui::TextColored(kQuiet, "Other keys: a file of lines such as  pause = P, Space  at %s",
                       keys_file().c_str());
  }
  ImGui::End();
}

}  // namespace weft::viewer
