// Tiles with the pictures that scripts/pictures makes (scene-NAME.png).
#include "panel/gallery.h"

#include <algorithm>

#include "panel/theme.h"
#include "picture/images.h"

namespace weft::viewer {

namespace {

namespace fs = std::filesystem;

constexpr float kWidth = 12, kHeight = 9;  // of a picture, in letters' heights

// Where it is, or "".
fs::path find_picture(const std::string& scene) {
  std::error_code error;
  const fs::path here = fs::read_symlink("/proc/self/exe", error).parent_path();
  for (const fs::path& folder : {here / "../share/weft/pictures", fs::path(WEFT_SOURCE_PICTURES),
                                 fs::path(WEFT_INSTALLED_PICTURES)})
    if (const fs::path file = folder / ("scene-" + scene + ".png"); fs::exists(file, error))
      return file;
  return {};
}

}  // namespace

const Texture& Gallery::picture_of(const std::string& scene) {
  const auto found = pictures_.find(scene);
  if (found != pictures_.end()) return found->second;
  std::string error;  // without its picture a scene has its name
  const fs::path file = find_picture(scene);
  return pictures_[scene] = file.empty() ? Texture() : load_picture(file.string(), error);
}

void Gallery::tile(Workspace& workspace, const ShippedScene& scene) {
  const float em = ImGui::GetFontSize();
  const ImVec2 size{kWidth * em, kHeight * em};
  const GLuint picture = ImGui::IsRectVisible(size) ? picture_of(scene.name).id() : 0;
  ImGui::PushID(scene.name.c_str());
  const bool pressed =
      picture != 0 ? ImGui::ImageButton(reinterpret_cast<ImTextureID>(std::uintptr_t{picture}),
                                        size, {0, 0}, {1, 1}, 2)
                   : ImGui::Button("##empty", {size.x + 4, size.y + 4});
  ImGui::PopID();
  mark("gallery " + scene.name);
  tooltip(scene.about.c_str());
  ImGui::TextUnformatted(scene.name.c_str());
  if (!pressed) return;
  open = false;
  workspace.open(scene.path);
}

void Gallery::draw(Workspace& workspace) {
  if (!open) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({0.92f * size.x, 0.92f * size.y});
  if (ImGui::Begin("Scenes", &open,
                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoResize |
                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                       ImGuiWindowFlags_NoNav)) {
    const float tile_width = kWidth * ImGui::GetFontSize() + 2 * ImGui::GetStyle().ItemSpacing.x;
    const int columns =
        std::clamp(static_cast<int>(ImGui::GetContentRegionAvail().x / tile_width), 1, 60);
    if (ImGui::BeginTable("tiles", columns)) {
      for (const ShippedScene& scene : workspace.scenes()) {
        ImGui::TableNextColumn();
        tile(workspace, scene);
      }
      ImGui::EndTable();
    }
  }
  ImGui::End();
}

}  // namespace weft::viewer
