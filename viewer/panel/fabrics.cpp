// One button for each fabric.
#include "edit/fabrics.h"

#include <array>
#include <cstdio>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

namespace {

// How each fabric looks, in the order of kFabrics; threads are drawn thicker than they are.
struct FabricLook {
  Weave weave;
  float threads;  // 1/m
  float roughness, sheen, translucency;
  Vec3f front, back;  // linear
};
constexpr std::array<FabricLook, std::tuple_size_v<std::remove_cv_t<decltype(kFabrics)>>>
    kFabricLooks{{
        {Weave::satin, 900, 0.28f, 0.12f, 0.40f, {0.62f, 0.50f, 0.36f}, {0.52f, 0.42f, 0.31f}},
        {Weave::plain, 450, 0.75f, 0.20f, 0.30f, {0.60f, 0.58f, 0.53f}, {0.56f, 0.54f, 0.50f}},
        {Weave::twill, 250, 0.90f, 0.60f, 0.12f, {0.20f, 0.21f, 0.16f}, {0.18f, 0.19f, 0.15f}},
        {Weave::twill, 380, 0.80f, 0.15f, 0.05f, {0.03f, 0.07f, 0.22f}, {0.05f, 0.10f, 0.27f}},
        {Weave::leather, 500, 0.45f, 0.02f, 0.0f, {0.16f, 0.065f, 0.03f}, {0.27f, 0.17f, 0.10f}},
    }};

// Who looks at the plain colour sees the fabric; another look stays.
void wear(const FabricLook& fabric, Workspace& workspace) {
  LookSettings& s = workspace.settings;
  s.weave = fabric.weave;
  s.threads = fabric.threads;
  s.roughness = fabric.roughness;
  s.sheen = fabric.sheen;
  s.translucency = fabric.translucency;
  for (std::size_t c = 0; c < workspace.document().scene().cloths.size(); ++c)
    choose_colors(s, c, {fabric.front, fabric.back});
  if (workspace.look->name == "colour") workspace.look = find_look("fabric");
}

}  // namespace

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
      wear(kFabricLooks[static_cast<std::size_t>(&fabric - kFabrics.data())], workspace);
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
