// One button for each fabric.
#include "edit/fabrics.h"

#include <cstdio>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

void draw_fabrics(Workspace& workspace) {
  heading("Fabric");
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float width =
      (ImGui::GetContentRegionAvail().x - gap * (kFabrics.size() - 1)) / kFabrics.size();
  for (const Fabric& fabric : kFabrics) {
    if (&fabric != kFabrics.data()) ImGui::SameLine(0, gap);
    if (ImGui::Button(std::string(fabric.name).c_str(), {width, 0})) {
      std::vector<Document::Change> changes;
      const std::vector<Cloth>& cloths = workspace.document().scene().cloths;
      for (std::size_t c = 0; c < cloths.size(); ++c)
        for (Document::Change& change : changes_to(fabric, c, cloths[c].mesh.given()))
          changes.push_back(std::move(change));
      workspace.edit(changes, false, std::string(fabric.name));
    }
    mark(std::string(fabric.name));
    char about[160];
    std::snprintf(about, sizeof about,
                  "%g g/m², %g N/m along the threads, %g N/m in shear, bending %g µN·m",
                  1000 * fabric.weight, fabric.tensile, fabric.shear, 1e6 * fabric.rigidity);
    tooltip(about);
  }
}

}  // namespace weft::viewer
