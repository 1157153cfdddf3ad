// The list of scenes, and what is done with files.
#include <imgui.h>
#include <imgui_stdlib.h>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

void draw_scenes(Workspace& workspace, Requests& requests, std::string& path) {
  const Document& document = workspace.document();
  const float gallery = ImGui::CalcTextSize("Scenes").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SetNextItemWidth(-gallery - ImGui::GetStyle().ItemSpacing.x);
  const std::string title = document.name() + (document.edited() ? " *" : "");
  if (ImGui::BeginCombo("##scenes", title.c_str(), ImGuiComboFlags_HeightLargest)) {
    ImGui::SetNextItemWidth(-1);
    if (ImGui::InputTextWithHint("##path", "a file, then Enter (or drop it on the window)", &path,
                                 ImGuiInputTextFlags_EnterReturnsTrue) &&
        !path.empty()) {
      workspace.open(path);
      path.clear();
      ImGui::CloseCurrentPopup();
    }
    for (const ShippedScene& scene : workspace.scenes()) {
      if (ImGui::Selectable(scene.name.c_str(), scene.path == document.path()))
        workspace.open(scene.path);
      ImGui::SameLine(ImGui::GetFontSize() * 11);
      ImGui::TextColored(kQuiet, "%s", scene.about.c_str());
    }
    ImGui::EndCombo();
  }
  tooltip(document.path().c_str());
  ImGui::SameLine();
  if (ImGui::Button("Scenes")) requests.gallery = true;
  mark("Scenes");
  tooltip("All shipped scenes as pictures");
  ImGui::PushTextWrapPos(0);
  ImGui::TextColored(kQuiet, "%s", document.scene().about.c_str());
  ImGui::PopTextWrapPos();
}

}  // namespace weft::viewer
