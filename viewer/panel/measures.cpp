// Figures and plots: time, energy, strain, counts, what was skipped.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

namespace {

void plot(const char* name, const Series& series, const char* unit, bool from_zero) {
  char text[64];
  std::snprintf(text, sizeof text, "%s  %.4g %s", name, static_cast<double>(series.last()), unit);
  const float high = series.greatest(), low = from_zero ? 0 : series.least();
  const float room = 0.6f * std::max(high - low, 1e-6f * std::abs(high) + 1e-12f);  // for the words
  ImGui::PushID(name);
  ImGui::PlotLines("##plot", series.data(), series.count(), series.start(), text, low, high + room,
                   {ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 3.4f});
  ImGui::PopID();
}

// The shares of the stages in a frame, as bars.
void draw_stages(const History& history) {
  float all = 1e-9f;
  for (const auto& [name, series] : history.stages) all += series.last();
  for (const auto& [name, series] : history.stages) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f ms", static_cast<double>(series.last()));
    ImGui::ProgressBar(series.last() / all, {ImGui::GetFontSize() * 9, 0}, text);
    ImGui::SameLine();
    ImGui::TextUnformatted(name.c_str());
  }
}

void draw_counts(const Telemetry& v) {
  const Report& r = v.report;
  ImGui::Text("%lld particles", static_cast<long long>(r.particles));
  ImGui::Text(
      "%lld structural, %lld shear, %lld bend", static_cast<long long>(r.constraints.structural),
      static_cast<long long>(r.constraints.shear), static_cast<long long>(r.constraints.bend));
  if (r.torn > 0) ImGui::Text("%lld torn", static_cast<long long>(r.torn));
  ImGui::Text("%d substeps of %.3g ms, %d threads, %s", v.substeps, 1e3 * v.dt, v.threads,
              r.simd.c_str());
}

void draw_plan(const Telemetry& v) {
  if (!v.plan) return;
  ImGui::PushTextWrapPos(0);
  for (const std::string& note : v.plan->notes) ImGui::TextColored(kAccent, "%s", note.c_str());
  for (const PlannedStage& stage : v.plan->stages)
    ImGui::Text("%s: %s", stage.name.c_str(), stage.detail.c_str());
  heading("Skipped");
  for (const SkippedStage& stage : v.report.skipped)
    ImGui::TextColored(kQuiet, "%s: %s", stage.name.c_str(), stage.why.c_str());
  ImGui::PopTextWrapPos();
}

}  // namespace

void draw_measures(const Workspace& workspace, const History& history) {
  const Telemetry& v = workspace.telemetry();
  heading("Time");
  plot("simulated frame", history.frame_ms, "ms", true);
  plot("turn of the window", history.window_ms, "ms", true);
  plot("normals and upload", history.surface_ms, "ms", true);
  plot("panel", history.panel_ms, "ms", true);
  heading("Stages of a frame");
  draw_stages(history);
  heading("Energy");
  plot("total", history.total, "J", false);
  plot("kinetic", history.kinetic, "J", true);
  plot("elastic", history.elastic, "J", true);
  heading("Strain of the threads");
  plot("greatest", history.strain_max, "%", true);
  plot("mean", history.strain_mean, "%", false);
  heading("Counts");
  draw_counts(v);
  heading("Plan");
  draw_plan(v);
}

}  // namespace weft::viewer
