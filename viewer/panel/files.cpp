// Undo, redo, save, pictures, films, recordings.

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

void draw_files(Workspace& workspace, Requests& requests, bool filming) {
  const Document& document = workspace.document();
  const auto button = [](const char* label, bool enabled, const std::string& about) {
    ImGui::BeginDisabled(!enabled);
    const bool pressed = ImGui::Button(label);
    ImGui::EndDisabled();
    mark(label);
    tooltip(about.c_str());
    return pressed;
  };
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {5, ImGui::GetStyle().FramePadding.y});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4, ImGui::GetStyle().ItemSpacing.y});
  if (button("Undo", document.can_undo(), document.next_undo())) workspace.undo();
  ImGui::SameLine();
  if (button("Redo", document.can_redo(), "Redo the change")) workspace.redo();
  ImGui::SameLine();
  if (button("Save", document.edited() || document.shipped(), "Saves to " + document.save_path()))
    workspace.save(document.save_path());
  ImGui::SameLine(0, 3 * ImGui::GetStyle().ItemSpacing.x);
  if (button("Picture", true, "Saves a picture of the view as PNG")) requests.screenshot = true;
  ImGui::SameLine();
  // Red while it goes on.
  const auto lasting = [&](const char* label, bool on, const char* begin, const char* end) {
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, kRunning);
    const bool pressed = button(label, true, on ? end : begin);
    if (on) ImGui::PopStyleColor();
    return pressed;
  };
  if (lasting("Film", filming,
              "Films the view to MP4 where ffmpeg is installed, else to numbered PNG files",
              "Ends the film"))
    requests.film = true;
  ImGui::SameLine();
  if (lasting("Export", workspace.telemetry().exporting,
              "Exports the animation from here on as a PC2 point cache, as weft run --export does",
              "Ends the export"))
    workspace.start_or_end_export();
  ImGui::PopStyleVar(2);
}

}  // namespace weft::viewer
