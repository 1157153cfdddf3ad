// One button for each fabric.
#include "edit/fabrics.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

namespace {

// How a fabric looks; threads are drawn thicker than they are.
struct FabricLook {
  std::string_view fabric;
  Weave weave;
  float threads;  // 1/m
  float roughness, sheen, translucency;
  const char *front, *back;
};
constexpr std::array<FabricLook, 5> kFabricLooks{{
    {"silk", Weave::satin, 900, .28f, .12f, .4f, "#cebca2", "#bfad97"},
    {"cotton", Weave::plain, 450, .75f, .2f, .3f, "#cbc8c0", "#c5c2bc"},
    {"wool", Weave::twill, 250, .9f, .6f, .12f, "#7c7e6f", "#76796c"},
    {"denim", Weave::twill, 380, .8f, .15f, .05f, "#304b81", "#3f598e"},
    {"leather", Weave::leather, 500, .45f, .02f, 0, "#6f4830", "#8e7359"},
}};

// All cloths are of it. Who looks at the plain colour sees the fabric; another look stays.
void wear(const Fabric& worn, Workspace& workspace) {
  const auto look = std::ranges::find(kFabricLooks, worn.name, &FabricLook::fabric);
  if (look == kFabricLooks.end()) return;
  const FabricLook& fabric = *look;
  workspace.edit(changes_to(worn, {fabric.front, fabric.back}, workspace.document().scene()), false,
                 std::string(worn.name));
  LookSettings& s = workspace.settings;
  s.weave = fabric.weave;
  s.threads = fabric.threads;
  s.roughness = fabric.roughness;
  s.sheen = fabric.sheen;
  s.translucency = fabric.translucency;
  if (workspace.look->name == "colour") workspace.look = find_look("fabric");
}

}  // namespace

void draw_fabrics(Workspace& workspace) {
  heading("Fabric");
  const std::span<const Fabric> all = fabrics();
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float count = static_cast<float>(all.size());
  const float width = (ImGui::GetContentRegionAvail().x - gap * (count - 1)) / count;
  for (const Fabric& fabric : all) {
    if (&fabric != all.data()) ImGui::SameLine(0, gap);
    if (ImGui::Button(std::string(fabric.name).c_str(), {width, 0})) wear(fabric, workspace);
    mark(std::string(fabric.name));
    const Membrane& membrane = fabric.membrane;
    const Bending& bending = fabric.bending;
    char about[200];
    std::snprintf(
        about, sizeof about,
        "%g g/m²; along warp and weft: %g and %g N/m, bending %g and %g µN·m; shear %g N/m",
        1000 * fabric.weight, membrane.warp, membrane.weft, 1e6 * bending.warp, 1e6 * bending.weft,
        membrane.shear);
    tooltip(about);
  }
}

}  // namespace weft::viewer
