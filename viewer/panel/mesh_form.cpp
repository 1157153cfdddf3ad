// A dialog about one file.
#include "panel/mesh_form.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "panel/panel.h"
#include "panel/theme.h"
#include "weft/mesh.h"
#include "weft/printable.h"

namespace weft::viewer {

namespace {

namespace fs = std::filesystem;

constexpr const char* kTitle = "Add a mesh";
constexpr std::size_t kMostFiles = 12, kMostLines = 6;

// Those of the first folder come first.
std::vector<std::string> meshes_in(const std::vector<fs::path>& folders) {
  std::vector<std::string> found;
  std::set<fs::path> seen;
  for (const fs::path& folder : folders) {
    const auto before = static_cast<std::ptrdiff_t>(found.size());
    std::error_code error;
    const fs::path here = folder.empty() ? "." : folder;
    if (!seen.insert(fs::weakly_canonical(here, error)).second) continue;
    for (const auto& entry : fs::directory_iterator(here, error))
      if (is_mesh_file(entry.path().string()))
        found.push_back(entry.path().lexically_normal().string());
    std::sort(found.begin() + before, found.end());
  }
  if (found.size() > kMostFiles) found.resize(kMostFiles);
  return found;
}

double largest_side(const Vec3& low, const Vec3& high) {
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

// Meters, unless the mesh then is far larger than the scene; else centimeters or millimeters, in which its
// side is nearest to a third of the scene's size.
double unit_of(double side, double size) {
  constexpr double kProportion = 8;
  if (side < kProportion * size) return 1;
  const auto off = [&](double unit) { return std::abs(std::log(3 * side * unit / size)); };
  return off(0.01) <= off(0.001) ? 0.01 : 0.001;
}

}  // namespace

void MeshForm::take(const std::string& path, const Workspace& workspace) {
  path_ = taken_ = path;
  file_ = {};
  const fs::path scene = fs::path(workspace.document().path()).parent_path();
  beside_ = path.empty() ? meshes_in({"", scene}) : meshes_in({fs::path(path).parent_path()});
  if (path.empty()) return;
  file_ = read_mesh(path);
  if (!file_.faults.empty() || file_.mesh.vertices.empty()) return;
  low_ = high_ = file_.mesh.vertices.front();
  for (const Vec3& p : file_.mesh.vertices)
    for (std::size_t k = 0; k < 3; ++k)
      low_[k] = std::min(low_[k], p[k]), high_[k] = std::max(high_[k], p[k]);
  scale_ = unit_of(largest_side(low_, high_), static_cast<double>(workspace.setting().size));
  const Bounds& room = workspace.setting().room;
  const Vec3 near = workspace.in_scene(room.low), far = workspace.in_scene(room.high);
  as_in_file_ = true;
  for (std::size_t k = 0; k < 3; ++k)
    as_in_file_ = as_in_file_ && scale_ * low_[k] <= far[k] && scale_ * high_[k] >= near[k];
}

MeshSource MeshForm::placed(const Workspace& workspace) const {
  MeshSource mesh;
  mesh.file = fs::absolute(taken_).lexically_normal().string();
  mesh.scale = scale_;
  mesh.shape = std::make_shared<const TriangleMesh>(file_.mesh);
  if (as_in_file_) return mesh;
  const Vec3 at = workspace.in_scene(workspace.camera.target());
  for (std::size_t k = 0; k < 3; ++k) mesh.translate[k] = at[k] - scale_ * (low_[k] + high_[k]) / 2;
  return mesh;
}

void MeshForm::draw_path(const Workspace& workspace) {
  ImGui::SetNextItemWidth(30 * ImGui::GetFontSize());
  if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
  const bool entered =
      ImGui::InputTextWithHint("##file", "a file (.obj, .ply, .glb, .gltf), then Enter", &path_,
                               ImGuiInputTextFlags_EnterReturnsTrue);
  mark("mesh file");
  if (entered || (ImGui::IsItemDeactivatedAfterEdit() && path_ != taken_)) take(path_, workspace);
  if (!taken_.empty()) return;
  const std::vector<std::string> files = beside_;  // a choice reads another list
  for (const std::string& file : files) {
    if (ImGui::Selectable(file.c_str(), false, ImGuiSelectableFlags_DontClosePopups))
      take(file, workspace);
    mark("mesh file " + fs::path(file).filename().string());
  }
}

void MeshForm::draw_mesh() {
  const auto side = [&](std::size_t k) { return scale_ * (high_[k] - low_[k]); };
  ImGui::Text("%zu vertices, %zu triangles: %.3g × %.3g × %.3g m", file_.mesh.vertices.size(),
              file_.mesh.triangles.size(), side(0), side(1), side(2));
  ImGui::PushTextWrapPos(30 * ImGui::GetFontSize());
  for (std::size_t n = 0; n < std::min(file_.notes.size(), kMostLines); ++n)
    ImGui::TextColored(kQuiet, "%s", printable(file_.notes[n]).c_str());
  ImGui::PopTextWrapPos();
  constexpr double kLeast = 1e-4, kMost = 1e4;
  ImGui::SetNextItemWidth(8 * ImGui::GetFontSize());
  ImGui::DragScalar("meters for each unit of the file", ImGuiDataType_Double, &scale_,
                    static_cast<float>(0.01 * scale_), &kLeast, &kMost, "%.4g",
                    ImGuiSliderFlags_AlwaysClamp);
  mark("mesh scale");
  ImGui::Checkbox("stands where the file has it, else where the camera looks", &as_in_file_);
  mark("mesh as in file");
}

void MeshForm::draw(Workspace& workspace, Requests& requests) {
  if (!waiting_.empty() && !ImGui::IsPopupOpen(kTitle)) {
    take(waiting_.front(), workspace);
    waiting_.pop_front();
    ImGui::OpenPopup(kTitle);
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y / 2}, ImGuiCond_Always, {0.5f, 0.5f});
  if (!ImGui::BeginPopupModal(kTitle, nullptr,
                              ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove |
                                  ImGuiWindowFlags_NoSavedSettings))
    return;
  draw_path(workspace);
  for (std::size_t n = 0; n < std::min(file_.faults.size(), kMostLines); ++n) {
    const Fault& fault = file_.faults[n];
    ImGui::TextColored(kBad, "%s", printable(fault.place + ": " + fault.what).c_str());
  }
  const bool read = !taken_.empty() && file_.faults.empty();
  if (read) draw_mesh();
  ImGui::BeginDisabled(!read);
  std::optional<Kind> kind;
  if (ImGui::Button("As cloth")) kind = Kind::cloth;
  mark("mesh as cloth");
  tooltip("Its vertices are particles, of the first cloth's material");
  ImGui::SameLine();
  if (ImGui::Button("As body")) kind = Kind::body;
  mark("mesh as body");
  tooltip("Cloth falls onto it");
  ImGui::EndDisabled();
  ImGui::SameLine();
  bool close = ImGui::Button("Cancel");
  mark("mesh cancel");
  if (kind && workspace.add_mesh(*kind, placed(workspace))) {
    requests.newest = kind;
    close = true;
  }
  if (close) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

}  // namespace weft::viewer
