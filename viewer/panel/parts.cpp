// What a scene is made of: buttons that add a cloth or a body.
#include <algorithm>

#include "panel/panel.h"
#include "panel/theme.h"
#include "weft/shape.h"

namespace weft::viewer {

void draw_parts(Workspace& workspace, Requests& requests) {
  heading("Add");
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  constexpr int kCells = 3;  // in a row; a long name takes two
  const float cell = (ImGui::GetContentRegionAvail().x - (kCells - 1) * gap) / kCells;
  if (ImGui::Button("cloth", {cell, 0}) && workspace.add_cloth()) requests.newest = Kind::cloth;
  mark("add cloth");
  tooltip("A level sheet of the first cloth's material, above all else");
  const std::vector<Shape> shapes = shapes_of_size(1);
  int taken = 1;
  for (std::size_t number = 0; number < shapes.size(); ++number) {
    const std::string name = kShapeNames[shapes[number].index()];
    std::string label = name;
    std::replace(label.begin(), label.end(), '_', ' ');
    const float padding = 2 * ImGui::GetStyle().FramePadding.x;
    const int cells = ImGui::CalcTextSize(label.c_str()).x + padding > cell ? 2 : 1;
    if (taken + cells <= kCells)
      ImGui::SameLine(0, gap);
    else
      taken = 0;
    taken += cells;
    const float width = static_cast<float>(cells) * (cell + gap) - gap;
    if (ImGui::Button(label.c_str(), {width, 0}) && workspace.add_body(number))
      requests.newest = Kind::body;
    mark("add " + name);
    tooltip("Put where the camera looks; Move then has its arrows, rings and square");
  }
  if (ImGui::Button("mesh of a file …", {-1, 0})) requests.mesh = true;
  mark("add mesh");
  tooltip(
      "A mesh file (.obj, .ply, .glb, .gltf) as cloth or as a body; or drop the file on the "
      "window");
}

}  // namespace weft::viewer
