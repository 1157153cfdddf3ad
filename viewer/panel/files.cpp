// Undo, redo, save, pictures, films, animations.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "film/film.h"
#include "panel/panel.h"
#include "panel/theme.h"
#include "weft/output.h"

namespace weft::viewer {

namespace {

bool button(const char* label, bool enabled, const std::string& about) {
  ImGui::BeginDisabled(!enabled);
  const bool pressed = ImGui::Button(label);
  ImGui::EndDisabled();
  mark(label);
  tooltip(about.c_str());
  return pressed;
}

// Red while it goes on.
bool lasting(const char* label, bool on, const char* begin, const char* end) {
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, kRunning);
  const bool pressed = button(label, true, on ? end : begin);
  if (on) ImGui::PopStyleColor();
  return pressed;
}

// Typed after a click, as everywhere in the panel.
void whole_number(const char* name, int& value, int low, int high) {
  ImGui::SetNextItemWidth(5 * ImGui::GetFontSize());
  ImGui::DragInt((std::string("##") + name).c_str(), &value, 1, low, high, "%d",
                 ImGuiSliderFlags_AlwaysClamp);
  mark(name);
}

void draw_size(int& width, int& height) {
  whole_number("picture width", width, 16, 8192);
  ImGui::SameLine();
  ImGui::TextUnformatted("×");
  ImGui::SameLine();
  whole_number("picture height", height, 16, 8192);
  ImGui::SameLine();
  ImGui::TextUnformatted("pixels");
}

void draw_picture_form(Requests& requests, PictureRequest& form) {
  if (!ImGui::BeginPopup("picture")) return;
  draw_size(form.width, form.height);
  ImGui::SliderInt("samples of a pixel", &form.samples, 1, 16, "%d", ImGuiSliderFlags_AlwaysClamp);
  mark("picture samples");
  if (button("Save picture", true, "PNG, in the current folder")) {
    requests.picture = form;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

// The frames of an export or a film, whose name is in the names of the controls; the scene's own length is
// offered.
void draw_range(const Scene& scene, const std::string& of, FrameRange& range) {
  ImGui::Checkbox("from now on, until it is ended", &range.endless);
  mark(of + " endless");
  if (range.endless) return;
  constexpr int kMost = 1'000'000;
  const double length = std::round(scene.time.seconds / scene.time.frame);
  if (range.last == 0) range.last = static_cast<int>(std::min(length, 1.0 * kMost));
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted("frames");
  ImGui::SameLine();
  whole_number("first frame", range.first, 0, kMost);
  ImGui::SameLine();
  ImGui::TextUnformatted("to");
  ImGui::SameLine();
  whole_number("last frame", range.last, 0, kMost);
  range.last = std::max(range.last, range.first);
  ImGui::TextColored(kQuiet, "A scene that is past the first frame starts anew.");
}

void draw_film_form(const Scene& scene, Requests& requests, FileForms& forms) {
  if (!ImGui::BeginPopup("film")) return;
  ImGui::Checkbox("as large as the view", &forms.film_as_view);
  mark("film as view");
  if (!forms.film_as_view) draw_size(forms.film.width, forms.film.height);
  draw_range(scene, "film", forms.film.range);
  if (button("Start film", true, "MP4 where ffmpeg is installed, else numbered PNG files")) {
    requests.film = forms.film;
    if (forms.film_as_view) requests.film->width = requests.film->height = 0;
    ImGui::CloseCurrentPopup();
  }
  ImGui::EndPopup();
}

// Whether the cloth's triangles change, or will.
bool comes_apart(const Workspace& workspace) {
  const auto& cloths = workspace.document().scene().cloths;
  const auto& shown = workspace.frame_data().cloths;
  return std::any_of(cloths.begin(), cloths.end(),
                     [](const Cloth& c) { return !c.cuts.empty(); }) ||
         std::any_of(shown.begin(), shown.end(),
                     [](const ClothCopy& c) { return c.topology_version > (c.mesh ? 1 : 0); });
}

void draw_export_form(Workspace& workspace, FileForms& forms) {
  if (!ImGui::BeginPopup("export")) return;
  const std::vector<std::string> formats = animation_extensions();
  for (std::size_t k = 0; k < formats.size(); ++k) {
    if (k > 0) ImGui::SameLine();
    if (ImGui::RadioButton(formats[k].c_str(), &forms.format, static_cast<int>(k)))
      forms.path = forms.named
                       ? std::filesystem::path(forms.path).replace_extension(formats[k]).string()
                       : free_name(workspace.document().name(), formats[k], workspace.record());
    mark("export " + formats[k]);
  }
  if (ImGui::InputText("file", &forms.path)) forms.named = true;
  mark("export to " + forms.path);
  std::error_code error;
  if (std::filesystem::exists(forms.path, error))
    ImGui::TextColored(kAccent, "What is there now is replaced.");
  draw_range(workspace.document().scene(), "export", forms.frames);
  const std::string format = formats[static_cast<std::size_t>(forms.format)];
  const bool apart = comes_apart(workspace),
             morphs = format == ".gltf" || format == ".glb" || format == ".usda";
  if (apart && format != ".obj")
    ImGui::TextColored(kBad,
                       morphs ? "The cloth is cut, which %s cannot follow: .obj can"
                              : "%s has points alone: which triangles a cut took, .obj tells",
                       format.c_str());
  const bool known = std::filesystem::path(forms.path).extension() == format;
  const bool able = known && !(apart && morphs);
  const char* why = known ? "" : "The file's name ends as the format is called";
  const bool all = button("Start export", able, why);
  ImGui::SameLine();
  const bool still = button("This frame alone", able, *why != 0 ? why : "The cloth as it is seen");
  if (still) workspace.export_frame(forms.path);
  if (all && forms.frames.endless) workspace.start_export(forms.path, {}, {});
  if (all && !forms.frames.endless)
    workspace.start_export(forms.path, forms.frames.first, forms.frames.last);
  if (all || still) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void draw_export(Workspace& workspace, FileForms& forms) {
  if (lasting("Export", workspace.telemetry().exporting,
              "The animation in a format for other programs, all of it or some frames",
              "Ends the export")) {
    if (workspace.telemetry().exporting) {
      workspace.end_export();
    } else {
      const std::string format = animation_extensions()[static_cast<std::size_t>(forms.format)];
      forms.path = free_name(workspace.document().name(), format, workspace.record());
      forms.named = false;
      ImGui::OpenPopup("export");
    }
  }
  draw_export_form(workspace, forms);
}

}  // namespace

void draw_files(Workspace& workspace, Requests& requests, FileForms& forms, bool filming) {
  const Document& document = workspace.document();
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {5, ImGui::GetStyle().FramePadding.y});
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {4, ImGui::GetStyle().ItemSpacing.y});
  if (button("Undo", document.can_undo(), document.next_undo())) workspace.undo();
  ImGui::SameLine();
  if (button("Redo", document.can_redo(), "Redo the change")) workspace.redo();
  ImGui::SameLine();
  if (button("Save", document.edited() || document.shipped(), "Saves to " + document.save_path()))
    workspace.save(document.save_path());
  ImGui::SameLine(0, 3 * ImGui::GetStyle().ItemSpacing.x);
  if (button("Picture", true, "A picture of the view as PNG, of any size; F12: as it is seen"))
    ImGui::OpenPopup("picture");
  ImGui::SameLine();
  if (lasting("Film", filming,
              "A film of the view, of any size, all of it or some frames; F11: as it is seen",
              "Ends the film")) {
    if (filming)
      requests.film = FilmRequest{};
    else
      ImGui::OpenPopup("film");
  }
  draw_film_form(document.scene(), requests, forms);
  ImGui::SameLine();
  draw_export(workspace, forms);
  draw_picture_form(requests, forms.picture);
  ImGui::PopStyleVar(2);
}

}  // namespace weft::viewer
