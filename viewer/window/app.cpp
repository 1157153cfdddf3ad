// The loop: events, keys, hands, picture, panel.
#include "window/app.h"

#include <glad/gl.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <numbers>

#include "failure.h"
#include "panel/theme.h"
#include "picture/cpu_time.h"
#include "weft/interrupt.h"
#include "weft/mesh.h"
#include "weft/output.h"
#include "weft/printable.h"

namespace weft::viewer {

namespace {

constexpr double kTurn = 1.0 / 60;  // s, the shortest turn

// What the simulation's thread still works on cannot be destroyed.
[[noreturn]] void leave_within_frame(const std::string& problem) {
  if (!problem.empty()) std::fprintf(stderr, "weft-viewer: error: %s\n", problem.c_str());
  remove_temporaries();
  std::fflush(stdout);
  const int code = interrupted() == 0 ? kDone : 128 + interrupted();
  std::_Exit(problem.empty() ? code : kCannotWrite);
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Pointer pointer_now() {
  const ImGuiIO& io = ImGui::GetIO();
  Pointer p;
  p.x = io.MousePos.x, p.y = io.MousePos.y;
  p.dx = io.MouseDelta.x, p.dy = io.MouseDelta.y;
  p.wheel = io.MouseWheel;
  p.left = io.MouseDown[0], p.right = io.MouseDown[1], p.middle = io.MouseDown[2];
  p.pressed = ImGui::IsMouseClicked(0), p.released = ImGui::IsMouseReleased(0);
  p.inside = !io.WantCaptureMouse && ImGui::IsMousePosValid();
  p.ctrl = io.KeyCtrl, p.shift = io.KeyShift, p.alt = io.KeyAlt;
  return p;
}

}  // namespace

App::App(const Arguments& arguments)
    : window_(arguments.width, arguments.height, "Weft"),
      workspace_(arguments),
      view_(arguments.pictures),
      panel_(keys_),
      log_(arguments.log),
      measure_(arguments.measure) {
  set_theme(window_.scale());
  if (log_.on()) ImGui::GetIO().UserData = &landmarks_;
  read_keys(arguments.keys);
}

void App::read_keys(const std::string& path) {
  std::error_code error;
  const std::string file = path.empty() ? keys_file() : path;
  if (!path.empty() && !std::filesystem::exists(path, error))
    workspace_.messages.warn(path + ": there is no such file of keys", 0);
  for (const std::string& wrong : keys_.read(file)) workspace_.messages.warn(wrong, 0);
}

void App::run() {
  const double begun = seconds_now();
  while (!window_.closing()) {
    const double start = seconds_now();
    turn_ = {};
    turn();
    const double took = seconds_now() - start;
    if (turn_.drawn) view_.took(1e3 * took);
    window_.poll(std::max(0.0, kTurn - took));
    turn_.all_ms = 1e3 * (seconds_now() - start);
    panel_.history.add(workspace_.telemetry(), workspace_.frame_data().scene_serial, turn_);
    if (measure_ > 0 && measured(begun)) window_.close();
    if (interrupted() != 0) window_.close();
  }
  window_.hide();
  const std::string problem = end();
  if (!workspace_.ended()) leave_within_frame(problem);
  if (!problem.empty()) throw Failure(kCannotWrite, problem);
}

// All files that are not finished are; nobody looks at the window any more: what went wrong, or "".
std::string App::end() {
  const std::string problem = filming_.finish();
  const std::string other = workspace_.end();
  return problem + (problem.empty() || other.empty() ? "" : "\n") + other;
}

// The first second, in which shaders are compiled, does not count. At the end the scene is paused, and it is
// measured how long the picture of every pixel takes to come.
bool App::measured(double begun) {
  constexpr double kPatience = 10;  // s
  const double now = seconds_now(), since = now - begun;
  if (paused_at_ > 0) {
    const bool full = turn_.picture && view_.whole() && workspace_.telemetry().paused;
    if (full)
      std::printf("pause to picture of every pixel %.0f ms (%.0f ms of processor time)\n",
                  1e3 * (now - paused_at_), cpu_ms(CLOCK_PROCESS_CPUTIME_ID) - worked_ms_);
    return full || now - paused_at_ > kPatience;
  }
  if (since > 1) turns_.push_back(turn_);
  if (since < 1 + measure_) return false;
  std::fputs(words(turns_).c_str(), stdout);
  if (workspace_.telemetry().paused) return true;
  paused_at_ = now;
  worked_ms_ = cpu_ms(CLOCK_PROCESS_CPUTIME_ID);
  workspace_.play(false);
  return false;
}

// Nothing is drawn while there is nothing new: where the processor draws, that is time for the simulation.
// What fades, and the figures, are looked at now and then.
bool App::due(double now, bool fresh) {
  constexpr double kSettles = 0.3, kNowAndThen = 0.1;  // s
  if (window_.take_stir()) stirred_ = now;
  return fresh || hands_.busy() || ImGui::IsAnyMouseDown() || filming_.on() ||
         now - stirred_ < kSettles || now - last_turn_ >= kNowAndThen;
}

void App::turn() {
  const double now = seconds_now();
  const bool fresh = workspace_.refresh(now);
  const bool draws = due(now, fresh);
  take_dropped();
  view_.reload(workspace_);
  if (!window_.visible() || !draws) return;
  turn_.drawn = true;
  const double panel_start = cpu_ms();
  landmarks_.clear();
  window_.begin_panel();
  for (const KeyPress& press : window_.take_keys()) {
    const Action action = keys_.action_of(press);
    const bool typing = ImGui::GetIO().WantTextInput;
    if (action != Action::count && !typing &&
        (!press.again || action == Action::step || action == Action::back ||
         action == Action::forward) &&
        (ImGui::GetTopMostPopupModal() == nullptr || action == Action::close ||
         action == Action::quit))
      dispatch(action);
  }
  push_bodies(std::min(now - last_turn_, 0.1));
  last_turn_ = now;
  const Area area = panel_.picture_area();
  workspace_.set_picture(area.aspect(), panel_.clear_share());
  hands_.update(workspace_, area, pointer_now());
  hands_.draw(workspace_, area, *ImGui::GetBackgroundDrawList());
  Requests requests;
  panel_.filming = filming_.on();
  panel_.draw(workspace_, hands_, requests);
  const double picture_start = cpu_ms();
  draw_picture();
  const double picture_end = cpu_ms();
  window_.end_panel(window_.width() - picture_size().first);
  turn_.panel_ms = cpu_ms() - picture_end + picture_start - panel_start;
  turn_.picture = view_.drawn();
  if (view_.drawn()) turn_.surface_ms = view_.own_ms();
  window_.swap();
  apply(requests);
  filming_.turn(workspace_, view_);
  log_.write(workspace_, view_, hands_, panel_.help, landmarks_);
}

std::pair<int, int> App::picture_size() const {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float fine = size.x > 0 ? static_cast<float>(window_.width()) / size.x : 1;
  const int x = static_cast<int>(panel_.picture_area().x * fine);
  return {std::max(16, window_.width() - x), std::max(16, window_.height())};
}

void App::draw_picture() {
  const auto [width, height] = picture_size();
  view_.draw(workspace_, window_.width() - width, 0, width, height);
}

void App::dispatch(Action action) {
  if (action == Action::quit) window_.close();
  if (action == Action::close) close_top();
  if (action == Action::gallery) panel_.gallery.open = !panel_.gallery.open;
  if (action == Action::help) panel_.help = !panel_.help;
  if (action == Action::panel) panel_.visible = !panel_.visible;
  if (action == Action::screenshot) take_picture({});
  if (action == Action::film) start_or_end_film({});
  if (action >= Action::hand && action <= Action::ball)
    hands_.tool = static_cast<Tool>(static_cast<int>(action) - static_cast<int>(Action::hand));
  dispatch_scene(action);
  dispatch_view(action);
  dispatch_part(action);
}

// What the handles are about.
void App::dispatch_part(Action action) {
  if (action != Action::remove && action != Action::duplicate) return;
  const std::optional<Part> chosen = hands_.pusher.chosen();
  if (hands_.tool != Tool::move || !chosen) {
    workspace_.messages.tell("Choose a cloth or a body with the tool Move first", workspace_.now());
    return;
  }
  if (action == Action::remove && workspace_.remove(*chosen)) hands_.pusher.choose({});
  if (action == Action::duplicate && workspace_.duplicate(*chosen))
    hands_.choose_newest(workspace_, chosen->kind);
}

// The list or the help that is open; where nothing is, says how to leave.
void App::close_top() {
  constexpr ImGuiPopupFlags any = ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel;
  if (ImGui::IsPopupOpen("", any))
    ImGui::ClosePopupsOverWindow(nullptr, false);
  else if (panel_.help)
    panel_.help = false;
  else if (panel_.gallery.open)
    panel_.gallery.open = false;
  else
    workspace_.messages.tell(keys_.names_of(Action::quit) + " leaves", workspace_.now());
}

void App::dispatch_scene(Action action) {
  const Telemetry& v = workspace_.telemetry();
  if (action == Action::pause) workspace_.play(v.paused);
  if (action == Action::step) workspace_.step();
  if (action == Action::reset) workspace_.reset();
  if (action == Action::undo) workspace_.undo();
  if (action == Action::redo) workspace_.redo();
  if (action == Action::save) workspace_.save(workspace_.document().save_path());
  if (action == Action::faster) workspace_.set_speed(std::min(8.0, v.speed * 2));
  if (action == Action::slower) workspace_.set_speed(std::max(1.0 / 64, v.speed / 2));
  if (action == Action::back) workspace_.go_back(v.back + 1);
  if (action == Action::forward) workspace_.go_back(std::max(0, v.back - 1));
}

void App::dispatch_view(Action action) {
  constexpr float kQuarter = std::numbers::pi_v<float> / 2, kSteep = 1.5f;
  if (action == Action::frame) workspace_.frame_cloth();
  if (action == Action::home) workspace_.show_home();
  if (action == Action::front) workspace_.show_along(0, 0);
  if (action == Action::side) workspace_.show_along(kQuarter, 0);
  if (action == Action::top) workspace_.show_along(0, kSteep);
  if (action == Action::next_look) workspace_.next_look(1);
  if (action == Action::previous_look) workspace_.next_look(-1);
  if (action == Action::next_scene) workspace_.open_neighbour(1);
  if (action == Action::previous_scene) workspace_.open_neighbour(-1);
}

void App::push_bodies(double seconds) {
  if (ImGui::GetIO().WantTextInput) return;
  const auto along = [&](Action less, Action more) {
    return (keys_.held(more, window_) ? 1.0f : 0.0f) - (keys_.held(less, window_) ? 1.0f : 0.0f);
  };
  hands_.pusher.push(
      workspace_,
      {along(Action::move_left, Action::move_right), along(Action::move_down, Action::move_up),
       along(Action::move_far, Action::move_near)},
      seconds);
}

// A picture becomes the texture, of a mesh the person is asked what it is to be, anything else is a scene.
void App::take_dropped() {
  for (const std::string& path : window_.take_dropped()) {
    std::string extension = std::filesystem::path(path).extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".png" || extension == ".jpg" || extension == ".jpeg") {
      workspace_.pictures.texture = path;
      workspace_.look = find_look("texture");
    } else if (is_mesh_file(path)) {
      panel_.mesh_form.ask(path);
    } else {
      workspace_.open(path);
    }
  }
}

void App::apply(const Requests& requests) {
  if (requests.picture) take_picture(*requests.picture);
  if (requests.film) start_or_end_film(*requests.film);
}

void App::take_picture(const PictureRequest& asked) {
  const std::string path = free_name(workspace_.document().name(), ".png", workspace_.record());
  const auto [width, height] =
      asked.width > 0 ? std::pair(asked.width, asked.height) : picture_size();
  try {
    write_png(path, view_.picture(workspace_, width, height, asked.samples));
    workspace_.messages.tell("Picture saved to " + full_path(path), workspace_.now());
  } catch (const Failure& failure) {
    workspace_.messages.warn("No picture: " + std::string(failure.what()), workspace_.now());
  }
}

void App::start_or_end_film(const FilmRequest& asked) {
  const auto [width, height] = picture_size();
  if (filming_.on())
    filming_.end(workspace_);
  else
    filming_.start(asked, width, height, workspace_);
}

}  // namespace weft::viewer
