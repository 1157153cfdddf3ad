// One line of the log.
#include "window/log.h"

#include <imgui.h>

#include <cmath>
#include <cstdio>
#include <numeric>

#include "failure.h"

namespace weft::viewer {

Log::Log(const std::string& path) {
  if (path.empty()) return;
  file_.open(path);
  if (!file_) throw Failure(kCannotWrite, path + ": cannot be written");
}

void Log::write(const Workspace& workspace, const View& view, const Hands& hands, bool help,
                const Landmarks& controls) {
  if (!file_.is_open()) return;
  const Telemetry& v = workspace.telemetry();
  const FrameData& s = workspace.frame_data();
  const auto held =
      std::accumulate(s.cloths.begin(), s.cloths.end(), 0L, [](long sum, const ClothCopy& cloth) {
        for (int j = 0; j < cloth.rows; ++j)
          for (int i = 0; i < cloth.columns; ++i) sum += cloth.inverse_mass[cloth.at(i, j)] == 0;
        return sum;
      });
  static constexpr const char* kTools[] = {"hand", "pin", "cut", "move", "ball"};
  char hash[20];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(v.hash));
  text::Json faults = text::Json::array(), news = text::Json::array(), bodies = text::Json::array();
  for (const auto& [topic, text] : workspace.messages.faults()) faults.push_back(text);
  for (const Messages::News& one : workspace.messages.news()) news.push_back(one.text);
  for (const Collider& body : s.bodies) bodies.push_back(place_of(moved(body.shape, s.origin)));
  text::Json places = text::Json::object();
  for (const auto& [name, at] : controls) places[name] = {std::lround(at.x), std::lround(at.y)};
  const ImVec2 pointer = ImGui::IsMousePosValid() ? ImGui::GetIO().MousePos : ImVec2(-1, -1);
  const Vec3f eye = workspace.camera.eye(), target = workspace.camera.target();
  const text::Json line{{"scene", workspace.document().name()},
                        {"frame", s.frame},
                        {"hash", hash},
                        {"paused", v.paused},
                        {"speed", v.speed},
                        {"back", v.back},
                        {"look", workspace.look->name},
                        {"coarse", view.coarse()},
                        {"tool", kTools[static_cast<int>(hands.tool)]},
                        {"pointer", {std::lround(pointer.x), std::lround(pointer.y)}},
                        {"busy", hands.busy()},
                        {"waiting", hands.waits()},
                        {"typing", ImGui::GetIO().WantTextInput},
                        {"held", held},
                        {"torn", !s.cloths.empty() && s.cloths[0].torn},
                        {"triangles", s.cloths.empty() ? 0 : s.cloths[0].triangles.size()},
                        {"cloths", s.cloths.size()},
                        {"bodies", bodies},
                        {"undo", workspace.document().next_undo()},
                        {"edited", workspace.document().edited()},
                        {"stiffness", s.scene->cloths[0].stiffness.structural},
                        {"eye", {eye.x, eye.y, eye.z}},
                        {"target", {target.x, target.y, target.z}},
                        {"floor", workspace.setting().solid},
                        {"help", help},
                        {"recording", v.recording},
                        {"faults", faults},
                        {"news", news},
                        {"controls", places}};
  const std::string text = line.dump(-1, ' ', false, text::Json::error_handler_t::replace);
  if (text == last_) return;
  last_ = text;
  file_ << text << std::endl;
}

}  // namespace weft::viewer
