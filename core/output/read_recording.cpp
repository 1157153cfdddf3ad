// A recording as it is read: nothing in the file is trusted, and each fault has its line and place.
#include <array>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <optional>

#include "output/hex.h"
#include "output/input_names.h"
#include "scene/base64.h"
#include "scene/json_text.h"
#include "weft/mesh.h"
#include "weft/point_cache.h"
#include "weft/read_scene.h"
#include "weft/recording.h"

namespace weft {

namespace {

using text::Json;
using Kind = Input::Kind;

// What is wrong in a line, and where in it.
[[noreturn]] void fail(const std::string& place, const std::string& what,
                       const std::string& allowed) {
  throw RecordingError(place + (place.empty() ? "" : ": ") + what + " (" + allowed + ")");
}

// A value in a line, with its place in it.
struct Value {
  const Json* json;
  std::string place;

  Value at(const std::string& key) const {
    if (!json->is_object()) fail(place, text::brief(*json) + " is out of place", "an object");
    const Json* const found = text::member(*json, key);
    if (found == nullptr) fail(place, "\"" + key + "\" is missing", "every key of a recording");
    return {found, text::join(place, key)};
  }
  Value at(std::size_t n) const { return {&(*json)[n], text::join(place, std::to_string(n))}; }

  template <class T>
  T whole(T most = std::numeric_limits<T>::max()) const {
    if (!json->is_number_unsigned() ||
        json->get<std::uint64_t>() > static_cast<std::uint64_t>(most))
      fail(place, text::brief(*json) + " is out of place",
           "a whole number from 0 to " + std::to_string(most));
    return json->get<T>();
  }
  double number() const {
    if (!json->is_number()) fail(place, text::brief(*json) + " is out of place", "a number");
    return json->get<double>();
  }
  void need_list(std::size_t size) const {
    if (!json->is_array() || json->size() != size)
      fail(place, text::brief(*json) + " is out of place",
           "a list of " + std::to_string(size) + " numbers");
  }
  Vec3 vector() const {
    need_list(3);
    return {at(0).number(), at(1).number(), at(2).number()};
  }
  std::uint64_t hash() const {
    const auto value = json->is_string() ? from_hex16(json->get_ref<const std::string&>())
                                         : std::optional<std::uint64_t>();
    if (!value) fail(place, text::brief(*json) + " is no hash", "16 hexadecimal digits");
    return *value;
  }
};

// What a line is read with: the file's version, and the scene that runs when it comes.
struct Context {
  int version;
  const Scene* scene;
  MeshStore meshes;  // of the lines so far
};

[[noreturn]] void fail(const std::string& place, const Fault& fault) {
  fail(place + fault.place, fault.what, fault.allowed);
}

// Calls visit(place, file, text) for what a line carries under a key.
template <class Visit>
void for_each_text(const Value& line, const char* key, Visit&& visit) {
  if (text::member(*line.json, key) == nullptr) return;
  const Value carried = line.at(key);
  if (!carried.json->is_object())
    fail(carried.place, text::brief(*carried.json) + " is out of place", "an object");
  for (const auto& [file, text] : carried.json->items()) {
    const std::string place = text::join(carried.place, file);
    if (!text.is_string()) fail(place, text::brief(text) + " is out of place", "text of a file");
    visit(place, file, text.template get_ref<const std::string&>());
  }
}

// The meshes that a line carries, and the animations.
void read_meshes(const Value& line, MeshStore& meshes) {
  for_each_text(line, "meshes",
                [&](const std::string& place, const std::string& file, const std::string& text) {
                  MeshFile read = read_obj(text, file);
                  if (!read.faults.empty())
                    fail(place, read.faults[0].what, read.faults[0].allowed);
                  meshes.shapes[file] = std::make_shared<const TriangleMesh>(std::move(read.mesh));
                });
  for_each_text(line, "animations",
                [&](const std::string& place, const std::string& file, const std::string& text) {
                  const std::optional<std::string> bytes = from_base64(text);
                  if (!bytes) fail(place, "the text is no base64", "the bytes of an .mdd file");
                  PointCacheFile read = parse_point_cache(*bytes, "carried.mdd", kAnyPoints);
                  if (!read.cache) fail(place, read.faults[0].what, read.faults[0].allowed);
                  PointCache cache = *read.cache;
                  cache.in_frames = file.ends_with(".pc2");
                  meshes.motions[file] = std::make_shared<const PointCache>(std::move(cache));
                });
}

// A scene with its meshes, which its line or one before carries.
Scene scene_of(const Value& value, const MeshStore& meshes) {
  if (!value.json->is_object())
    fail(value.place, text::brief(*value.json) + " is out of place", "a scene");
  SceneFile file = read_scene_text(value.json->dump());
  if (!file.faults.empty()) fail(value.place, file.faults[0]);
  meshes.give(file.scene);
  bool any = false;
  for_each_mesh(file.scene, [&](const MeshSource& mesh, const std::string& place) {
    if (!mesh.shape)
      fail(value.place + place_of_file(place), "the mesh is missing",
           "a file in meshes, of this line or one before");
    any = true;
  });
  for (std::size_t n = 0; n < file.scene.colliders.size(); ++n) {
    const Collider& collider = file.scene.colliders[n];
    const MeshBody* body = std::get_if<MeshBody>(&collider.shape);
    if (body && !body->motion && !collider.animation.empty())
      fail(value.place + "/colliders/" + std::to_string(n) + "/animation",
           "the animation is missing", "a file in animations, of this line or one before");
  }
  load_meshes(file.scene, "", file.faults, file.notes);
  if (any)
    if (const auto faults = validate(file.scene); !faults.empty()) fail(value.place, faults[0]);
  return std::move(file.scene);
}

// Version 1 names the particles of grids by column and row.
void read_particle(const Value& value, const Context& context, Input& input) {
  if (context.version > 1) {
    value.need_list(2);
    input.cloth = value.at(0).whole<int>();
    input.particle = value.at(1).whole<int>();
    return;
  }
  value.need_list(3);
  const std::size_t cloths = context.scene->cloths.size();
  input.cloth = value.at(0).whole<int>(static_cast<int>(cloths) - 1);
  const Grid& grid = context.scene->cloths[static_cast<std::size_t>(input.cloth)].grid;
  input.particle = particle_number(grid, value.at(1).whole<int>(grid.nx - 1),
                                   value.at(2).whole<int>(grid.ny - 1));
}

Input input_of(Kind kind, const Value& value, const Context& context) {
  Input input;
  input.kind = kind;
  if (kind == Kind::grab || kind == Kind::pin || kind == Kind::unpin)
    read_particle(value.at("particle"), context, input);
  if (kind == Kind::grab) {
    input.a = value.at("target").vector();
    input.amount = value.at("stiffness").number();
  } else if (kind == Kind::carry) {
    input.cloth = value.at("cloth").whole<int>();
    input.a = value.at("velocity").vector();
  } else if (kind == Kind::cut) {
    input.a = value.at("from").vector();
    input.b = value.at("to").vector();
    input.amount = value.at("width").number();
  } else if (kind == Kind::move_collider) {
    input.collider = value.at("collider").whole<int>();
    input.a = value.at("target").vector();
  } else if (kind == Kind::set_scene) {
    input.scene = std::make_shared<const Scene>(scene_of(value, context.meshes));
  }
  return input;
}

Recording::Event event_of(const Value& line, const Context& context) {
  Recording::Event event;
  event.frame = line.at("frame").whole<std::int64_t>();
  if (text::member(*line.json, "hash") != nullptr) {
    event.hash = line.at("hash").hash();
    return event;
  }
  for (std::size_t k = 0; k < kInputNames.size(); ++k)
    if (text::member(*line.json, kInputNames[k]) != nullptr)
      event.input = input_of(static_cast<Kind>(k), line.at(kInputNames[k]), context);
  if (!event.input) fail("", "it has neither a hash nor an input", "hash, grab, release, pin, …");
  return event;
}

// Frames come one after the other. After another scene they go on from any number: it may begin anew, or
// have frames of another length, in which the time so far is counted.
class Order {
 public:
  void check(const Recording::Event& event) {
    const bool is_hash = !event.input;
    const std::int64_t before = event.frame - (is_hash ? 1 : 0);
    if (anew_ && before >= 0) done_ = before;
    if (before != done_)
      fail("/frame", std::to_string(event.frame) + " is out of order: lines are missing or doubled",
           std::to_string(done_ + (is_hash ? 1 : 0)) + " comes here");
    anew_ = event.input && (anew_ || event.input->kind == Kind::set_scene);
    if (is_hash) ++done_;
  }

 private:
  std::int64_t done_ = 0;
  bool anew_ = false;
};

constexpr int kNewestVersion = 2;

// Returns the version.
int read_header(const Value& line, Context& context, Recording& recording) {
  const bool known =
      line.json->is_object() && text::member(*line.json, "weft_recording") != nullptr;
  const int version = known ? line.at("weft_recording").whole<int>() : 0;
  if (version < 1 || version > kNewestVersion)
    fail("", "this is no recording", "weft_recording 1 or " + std::to_string(kNewestVersion));
  recording.seed = line.at("seed").whole<std::uint64_t>();
  read_meshes(line, context.meshes);
  recording.scene = scene_of(line.at("scene"), context.meshes);
  return version;
}

Json parsed(const std::string& line) {
  std::vector<Fault> faults;
  Json json = text::parse(line, faults);
  if (faults.empty()) return json;
  std::string what = faults[0].what;
  constexpr std::string_view kLine = "line 1, ";  // of a text of its own, to the parser
  if (what.starts_with(kLine)) what.erase(0, kLine.size());
  fail(faults[0].place, what, faults[0].allowed);
}

// The next line; of one longer than any recording's, only so much that it is known to be.
bool next_line(std::istream& in, std::string& line) {
  std::array<char, 1 << 16> some{};
  for (line.clear(); line.size() <= text::kMaxTextBytes; in.clear()) {
    in.getline(some.data(), some.size());
    if (in.bad() || in.gcount() == 0) return !line.empty();
    const bool ended = in.good();
    line.append(some.data(), static_cast<std::size_t>(in.gcount() - (ended ? 1 : 0)));
    if (ended || in.eof()) return true;
  }
  return true;
}

}  // namespace

Recording read_recording(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw RecordingError(path + ": cannot be read");
  Recording recording;
  std::string text;
  std::int64_t number = 0;
  Order order;
  Context context{0, &recording.scene, {}};
  while (next_line(in, text)) {
    ++number;
    try {
      const Json json = parsed(text);
      const Value line{&json, ""};
      if (number == 1) {
        context.version = read_header(line, context, recording);
        continue;
      }
      read_meshes(line, context.meshes);
      recording.events.push_back(event_of(line, context));
      const Recording::Event& event = recording.events.back();
      order.check(event);
      if (event.input && event.input->scene) context.scene = event.input->scene.get();
    } catch (const RecordingError& error) {
      throw RecordingError(path + ":" + std::to_string(number) + ": " + error.what());
    }
  }
  if (number == 0) throw RecordingError(path + ": it is empty or no file");
  return recording;
}

}  // namespace weft
