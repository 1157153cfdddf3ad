// Between the person and the simulation.
#include "window/workspace.h"

#include <limits>
#include <thread>

#include "clashes.h"
#include "failure.h"
#include "film/film.h"
#include "headless.h"
#include "weft/printable.h"
#include "weft/shape.h"

namespace weft::viewer {

namespace {

// One core is left to the window.
int threads_of(const Arguments& arguments) {
  if (arguments.threads > 0) return arguments.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
}

bool is_there(const Scene& scene, const Part& part) {
  return part.number < (part.kind == Kind::body ? scene.colliders.size() : scene.cloths.size());
}

}  // namespace

Workspace::Workspace(const Arguments& arguments)
    : look(find_look(arguments.look)),
      settings(arguments.settings),
      pictures(arguments.pictures),
      record_(arguments.record),
      threads_(threads_of(arguments)) {
  const std::string name = scene_name(arguments);
  const std::vector<Fault> faults = document_.open(name, arguments.overrides);
  if (!faults.empty()) throw Failure(kBadScene, fault_lines(name, faults));
  Options options;
  options.threads = threads_;
  options.seed = arguments.seed;
  refuse_clashes(arguments, document_.path());
  session_.emplace(document_.scene(), options, arguments.paused, !arguments.log.empty());
  simulated_ = kept_ = document_.revision();
  tell_notes();
  tell_kept();
  sight_ = sight_of(arguments, document_.scene());
  show_start();
  if (!arguments.record.empty())
    session_->post([path = arguments.record](Player& player) { player.record(path); });
}

std::string Workspace::end() {
  return session_->end();
}

void Workspace::show_start() {
  serial_ = frame_data().scene_serial;
  take_setting(setting_of(frame_data()));
  if (aspect_ > 0) show_home();
}

// Beneath a grid, which nothing lands on, the eye may go.
void Workspace::take_setting(const Setting& setting) {
  setting_ = setting;
  camera.set_floor(setting.solid ? setting.ground : -std::numeric_limits<float>::infinity());
}

void Workspace::set_picture(float aspect, float clear) {
  const bool first = aspect_ == 0;
  aspect_ = aspect;
  clear_ = clear;
  if (first) show_home();
}

Bounds Workspace::to_frame() const {
  Bounds bounds = seen_bounds(frame_data(), setting_);
  if (frame_data().frame == 0) bounds.add(setting_.room);
  return bounds;
}

void Workspace::frame_cloth() {
  camera.frame(to_frame(), aspect_, clear_);
}

// As the scene begins, however far it has come since.
void Workspace::show_home() {
  aim(sight_, setting_.room, aspect_, clear_, camera);
}

void Workspace::show_along(float azimuth, float elevation) {
  camera.turn_to(azimuth, elevation);
  frame_cloth();
}

void Workspace::open(const std::string& path_or_name) {
  const std::vector<Fault> faults = document_.open(path_or_name);
  messages.fault("scene", fault_lines(path_or_name, faults));
  if (!faults.empty()) return;
  simulated_ = document_.revision();
  opening_ = true;
  session_->post([scene = document_.scene()](Player& player) { player.open(scene); });
  kept_ = simulated_;
  messages.tell("Opened " + document_.name(), now_);
  tell_notes();
  tell_kept();
}

void Workspace::tell_notes() {
  for (const std::string& note : document_.notes()) messages.warn(printable(note), now_);
}

void Workspace::open_neighbour(int step) {
  if (scenes_.empty()) return;
  const auto count = static_cast<int>(scenes_.size());
  int at = step > 0 ? -1 : count;
  for (int k = 0; k < count; ++k)
    if (scenes_[std::size_t(k)].path == document_.path()) at = k;
  open(scenes_[std::size_t((at + step + count) % count)].path);
}

void Workspace::reset() {
  session_->post([scene = document_.scene()](Player& player) { player.open(scene); });
  simulated_ = document_.revision();
}

void Workspace::save(const std::string& path) {
  if (telemetry().recording && same_file(path, record_)) {
    messages.warn("Not saved: the recording goes to " + printable(path), now_);
    return;
  }
  try {
    document_.save(path);
    messages.tell("Saved " + full_path(path), now_);
  } catch (const WriteError& error) {
    messages.warn("Not saved: " + printable(error.path) + ": " + error.what(), now_);
  }
}

bool Workspace::edit(const std::vector<Document::Change>& changes, bool joined,
                     const std::string& name) {
  const std::string wrong = document_.set(changes, joined, name);
  if (!wrong.empty()) messages.warn("Not changed: " + wrong, now_);
  return wrong.empty();
}

bool Workspace::edit(const Scene& scene, const std::string& name, bool joined) {
  return edit(changes_between(document_.scene(), scene), joined, name);
}

bool Workspace::add_cloth() {
  const Bounds& room = setting_.room;
  const Vec3f over{camera.target().x, room.high.y + 0.05f * setting_.size, camera.target().z};
  return edit(with_cloth(document_.scene(), in_scene(over), 0.4 * setting_.size), "add cloth");
}

bool Workspace::add_body(std::size_t number) {
  const double size = 0.2 * setting_.size;
  const Shape shape = shapes_of_size(size)[number];
  return edit(with_body(document_.scene(), shape, in_scene(camera.target()), size),
              std::string("add ") + kShapeNames[shape.index()]);
}

bool Workspace::add_mesh(Kind kind, const MeshSource& mesh) {
  const Solver& before = document_.scene().solver;
  const Scene scene = with_mesh(document_.scene(), kind, mesh);
  const bool same = scene.solver.method == before.method && scene.solver.sweep == before.sweep;
  const bool done = edit(scene, kind == Kind::body ? "add body file" : "add cloth file");
  if (done && !same)
    messages.tell("Meshes need another solver: method compliant, sweep gauss_seidel", now_);
  return done;
}

bool Workspace::duplicate(const Part& part) {
  return is_there(document_.scene(), part) && edit(with_copy(document_.scene(), part), "duplicate");
}

bool Workspace::remove(const Part& part) {
  if (!is_there(document_.scene(), part)) return false;
  if (part.kind == Kind::cloth && document_.scene().cloths.size() == 1) {
    messages.warn("Not taken away: a scene has one cloth at least", now_);
    return false;
  }
  return edit(without(document_.scene(), part), "delete");
}

void Workspace::undo() {
  if (!document_.can_undo()) return;
  messages.tell("Undone: " + document_.next_undo(), now_);
  document_.undo();
}

void Workspace::redo() {
  if (!document_.can_redo()) return;
  document_.redo();
  messages.tell("Done again: " + document_.next_undo(), now_);
}

void Workspace::set_options(int threads, Simd simd) {
  threads_ = threads;
  simd_ = simd;
  session_->post([=](Player& player) { player.set_options(threads, simd); });
}

void Workspace::play(bool on) {
  session_->post([on](Player& player) { player.pause(!on); });
}

void Workspace::set_speed(double speed) {
  session_->post([speed](Player& player) { player.set_speed(speed); });
}

void Workspace::step() {
  session_->post([](Player& player) { player.step(); });
}

void Workspace::wait_at(double time) {
  session_->post([time](Player& player) { player.wait_at(time); });
}

void Workspace::go_back(int back) {
  session_->post([back](Player& player) { player.go_back(back); });
}

Vec3 Workspace::in_scene(Vec3f shown) const {
  const Vec3& origin = frame_data().origin;
  return {origin[0] + shown.x, origin[1] + shown.y, origin[2] + shown.z};
}

void Workspace::give(const Input& input) {
  session_->post([input](Player& player) { player.hand(input); });
}

void Workspace::export_frame(const std::string& path) {
  start_export(path, {}, 0);  // the last is past: one frame, and the end
}

void Workspace::start_export(const std::string& path, std::optional<std::int64_t> first,
                             std::optional<std::int64_t> last) {
  if (same_file(path, record_)) {
    messages.warn("Not exported: the recording goes to " + printable(path), now_);
    return;
  }
  const std::string until = last ? " up to frame " + std::to_string(*last) : " until you end it";
  if (first || !last) messages.tell("The animation goes to " + full_path(path) + until, now_);
  session_->post([=](Player& player) { player.export_to(path, first, last); });
}

void Workspace::end_export() {
  session_->post([](Player& player) { player.finish_export(); });
}

void Workspace::next_look(int step) {
  const auto count = static_cast<std::ptrdiff_t>(kLooks.size());
  const std::ptrdiff_t at = look - kLooks.data();
  look = &kLooks[std::size_t((at + step + count) % count)];
  messages.tell("Look: " + std::string(look->name), now_);
}

// One change at a time is on its way, so that a slow scene is not flooded: always the newest.
void Workspace::post_change() {
  if (telling_ || document_.revision() == simulated_) return;
  telling_ = true;
  simulated_ = document_.revision();
  session_->post([scene = document_.scene()](Player& player) { player.change(scene); });
}

void Workspace::watch_file() {
  if (now_ < next_watch_) return;
  next_watch_ = now_ + 0.5;
  if (!document_.changed_on_disk()) return;
  if (document_.edited()) {
    messages.warn(document_.path() + " has changed on disk; your changes here are kept", now_);
    return;
  }
  open(document_.path());
}

// What is edited and not saved is written down every other second: nothing is lost with the window.
void Workspace::keep_edits() {
  if (now_ < next_keep_ || document_.revision() == kept_) return;
  next_keep_ = now_ + 2;
  kept_ = document_.revision();
  messages.fault("kept", document_.keep());
}

void Workspace::tell_kept() {
  const std::string path = document_.kept();
  if (!path.empty()) messages.tell("Changes that were not saved are kept in " + path, now_);
}

bool Workspace::refresh(double now) {
  now_ = now;
  messages.forget(now);
  const bool fresh = session_->refresh();
  if (fresh && frame_data().scene_serial != serial_) {
    telling_ = false;
    if (opening_) {
      opening_ = false;
      sight_ = document_.scene().camera;
      show_start();
    } else {
      serial_ = frame_data().scene_serial;
      if (frame_data().frame == 0) take_setting(setting_of(frame_data()));
    }
  }
  const Telemetry& v = telemetry();
  if (v.problems != problems_) {
    problems_ = v.problems;
    telling_ = false;
    messages.warn(v.problem, now_);
  }
  if (v.recorded != recorded_) {
    recorded_ = v.recorded;
    messages.tell("Written: " + full_path(recorded_), now_);
  }
  messages.fault("status", v.status.ok ? "" : "The simulation stopped itself: " + v.status.text);
  post_change();
  watch_file();
  keep_edits();
  return fresh;
}

}  // namespace weft::viewer
