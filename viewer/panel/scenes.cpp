// The list of scenes, and what is done with files.
#include <imgui.h>
#include <imgui_stdlib.h>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

void draw_scenes(Workspace& workspace, std::string& path) {
  const Document& document = workspace.document();
  ImGui::SetNextItemWidth(-1);
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
  ImGui::PushTextWrapPos(0);
  ImGui::TextColored(kQuiet, "%s", document.scene().about.c_str());
  ImGui::PopTextWrapPos();
}

}  // namespace weft::viewer
