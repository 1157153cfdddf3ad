// The side with its tabs, and where everything goes.
#include "panel/panel.h"

#include <algorithm>

#include "panel/theme.h"

namespace weft::viewer {

namespace {

float side_width() {
  return ImGui::GetFontSize() * 24;
}

}  // namespace

// In a small window the picture has it all.
bool Panel::has_side() const {
  return visible && ImGui::GetIO().DisplaySize.x >= 1.9f * side_width();
}

Area Panel::picture_area() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float left = has_side() ? side_width() : 0;
  return {left, 0, std::max(size.x - left, 16.0f), std::max(size.y, 16.0f)};
}

float Panel::clear_share() const {
  const float bar = 5 * ImGui::GetFontSize();
  return visible ? std::clamp(1 - 2 * bar / picture_area().height, 0.3f, 1.0f) : 1;
}

bool begin_overlay(const char* name, float x, float y, float pivot_x, float pivot_y) {
  ImGui::SetNextWindowPos({x, y}, ImGuiCond_Always, {pivot_x, pivot_y});
  ImGui::SetNextWindowBgAlpha(0.86f);
  return ImGui::Begin(name, nullptr,
                      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                          ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                          ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav);
}

void Panel::draw_side(Workspace& workspace, Requests& requests) {
  const Area area = picture_area();
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize({area.x, area.height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
  ImGui::Begin("side", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoNav);
  draw_scenes(workspace, requests, path_);
  draw_files(workspace, requests, forms_, filming);
  ImGui::Dummy({0, 2});
  if (ImGui::BeginTabBar("tabs")) {
    const auto tab = [&](const char* name, auto&& content) {
      const bool open = ImGui::BeginTabItem(name);
      mark(name);
      if (!open) return;
      ImGui::BeginChild(name, {0, 0}, false,
                        ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysVerticalScrollbar);
      content();
      ImGui::EndChild();
      ImGui::EndTabItem();
    };
    tab("Scene", [&] {
      parameters_.draw_search();
      const bool all = !parameters_.searching();
      if (all) draw_fabrics(workspace);
      if (all) draw_parts(workspace, requests);
      if (all) draw_spring_cloth(workspace);
      draw_course_cloth(workspace, parameters_);
      parameters_.draw(workspace);
      if (all) draw_machine(workspace);
    });
    tab("Look", [&] { draw_looks(workspace); });
    tab("Measures", [&] { draw_measures(workspace, history); });
    ImGui::EndTabBar();
  }
  ImGui::End();
  ImGui::PopStyleVar();
}

void Panel::draw(Workspace& workspace, Hands& hands, Requests& requests) {
  if (has_side()) draw_side(workspace, requests);
  if (requests.mesh) mesh_form.ask("");
  mesh_form.draw(workspace, requests);
  if (requests.newest) hands.choose_newest(workspace, *requests.newest);
  const Area area = picture_area();
  if (visible) {
    draw_tools(hands, area, keys_);
    draw_transport(workspace, area, keys_);
    if (area.width > 40 * ImGui::GetFontSize()) draw_corner(workspace, history, area);
  }
  draw_legend(workspace, area);
  if (opened_ < 0) opened_ = workspace.now();
  if (hands.busy()) played_ = true;
  if (!played_) draw_hints(area, workspace.now() - opened_);
  draw_messages(workspace.messages, area);
  if (requests.gallery) gallery.open = true;
  gallery.draw(workspace);
  if (help) draw_help(help, keys_);
}

}  // namespace weft::viewer
