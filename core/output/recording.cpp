// Recordings: one JSON object a line (weft/recording.h).
#include "weft/recording.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "output/hex.h"
#include "weft/read_scene.h"

namespace weft {

namespace {

using Json = nlohmann::ordered_json;
using Kind = Input::Kind;

constexpr std::array<const char*, 8> kNames{"grab",  "release", "pin",           "unpin",
                                            "carry", "cut",     "move_collider", "set_scene"};

Json scene_json(const Scene& scene) {
  return Json::parse(write_scene_text(scene));
}

Scene scene_of(const Json& json) {
  SceneFile file = read_scene_text(json.dump());
  if (!file.faults.empty())
    throw RecordingError("scene" + file.faults[0].place + ": " + file.faults[0].what);
  return std::move(file.scene);
}

Json input_json(const Input& input) {
  switch (input.kind) {
    case Kind::grab:
      return {{"particle", {input.cloth, input.i, input.j}},
              {"target", input.a},
              {"stiffness", input.amount}};
    case Kind::pin:
    case Kind::unpin:
      return {{"particle", {input.cloth, input.i, input.j}}};
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

Input input_of(Kind kind, const Json& json) {
  Input input;
  input.kind = kind;
  if (kind == Kind::grab || kind == Kind::pin || kind == Kind::unpin) {
    const auto particle = json.at("particle").get<std::array<int, 3>>();
    input.cloth = particle[0], input.i = particle[1], input.j = particle[2];
  }
  if (kind == Kind::grab) {
    input.a = json.at("target").get<Vec3>();
    input.amount = json.at("stiffness").get<double>();
  } else if (kind == Kind::carry) {
    input.cloth = json.at("cloth").get<int>();
    input.a = json.at("velocity").get<Vec3>();
  } else if (kind == Kind::cut) {
    input.a = json.at("from").get<Vec3>();
    input.b = json.at("to").get<Vec3>();
    input.amount = json.at("width").get<double>();
  } else if (kind == Kind::move_collider) {
    input.collider = json.at("collider").get<int>();
    input.a = json.at("target").get<Vec3>();
  } else if (kind == Kind::set_scene) {
    input.scene = std::make_shared<const Scene>(scene_of(json));
  }
  return input;
}

Recording::Event event_of(const Json& json) {
  Recording::Event event;
  event.frame = json.at("frame").get<std::int64_t>();
  if (const auto hash = json.find("hash"); hash != json.end()) {
    const auto& text = hash->get_ref<const std::string&>();
    const std::optional<std::uint64_t> value = from_hex16(text);
    if (!value) throw RecordingError("\"" + text + "\" is no hash (16 hexadecimal digits)");
    event.hash = *value;
    return event;
  }
  for (std::size_t k = 0; k < kNames.size(); ++k)
    if (const auto input = json.find(kNames[k]); input != json.end())
      event.input = input_of(static_cast<Kind>(k), *input);
  if (!event.input) throw RecordingError("an input of no known kind");
  return event;
}

void read_header(const Json& json, Recording& recording) {
  if (!json.contains("weft_recording") || json.at("weft_recording") != 1)
    throw RecordingError("not a recording of version 1");
  recording.seed = json.at("seed").get<std::uint64_t>();
  recording.scene = scene_of(json.at("scene"));
}

}  // namespace

void apply(const Input& input, Simulation& simulation) {
  switch (input.kind) {
    case Kind::grab:
      simulation.grab(input.cloth, input.i, input.j, input.a, input.amount);
      break;
    case Kind::release:
      simulation.release();
      break;
    case Kind::pin:
      simulation.pin(input.cloth, input.i, input.j);
      break;
    case Kind::unpin:
      simulation.unpin(input.cloth, input.i, input.j);
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
  const Json header{{"weft_recording", 1},
                    {"seed", simulation.options().seed},
                    {"scene", scene_json(simulation.scene())}};
  file_.write(header.dump() + "\n");
}

void Recorder::input(std::int64_t frame, const Input& input) {
  const Json line{{"frame", frame},
                  {kNames[static_cast<std::size_t>(input.kind)], input_json(input)}};
  file_.write(line.dump() + "\n");
}

void Recorder::frame(const Simulation& simulation) {
  file_.write(Json{{"frame", simulation.frame()}, {"hash", hex16(simulation.hash())}}.dump() +
              "\n");
}

void Recorder::finish() {
  file_.complete();
  file_.commit();
}

Recording read_recording(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw RecordingError(path + ": cannot be read");
  Recording recording;
  std::string line;
  for (std::int64_t number = 1; std::getline(in, line); ++number) {
    try {
      const Json json = Json::parse(line);
      if (number == 1) {
        read_header(json, recording);
        continue;
      }
      recording.events.push_back(event_of(json));
    } catch (const std::exception& error) {
      throw RecordingError(path + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  if (recording.scene.cloths.empty()) throw RecordingError(path + ": not a recording");
  return recording;
}

std::int64_t Recording::frames() const {
  return std::count_if(events.begin(), events.end(), [](const Event& e) { return !e.input; });
}

std::string difference(const Scene& a, const Scene& b) {
  const Json difference = Json::diff(scene_json(a), scene_json(b));
  return difference.empty() ? "" : difference[0]["path"].get<std::string>();
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
  if (event.frame == simulation.frame() && event.hash == simulation.hash()) return;
  throw RecordingError("frame " + std::to_string(simulation.frame()) + " has the hash " +
                       hex16(simulation.hash()) + ", the recording has " + hex16(event.hash));
}

}  // namespace weft
