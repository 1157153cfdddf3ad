// The looks and their settings.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <string>

#include "panel/colors.h"
#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

namespace {

// Of one side of a cloth, as the scene has it. What is chosen in a row is one change.
void color(Workspace& workspace, const std::string& label, const std::string& pointer) {
  const auto chosen = pick_color(label, drawn_color(workspace.document().scene(), pointer));
  mark(label);
  if (chosen) workspace.edit({{pointer, *chosen}}, true);
}

bool slider(const char* label, float& value, float low, float high, const char* format = "%.3f",
            ImGuiSliderFlags flags = 0) {
  const bool changed =
      ImGui::SliderFloat(label, &value, low, high, format, flags | ImGuiSliderFlags_AlwaysClamp);
  mark(label);
  return changed;
}

void slider(const char* label, int& value, int low, int high, const char* format = "%d") {
  ImGui::SliderInt(label, &value, low, high, format, ImGuiSliderFlags_AlwaysClamp);
  mark(label);
}

// Switches side by side.
struct Switch {
  const char* label;
  bool& on;
};
void switches(std::initializer_list<Switch> all) {
  for (const Switch& one : all) {
    if (&one != all.begin()) ImGui::SameLine();
    ImGui::Checkbox(one.label, &one.on);
    mark(one.label);
  }
}

// The file in the place of one of the program's own pictures; true when it is entered.
bool picture_file(
    const char* label, std::string& path,
    const char* about = "A PNG or JPEG file, then Enter; nothing: the program's own") {
  std::string typed = path;
  const bool entered = ImGui::InputTextWithHint(label, "the program's own", &typed,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  mark(label);
  tooltip(about);
  if (entered) path = typed;
  return entered;
}

void sky_folder(std::string& path) {
  picture_file("sky", path, "A folder of posx, negx, … negz (.png or .jpg), then Enter");
}

void draw_maps(Workspace& workspace) {
  constexpr const char* kMaps[] = {"base colour map", "metallic map", "roughness map",
                                   "normal map"};  // in the order of MaterialMap
  LookSettings& s = workspace.settings;
  switches({{"maps", s.maps}});
  tooltip("Base colour, metallic, roughness and normals from maps");
  const bool files = ImGui::TreeNode("files");
  mark("files");
  if (files) {
    for (std::size_t map = 0; map < std::size(kMaps); ++map)
      if (picture_file(kMaps[map], workspace.pictures.material[map])) s.maps = true;
    sky_folder(workspace.pictures.sky);
    ImGui::TreePop();
  }
  slider("normal scale", s.normal_scale, 0, 10);
  slider("repeats", s.texture_repeats, 1, 20, "%.0f");
}

void draw_list(Workspace& workspace) {
  const float width = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
  int column = 0;
  for (const Look& look : kLooks) {
    if (column++ % 2 == 1) ImGui::SameLine();
    const bool on = workspace.look == &look;
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(kAccent.x, kAccent.y, kAccent.z, 0.8f));
    if (ImGui::Button(std::string(look.name).c_str(), {width, 0})) workspace.look = &look;
    if (on) ImGui::PopStyleColor();
    mark("look " + std::string(look.name));
    tooltip(std::string(look.about).c_str());
  }
}

// Of each cloth's two sides.
void draw_colors(Workspace& workspace) {
  constexpr std::size_t kMost = 12;  // cloths that the panel has room for
  const std::size_t cloths = workspace.document().scene().cloths.size();
  for (std::size_t c = 0; c < std::min(cloths, kMost); ++c) {
    const std::string which = c == 0 ? "" : " " + std::to_string(c + 1);
    const std::string place = "/cloths/" + std::to_string(c) + "/color";
    color(workspace, "front" + which, place + "/front");
    ImGui::SameLine();
    color(workspace, "back" + which, place + "/back");
  }
}

// One of the words, which are in the enum's order.
template <class Enum>
void choose(const char* label, Enum& value, std::initializer_list<const char*> words) {
  if (ImGui::BeginCombo(label, words.begin()[static_cast<int>(value)])) {
    for (int k = 0; const char* word : words) {
      if (ImGui::Selectable(word, k == static_cast<int>(value))) value = static_cast<Enum>(k);
      mark(std::string(label) + " " + word);
      ++k;
    }
    ImGui::EndCombo();
  }
  mark(label);
}

void draw_material(Workspace& workspace) {
  LookSettings& s = workspace.settings;
  const std::string_view look = workspace.look->name;
  const auto is = [&](std::string_view name) { return look == name; };
  if (is("pbr")) draw_maps(workspace);
  draw_colors(workspace);
  bool plain = false;
  if (is("fabric")) {
    choose("weave", s.weave, {"plain", "twill", "satin", "leather"});
    slider("threads [1/m]", s.threads, 50, 2000, "%.0f", ImGuiSliderFlags_Logarithmic);
    tooltip("Threads finer than the picture shows are flat");
    slider("sheen", s.sheen, 0, 1);
    slider("translucency", s.translucency, 0, 0.6f);
    slider("normal scale", s.normal_scale, 0, 10);
  }
  if (is("colour") || is("ggx_force") || is("pbr") || is("fabric"))
    plain = slider("roughness", s.roughness, 0.05f, 1);
  if (is("pbr")) {
    plain = slider("metallic", s.metallic, 0, 1) || plain;
    if (plain) s.maps = false;  // who moves a plain value wants to see it
  }
  if (is("blinn_phong") || is("phong_force")) {
    switches({{"ambient", s.ambient}, {"diffuse", s.diffuse}, {"specular", s.specular}});
    slider("shininess", s.shininess, 2, 200, "%.0f", ImGuiSliderFlags_Logarithmic);
  }
  if (is("texture")) {
    slider("repeats", s.texture_repeats, 1, 20, "%.0f");
    picture_file("texture", workspace.pictures.texture);
  }
  if (is("bump") || is("displacement")) {
    slider("normal scale", s.normal_scale, 0, 10);
    slider("repeats", s.height_repeats, 1, 20, "%.0f");
    picture_file("height map", workspace.pictures.height_map);
  }
  if (is("mirror")) sky_folder(workspace.pictures.sky);
  if (is("displacement")) slider("height [m]", s.height_scale, 0, 0.1f);
  if (is("phong_force") || is("ggx_force"))
    slider("force scale", s.force_scale, 0.01f, 100, "%.2f", ImGuiSliderFlags_Logarithmic);
  if (is("strain")) {
    float percent = 100 * s.strain_range;
    if (slider("full scale", percent, 0.1f, 100, "%.3g %%", ImGuiSliderFlags_Logarithmic))
      s.strain_range = percent / 100;
  }
  if (is("wireframe"))
    switches({{"structural", s.structural}, {"shear", s.shear}, {"bend", s.bend}});
}

}  // namespace

void draw_looks(Workspace& workspace) {
  draw_list(workspace);
  LookSettings& s = workspace.settings;
  ImGui::PushItemWidth(ImGui::GetFontSize() * 11);
  heading("Material");
  draw_material(workspace);
  heading("Picture");
  choose("quality", s.quality, {"automatic", "quick", "standard", "fine"});
  tooltip(
      "fine: ambient occlusion, softer shadows, and the cloth's thickness at its border; quick: "
      "less "
      "at rest, too; automatic: fine where there is a graphics card");
  switches({{"shadow", s.shadows}, {"floor", s.ground}});
  slider("roundness of bodies", s.tessellation, 16, 128);
  slider("smoothness", s.refinement, 0, 6, s.refinement == 0 ? "auto" : "%d");
  tooltip("Vertices drawn for one side of a square of the grid");
  ImGui::PopItemWidth();
  if (ImGui::Button("Standard look")) {
    s = LookSettings{};
    workspace.pictures = {};
  }
  mark("Standard look");
  tooltip("All settings of the looks as they were, and the program's own pictures");
  ImGui::PushTextWrapPos(0);
  ImGui::TextColored(kQuiet,
                     "Shaders are read from their folder while this runs: change one and "
                     "look. Drop a picture to use it as texture.");
  ImGui::PopTextWrapPos();
}

}  // namespace weft::viewer
