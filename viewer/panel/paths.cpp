// The path of a pin or a collider, or a vector or an angle over time: a line for each key, time and values.
#include <algorithm>

#include "panel/panel.h"
#include "panel/theme.h"

namespace weft::viewer {

namespace {

constexpr double kFar = 10000, kLongest = 1e6;  // m, s: as the schema
constexpr double kBetween = 0.01;               // s, between neighbours at least
constexpr std::size_t kMostKeys = 200;

// The controls of key k; true when it has changed.
bool draw_key(text::Json& keys, std::size_t k, const char* about) {
  text::Json& key = keys[k];
  auto value = key.get<std::vector<double>>();
  const double first = k > 0 ? keys[k - 1][0].get<double>() + kBetween : 0;
  const double last = k + 1 < keys.size() ? keys[k + 1][0].get<double>() - kBetween : kLongest;
  const double low = -kFar, high = kFar;
  const float em = ImGui::GetFontSize();
  ImGui::SetNextItemWidth(4.2f * em);
  bool changed = ImGui::DragScalar("##time", ImGuiDataType_Double, value.data(), 0.01f, &first,
                                   &last, "%.2f s", ImGuiSliderFlags_AlwaysClamp);
  ImGui::SameLine();
  const int values = static_cast<int>(value.size()) - 1;
  ImGui::SetNextItemWidth(11.5f * em);
  const float speed = values == 1 ? 0.5f : 0.005f;
  changed = ImGui::DragScalarN("##values", ImGuiDataType_Double, &value[1], values, speed, &low,
                               &high, "%.3g", ImGuiSliderFlags_AlwaysClamp) ||
            changed;
  tooltip(about);
  if (changed) key = value;
  return changed;
}

}  // namespace

bool draw_path(const std::string& name, const std::string& pointer, text::Json& keys, double now,
               const std::vector<double>& start, const char* about) {
  const std::string count = keys.empty() ? "" : ": " + std::to_string(keys.size()) + " keys";
  const bool open = ImGui::TreeNodeEx((name + count + "###" + pointer).c_str(),
                                      ImGuiTreeNodeFlags_NoTreePushOnOpen);
  mark(pointer);
  if (!open) return false;
  bool changed = false;
  std::size_t gone = keys.size();
  ImGui::PushID(pointer.c_str());
  for (std::size_t k = 0; k < std::min(keys.size(), kMostKeys); ++k) {
    ImGui::PushID(static_cast<int>(k));
    changed = draw_key(keys, k, about) || changed;
    ImGui::SameLine();
    if (ImGui::Button("×")) gone = k;
    mark(pointer + " remove " + std::to_string(k));
    ImGui::PopID();
  }
  if (gone < keys.size()) {
    keys.erase(gone);
    changed = true;
  }
  if (ImGui::Button("Add a key")) {
    const double after = keys.empty() ? 0 : keys.back()[0].get<double>() + 0.5;
    text::Json key = start;
    key.insert(key.begin(), 0.0);
    if (!keys.empty()) key = keys.back();
    key[0] = std::max(now, after);
    keys.push_back(key);
    changed = true;
  }
  mark(pointer + " add");
  ImGui::PopID();
  return changed;
}

}  // namespace weft::viewer
