// Recordings as they are written and replayed (weft/recording.h).
#include "weft/recording.h"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>

#include "output/hex.h"
#include "output/input_names.h"
#include "scene/base64.h"
#include "scene/json_text.h"
#include "weft/mesh.h"
#include "weft/point_cache.h"
#include "weft/read_scene.h"

namespace weft {

namespace {

using Json = nlohmann::ordered_json;
using Kind = Input::Kind;

// What a group of a mesh holds is told by number: recorded meshes have no groups.
Json scene_json(Scene scene) {
  for (Cloth& cloth : scene.cloths)
    for (Pin& pin : cloth.pins)
      if (pin.group) {
        pin.vertices = held_particles(cloth, pin);
        pin.group.reset();
      }
  return Json::parse(write_scene_text(scene));
}

Json input_json(const Input& input) {
  switch (input.kind) {
    case Kind::grab:
      return {{"particle", {input.cloth, input.particle}},
              {"target", input.a},
              {"stiffness", input.amount}};
    case Kind::pin:
    case Kind::unpin:
      return {{"particle", {input.cloth, input.particle}}};
    case Kind::carry:
      return {{"cloth", input.cloth}, {"velocity", input.a}};
    case Kind::cut:
      return {{"from", input.a}, {"to", input.b}, {"width", input.amount}};
    case Kind::move_collider:
      return {{"collider", input.collider}, {"target", input.a}};
    case Kind::set_scene:
      return scene_json(*input.scene);
    case Kind::release:
      break;
  }
  return Json::object();
}

// Meshes by the names of their files alone.
Scene without_folders(Scene scene) {
  for_each_mesh_file(
      scene, [](std::string& file) { file = std::filesystem::path(file).filename().string(); });
  return scene;
}

bool same_shape(const MeshSource& a, const MeshSource& b) {
  if (!a.shape || !b.shape) return true;  // not read
  return a.shape->vertices == b.shape->vertices && a.shape->triangles == b.shape->triangles;
}

bool same_motion(const Collider& a, const Collider& b) {
  const auto *one = std::get_if<MeshBody>(&a.shape), *two = std::get_if<MeshBody>(&b.shape);
  if (!one || !two || !one->motion || !two->motion) return true;
  return one->motion->times == two->motion->times && one->motion->places == two->motion->places;
}

}  // namespace

void apply(const Input& input, Simulation& simulation) {
  switch (input.kind) {
    case Kind::grab:
      simulation.grab(input.cloth, input.particle, input.a, input.amount);
      break;
    case Kind::release:
      simulation.release();
      break;
    case Kind::pin:
      simulation.pin(input.cloth, input.particle);
      break;
    case Kind::unpin:
      simulation.unpin(input.cloth, input.particle);
      break;
    case Kind::carry:
      simulation.carry(input.cloth, input.a);
      break;
    case Kind::cut:
      simulation.cut(input.a, input.b, input.amount);
      break;
    case Kind::move_collider:
      simulation.move_collider(input.collider, input.a);
      break;
    case Kind::set_scene:
      simulation.set_scene(*input.scene);
      break;
  }
}

Recorder::Recorder(const std::string& path, const Simulation& simulation) : file_(path) {
  Json header{{"weft_recording", 2}, {"seed", simulation.options().seed}};
  if (Json meshes = new_meshes(simulation.scene()); !meshes.empty()) header["meshes"] = meshes;
  if (Json all = new_animations(simulation.scene()); !all.empty()) header["animations"] = all;
  header["scene"] = scene_json(simulation.scene());
  file_.write(header.dump() + "\n");
}

void Recorder::input(std::int64_t frame, const Input& input) {
  Json line{{"frame", frame}};
  if (input.scene) {
    if (Json meshes = new_meshes(*input.scene); !meshes.empty()) line["meshes"] = meshes;
    if (Json all = new_animations(*input.scene); !all.empty()) line["animations"] = all;
  }
  line[kInputNames[static_cast<std::size_t>(input.kind)]] = input_json(input);
  file_.write(line.dump() + "\n");
}

// Texts by file, of the scene's meshes that no line has yet.
Recorder::Texts Recorder::new_meshes(const Scene& scene) {
  Texts texts;
  for_each_mesh(scene, [&](const MeshSource& mesh, const std::string&) {
    const auto& [file, shape] = std::tie(mesh.file, mesh.shape);
    if (meshes_[file] == shape) return;
    if (file.empty()) throw WriteError(path(), "a mesh that is of no file is not recorded");
    meshes_[file] = shape;
    texts[file] = write_obj(*shape);
    if (texts[file].size() > text::kMaxTextBytes / 2)
      throw WriteError(path(), file + ": the mesh is too large for a recording (32 MiB of text)");
  });
  return texts;
}

// The same of animations.
Recorder::Texts Recorder::new_animations(const Scene& scene) {
  Texts texts;
  for (const Collider& collider : scene.colliders) {
    const MeshBody* body = std::get_if<MeshBody>(&collider.shape);
    const std::string& file = collider.animation;
    if (!body || !body->motion || animations_[file] == body->motion) continue;
    if (file.empty()) throw WriteError(path(), "an animation that is of no file is not recorded");
    animations_[file] = body->motion;
    texts[file] = base64(mdd_bytes(*body->motion));
    if (texts[file].size() > text::kMaxTextBytes / 2)
      throw WriteError(path(), file + ": the animation is too large for a recording (24 MiB)");
  }
  return texts;
}

void Recorder::frame(const Simulation& simulation) {
  if (!simulation.status().ok) return;  // it has stopped itself: this frame is none
  file_.write(Json{{"frame", simulation.frame()}, {"hash", hex16(simulation.hash())}}.dump() +
              "\n");
}

void Recorder::finish() {
  file_.complete();
  file_.commit();
}

std::int64_t Recording::frames() const {
  return std::count_if(events.begin(), events.end(), [](const Event& e) { return !e.input; });
}

std::string difference(const Scene& a, const Scene& b) {
  const Json difference =
      Json::diff(scene_json(without_folders(a)), scene_json(without_folders(b)));
  if (!difference.empty()) return difference[0]["path"].get<std::string>();
  // The same places have meshes in both.
  std::vector<const MeshSource*> of_a;
  for_each_mesh(a, [&](const MeshSource& mesh, const std::string&) { of_a.push_back(&mesh); });
  std::string place;
  std::size_t n = 0;
  for_each_mesh(b, [&](const MeshSource& mesh, const std::string& here) {
    if (!same_shape(*of_a[n++], mesh) && place.empty()) place = place_of_file(here);
  });
  for (n = 0; n < a.colliders.size() && place.empty(); ++n)
    if (!same_motion(a.colliders[n], b.colliders[n]))
      place = "/colliders/" + std::to_string(n) + "/animation";
  return place;
}

const Input* next_input(const Recording& recording, std::size_t& next,
                        const Simulation& simulation) {
  if (next >= recording.events.size() || !recording.events[next].input) return nullptr;
  const Recording::Event& event = recording.events[next++];
  if (event.frame != simulation.frame())
    throw RecordingError("the recording has an input at frame " + std::to_string(event.frame) +
                         ", the replay is at frame " + std::to_string(simulation.frame()));
  return &*event.input;
}

void compare_hash(const Recording& recording, std::size_t& next, const Simulation& simulation) {
  if (next >= recording.events.size()) return;
  const Recording::Event& event = recording.events[next++];
  if (event.input || event.frame != simulation.frame())
    throw RecordingError("frame " + std::to_string(simulation.frame()) + " is done, " +
                         (event.input ? "an input before frame " : "frame ") +
                         std::to_string(event.frame + (event.input ? 1 : 0)) +
                         " is next in the recording");
  if (event.hash == simulation.hash()) return;
  throw RecordingError("frame " + std::to_string(simulation.frame()) + " differs: its hash is " +
                       hex16(simulation.hash()) + ", in the recording " + hex16(event.hash) +
                       "; another version of Weft made it, or it was edited: record it anew");
}

}  // namespace weft
