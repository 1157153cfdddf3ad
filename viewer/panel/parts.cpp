// What a scene is made of: buttons that add a cloth or a body.
#include <string_view>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

void draw_parts(Workspace& workspace, Requests& requests) {
  heading("Add");
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const ImVec2 size{(ImGui::GetContentRegionAvail().x - 2 * gap) / 3, 0};
  if (ImGui::Button("cloth", size) && workspace.add_cloth()) requests.newest = Kind::cloth;
  mark("add cloth");
  tooltip("A level sheet of the first cloth's material, above all else");
  for (std::size_t shape = 0; shape < kShapeNames.size(); ++shape) {
    if (kShapeNames[shape] == std::string_view("mesh")) continue;  // of a file
    if (shape != 2) ImGui::SameLine(0, gap);                       // two rows of three
    if (ImGui::Button(kShapeNames[shape], size) && workspace.add_body(shape))
      requests.newest = Kind::body;
    mark(std::string("add ") + kShapeNames[shape]);
    tooltip("Put where the camera looks; Move then has its arrows, rings and square");
  }
  if (ImGui::Button("mesh of a file …", {-1, 0})) requests.mesh = true;
  mark("add mesh");
  tooltip(
      "A mesh file (.obj, .ply, .glb, .gltf) as cloth or as a body; or drop the file on the "
      "window");
}

}  // namespace weft::viewer
