// Checked changes, history, files.
#include "edit/document.h"

#include <algorithm>
#include <cstdlib>

#include "scene/document.h"
#include "scene/schema.h"
#include "weft/output.h"
#include "weft/printable.h"

namespace weft::viewer {

namespace fs = std::filesystem;
using text::Json;

namespace {

constexpr std::size_t kMostStates = 200;

fs::file_time_type time_of(const std::string& path) {
  std::error_code error;
  const fs::file_time_type time = fs::last_write_time(path, error);
  return error ? fs::file_time_type::min() : time;
}

std::string line_of(const Fault& fault) {
  return (fault.place.empty() ? "" : fault.place + ": ") + fault.what +
         (fault.allowed.empty() ? "" : " (" + fault.allowed + ")");
}

}  // namespace

std::string fault_lines(const std::string& file, const std::vector<Fault>& faults) {
  std::string lines;
  for (const Fault& fault : faults)
    lines += (lines.empty() ? "" : "\n") + printable(file) + (fault.place.empty() ? ": " : ":") +
             printable(line_of(fault));
  return lines;
}

Json pin_json(const Cloth& cloth, int particle) {
  if (cloth.mesh.given()) return particle;
  return Json::array({particle % cloth.grid.nx, particle / cloth.grid.nx});
}

Json still_pin_json(const Cloth& cloth, const Pin& pin) {
  if (!pin.of_several()) return pin_json(cloth, particle_number(cloth, pin));
  return {{"vertices", held_particles(cloth, pin)}};
}

Json remaining_pin_json(const Json& pin, const std::vector<int>& held,
                        const std::set<int>& let_go) {
  std::vector<int> left;
  for (const int p : held)
    if (!let_go.contains(p)) left.push_back(p);
  if (left.size() == held.size()) return pin;
  if (left.empty()) return nullptr;
  Json rest = pin;
  for (const char* key : {"group", "box"}) rest.erase(key);
  rest["vertices"] = left;
  return rest;
}

std::vector<Document::Change> changes_between(const Scene& before, const Scene& after) {
  const Json old = text::document_of(before), fresh = text::document_of(after);
  std::vector<Document::Change> changes;
  for (auto it = fresh.begin(); it != fresh.end(); ++it)
    if (old.at(it.key()) != *it) changes.push_back({"/" + it.key(), *it});
  return changes;
}

std::vector<Fault> Document::open(const std::string& path_or_name,
                                  const std::vector<Override>& overrides) {
  SceneFile file = read_scene(path_or_name, overrides);
  if (!file.faults.empty()) {
    if (!path_.empty() && file.path == path_) time_ = time_of(path_);  // told once
    return file.faults;
  }
  path_ = file.path;
  shipped_ = false;
  for (const ShippedScene& shipped : shipped_scenes()) shipped_ = shipped_ || shipped.path == path_;
  scene_ = std::move(file.scene);
  use_full_paths(scene_, fs::path(path_).parent_path().string());
  meshes_ = {};
  meshes_.take(scene_);
  notes_ = std::move(file.notes);
  name_ = scene_.name.empty() ? fs::path(path_).stem().string() : scene_.name;
  json_ = text::document_of(scene_);
  time_ = time_of(path_);
  revision_ = saved_revision_ = ++revisions_;
  history_.clear();
  history_.push_back({json_, "", "", revision_});
  position_ = 0;
  return {};
}

std::string Document::set(const std::vector<Change>& changes, bool joined,
                          const std::string& name) {
  Json next = json_;
  try {
    for (const Change& change : changes) next[Json::json_pointer(change.pointer)] = change.value;
  } catch (const nlohmann::json::exception&) {
    return "the scene has no such value";
  }
  if (next == json_) return "";
  text::Check check;
  text::check(text::scene_schema_json(), next, check);
  if (!check.faults.empty()) return line_of(check.faults.front());
  Scene scene = text::scene_of(next);
  if (const auto faults = read_meshes(scene); !faults.empty()) return line_of(faults.front());
  if (const auto faults = validate(scene); !faults.empty()) return line_of(faults.front());

  const std::string& place = changes.front().pointer;
  history_.resize(position_ + 1);
  const std::string called = name.empty() ? name_of(place) : name;
  const bool join =
      joined && position_ > 0 && history_.back().place == place && history_.back().name == called;
  if (join) history_.pop_back();
  history_.push_back({next, place, called, ++revisions_});
  if (history_.size() > kMostStates) history_.erase(history_.begin());
  position_ = history_.size() - 1;
  json_ = std::move(next);
  scene_ = std::move(scene);
  revision_ = revisions_;
  return "";
}

// "/cloths/0/stiffness/shear" is the cloth's stiffness shear, "/colliders/2/sphere/radius" sphere 2's radius.
std::string Document::name_of(const std::string& pointer) const {
  std::string name;
  const auto add = [&](std::string word) {
    std::replace(word.begin(), word.end(), '_', ' ');
    if (!word.empty()) name += (name.empty() ? "" : " ") + word;
  };
  std::vector<std::string> words;
  for (std::size_t at = 1; at <= pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', at), pointer.size());
    words.push_back(pointer.substr(at, end - at));
    at = end + 1;
  }
  const bool listed = words.size() > 1 && (words[0] == "cloths" || words[0] == "colliders");
  if (!listed) {
    for (const std::string& word : words) add(word);
    return name;
  }
  const bool cloth = words[0] == "cloths";
  const bool only = json_[words[0]].size() == 1;
  std::string kind = cloth ? "cloth" : "body";
  for (const char* shape : kShapeNames)
    if (!cloth && words[1] != "-" &&
        json_[Json::json_pointer("/colliders/" + words[1])].contains(shape))
      kind = shape;
  add(kind);
  if (!only && words[1] != "-") add(words[1]);
  for (std::size_t k = 2; k < words.size(); ++k)
    if (words[k] != kind) add(words[k]);
  return name;
}

void Document::take(std::size_t position) {
  position_ = position;
  json_ = history_[position].json;
  revision_ = history_[position].revision;
  scene_ = text::scene_of(json_);
  read_meshes(scene_);
}

std::vector<Fault> Document::read_meshes(Scene& scene) {
  meshes_.give(scene);
  std::vector<Fault> faults;
  std::vector<std::string> notes;
  load_meshes(scene, fs::path(path_).parent_path().string(), faults, notes);
  meshes_.take(scene);
  return faults;
}

void Document::undo() {
  if (can_undo()) take(position_ - 1);
}

void Document::redo() {
  if (can_redo()) take(position_ + 1);
}

std::string Document::next_undo() const {
  return can_undo() ? history_[position_].name : "";
}

std::string Document::text_for(const std::string& path) const {
  Scene scene = scene_;
  const fs::path folder = fs::absolute(path).parent_path();
  for_each_mesh_file(scene, [&](std::string& file) {
    const fs::path beside = fs::path(file).lexically_relative(folder);
    if (!beside.empty() && *beside.begin() != "..") file = beside.string();
  });
  return write_scene_text(scene);
}

void Document::save(const std::string& path) {
  OutputFile file(path);
  file.write(text_for(path));
  file.commit();
  path_ = path;
  shipped_ = false;
  time_ = time_of(path);
  saved_revision_ = revision_;
}

std::string Document::save_path() const {
  return shipped_ || path_.empty() ? name_ + "-edited.json" : path_;
}

// $XDG_STATE_HOME/weft/NAME.json
std::string Document::keep_path() const {
  const char* state = std::getenv("XDG_STATE_HOME");
  const char* home = std::getenv("HOME");
  if (state == nullptr && home == nullptr) return "";
  const fs::path folder = state != nullptr ? fs::path(state) : fs::path(home) / ".local/state";
  return (folder / "weft" / (name_ + ".json")).string();
}

std::string Document::keep() const {
  const fs::path path = keep_path();
  std::error_code error;
  if (path.empty()) return "";
  if (!edited()) {
    fs::remove(path, error);
    return "";
  }
  fs::create_directories(path.parent_path(), error);
  try {
    OutputFile file(path.string());
    file.write(text_for(path.string()));
    file.commit();
  } catch (const WriteError& failure) {
    return "Unsaved changes cannot be kept: " + printable(failure.path) + ": " + failure.what();
  }
  return "";
}

std::string Document::kept() const {
  std::error_code error;
  const std::string path = keep_path();
  return fs::exists(path, error) ? path : "";
}

bool Document::changed_on_disk() {
  if (path_.empty()) return false;
  const fs::file_time_type now = time_of(path_);
  if (now == time_ || now == fs::file_time_type::min()) return false;
  time_ = now;
  return true;
}

}  // namespace weft::viewer
