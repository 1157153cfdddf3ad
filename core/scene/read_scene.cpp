// Text -> Scene, step by step: parse, override, check each value, read, check what must fit
// together.
#include "weft/read_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "scene/assets.h"
#include "scene/course.h"
#include "scene/document.h"
#include "scene/fabric.h"
#include "scene/mesh/forms.h"
#include "scene/overrides.h"
#include "scene/shipped.h"
#include "scene/validate.h"
#include "weft/mesh.h"

namespace weft {
namespace {

using namespace text;

// Reads a Weft document after overriding it.
Scene read_weft(Json& document, const std::vector<Override>& overrides, Check& result) {
  for (const Override& change : overrides)
    apply_override(scene_schema_json(), change, document, result);
  unfold_fabrics(document, result);
  check(scene_schema_json(), document, result);
  check_forms(document, result);
  drop_unsound(result, document);
  const Scene scene = scene_of(document);
  check_together(scene, result);
  return scene;
}

// Whether an override means the course file's own values rather than the scene that it stands for.
bool in_course(const Override& change) {
  std::vector<std::string> tokens;
  return split_pointer(change.pointer, tokens) && descend(course_schema_json(), nullptr, tokens[0]);
}

// A place below a body's own in the file, as a place of the document with that body alone.
bool within_body(const CourseBody& body, const std::string& place) {
  return place.starts_with(body.place) &&
         (place.size() == body.place.size() || place[body.place.size()] == '/');
}

// Overrides one value of a course file; false where it means a value of the scene.
bool override_course(CourseFile& file, const Override& change, Check& result) {
  for (CourseBody& body : file.more) {
    if (!within_body(body, change.pointer)) continue;
    Check found;
    apply_override(course_schema_json(),
                   {"/" + body.kind + change.pointer.substr(body.place.size()), change.value},
                   body.document, found);
    for (const Fault& fault : found.faults) result.fault(change.pointer, fault.what, fault.allowed);
    return true;
  }
  if (!in_course(change)) return false;
  apply_override(course_schema_json(), change, file.document, result);
  return true;
}

// All that the schema has against a course file, at the file's places; drops what cannot be relied on.
void check_course(CourseFile& file, Check& result) {
  check(course_schema_json(), file.document, result);
  drop_unsound(result, file.document);
  for (CourseBody& body : file.more) {
    Check found;
    check(course_schema_json(), body.document, found);
    drop_unsound(found, body.document);
    const auto place = [&](const std::string& in_document) {
      return body.place + in_document.substr(1 + body.kind.size());
    };
    for (const Fault& fault : found.faults)
      result.fault(place(fault.place), fault.what, fault.allowed);
    for (const std::string& unsound : found.unsound) result.unsound.push_back(place(unsound));
  }
}

Scene read_course(CourseFile& file, const std::vector<Override>& overrides, Check& result) {
  std::vector<Override> of_scene;
  for (const Override& change : overrides)
    if (!override_course(file, change, result)) of_scene.push_back(change);
  Check course = std::move(result);
  check_course(file, course);
  const Scene scene = scene_of_course(file);
  const CoursePlaces places(file);
  if (places.repeated_pins() > 0)
    file.notes.push_back("/cloth/pinned has " + std::to_string(places.repeated_pins()) +
                         (places.repeated_pins() == 1 ? " pin" : " pins") +
                         " that it had before; each particle is held once");

  Check together;  // in places of the scene
  for (const std::string& place : course.unsound)
    together.unsound.push_back(places.in_scene(place));
  check_together(scene, together);
  for (Fault& fault : together.faults)
    course.fault(places.in_file(fault.place), fault.what, fault.allowed);
  result = std::move(course);
  if (of_scene.empty()) return scene;
  Json meant = document_of(scene);
  for (Json& cloth : meant["cloths"]) cloth.erase("mesh");  // grids, unless an override says else
  if (!result.faults.empty()) {  // then only what is wrong with the overrides themselves
    for (const Override& change : of_scene)
      apply_override(scene_schema_json(), change, meant, result);
    return scene;
  }
  return read_weft(meant, of_scene, result);
}

bool is_neither(const Json& document) {
  return !document.is_object() || (!document.contains("weft") && !document.contains("cloths"));
}

std::string nearest_scene(const std::string& name) {
  std::vector<std::string> names;
  for (const ShippedScene& scene : shipped_scenes()) names.push_back(scene.name);
  const std::string near = nearest(names, name);
  return near.empty() ? "a path" : "a path, or a shipped scene; the nearest is \"" + near + "\"";
}

bool has_mesh(const Scene& scene) {
  bool any = false;
  for_each_mesh(scene, [&](const MeshSource&, const std::string&) { any = true; });
  return any;
}

// The file's bytes, up to one more than any scene may have.
bool read_bytes(const std::string& path, std::string& bytes) {
  std::ifstream file(path, std::ios::binary);
  std::error_code unknown;  // of a pipe, say
  const std::uintmax_t size = std::filesystem::file_size(path, unknown);
  if (!unknown) bytes.reserve(std::size_t(std::min<std::uintmax_t>(size, kMaxTextBytes + 1)));
  char block[1 << 16];
  while (file && bytes.size() <= kMaxTextBytes) {
    file.read(block, std::streamsize(std::min(sizeof block, kMaxTextBytes + 1 - bytes.size())));
    bytes.append(block, static_cast<std::size_t>(file.gcount()));
  }
  return !file.bad() && (file.eof() || bytes.size() > kMaxTextBytes);
}

}  // namespace

SceneFile read_scene_text(std::string_view json, const std::vector<Override>& overrides) {
  SceneFile file;
  Json document = parse(json, file.faults);
  if (!file.faults.empty()) return file;
  Check result;
  if (is_course(document)) {
    CourseFile course = take_apart(std::move(document));
    file.scene = read_course(course, overrides, result);
    file.notes = std::move(course.notes);
    release(course.document);
  } else if (is_neither(document)) {
    result.fault("",
                 document.is_object() ? "this is neither a Weft scene nor a course scene"
                                      : "the scene is " + brief(document),
                 "an object with \"weft\": 1 and cloths, or with cloth, sphere and plane");
  } else {
    file.scene = read_weft(document, overrides, result);
  }
  release(document);
  file.faults = std::move(result.faults);
  return file;
}

SceneFile read_scene(const std::string& path_or_name, const std::vector<Override>& overrides) {
  const bool path_like = path_or_name.find_first_of("/.") != std::string::npos;
  std::string path = path_like ? "" : shipped_path(path_or_name);
  if (path.empty()) path = path_or_name;
  SceneFile file;
  std::error_code error;
  std::string bytes;
  if (path.empty() || !std::filesystem::exists(path, error)) {
    file.found = false;
    file.faults.push_back({"", "there is no such scene", nearest_scene(path_or_name)});
  } else if (std::filesystem::is_directory(path, error)) {
    file.faults.push_back({"", "this is a folder", "a scene file"});
  } else if (!read_bytes(path, bytes)) {
    file.faults.push_back({"", "the file cannot be read", "a readable file"});
  } else {
    file = read_scene_text(bytes, overrides);
    if (file.faults.empty()) {
      load_meshes(file.scene, std::filesystem::path(path).parent_path().string(), file.faults,
                  file.notes);
      if (file.faults.empty() && has_mesh(file.scene)) file.faults = validate(file.scene);
    }
    if (file.scene.name.empty()) file.scene.name = std::filesystem::path(path).stem().string();
  }
  file.path = path;
  return file;
}

std::string write_scene_text(const Scene& scene) {
  Json document = document_of(scene);
  drop_defaults(scene_schema_json(), document);
  return print(document);
}

std::string_view scene_schema() {
  return kSceneSchema;
}

}  // namespace weft
