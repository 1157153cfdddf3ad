// What the simulation runs on: threads and instruction set. Neither changes a bit of the result.
#include <thread>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

void draw_machine(Workspace& workspace) {
  if (!ImGui::CollapsingHeader("machine")) return;
  ImGui::Indent(6);
  ImGui::PushItemWidth(ImGui::GetFontSize() * 9.5f);
  int threads = workspace.threads();
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (ImGui::SliderInt("threads", &threads, 1, std::max(2, 2 * cores), "%d",
                       ImGuiSliderFlags_AlwaysClamp))
    workspace.set_options(threads, workspace.simd());
  tooltip("Worker threads of the simulation; never changes the result");
  if (ImGui::BeginCombo("instruction set", simd_name(workspace.simd()))) {
    for (const Simd simd : {Simd::scalar, Simd::sse2, Simd::avx2, Simd::avx512, Simd::best})
      if (simd_available(simd) && ImGui::Selectable(simd_name(simd), simd == workspace.simd()))
        workspace.set_options(threads, simd);
    ImGui::EndCombo();
  }
  tooltip("Never changes the result");
  ImGui::PopItemWidth();
  ImGui::Unindent(6);
}

}  // namespace weft::viewer
