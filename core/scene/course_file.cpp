#include "scene/course_file.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "scene/schema.h"

namespace weft::text {
namespace {

constexpr std::array<const char*, 2> kBodies{"sphere", "plane"};
constexpr std::size_t kMostNotes = 20;

// Whether a key is a body's name, in the plural or with a number: "spheres", "sphere0", "sphere_12".
bool names_more(std::string_view key, std::string_view body) {
  if (!key.starts_with(body)) return false;
  key.remove_prefix(body.size());
  if (key == "s") return true;
  if (!key.empty() && (key[0] == '_' || key[0] == '-' || key[0] == ' ')) key.remove_prefix(1);
  return !key.empty() &&
         std::all_of(key.begin(), key.end(), [](char c) { return '0' <= c && c <= '9'; });
}

// Whether an unknown key is a known one that is missing, misspelt or by another name: then it is a fault,
// since a default would take its place in silence.
bool stands_for_missing(const Json& object, const Json& schema, const std::string& key) {
  constexpr std::size_t kMostEdits = 2;
  if (key == "center" || key == "centre")
    return descend(schema, nullptr, "origin") && !object.contains("origin");
  for (const std::string& known : keys_of(schema))
    if (!object.contains(known) &&
        edit_distance(key, known) <= std::min(kMostEdits, known.size() / 2))
      return true;
  return false;
}

class TakeApart {
 public:
  explicit TakeApart(Json document) { file_.document = std::move(document); }

  CourseFile run() {
    for (const char* body : kBodies) take_more(body);
    for (const char* key : {"cloth", "sphere", "plane"})
      if (file_.document.contains(key)) ignore_unknown(file_.document[key], key, join("", key));
    for (CourseBody& body : file_.more)
      ignore_unknown(body.document[body.kind], body.kind.c_str(), body.place);
    return std::move(file_);
  }

 private:
  // Lists, plurals and numbered keys of a body; one alone takes the body's own place.
  void take_more(const std::string& body) {
    std::vector<std::string> keys;
    for (auto it = file_.document.begin(); it != file_.document.end(); ++it)
      if ((it.key() == body && it->is_array()) || names_more(it.key(), body))
        keys.push_back(it.key());
    for (const std::string& key : keys) {
      Json value = std::move(file_.document[key]);
      file_.document.erase(key);
      const std::string place = join("", key);
      if (!value.is_array()) {
        add(body, place, std::move(value));
        continue;
      }
      for (std::size_t k = 0; k < value.size() && file_.more.size() < kMostBodies; ++k)
        add(body, join(place, std::to_string(k)), std::move(value[k]));
    }
  }

  void add(const std::string& body, const std::string& place, Json value) {
    Json document = Json::object();
    document["cloth"] = Json::object();
    document[body] = std::move(value);
    file_.more.push_back({body, place, std::move(document)});
  }

  void ignore_unknown(Json& object, const char* kind, const std::string& place) {
    if (!object.is_object()) return;
    const Json& schema = course_schema_json()["properties"][kind];
    std::vector<std::string> ignored;
    for (auto it = object.begin(); it != object.end(); ++it)
      if (!descend(schema, nullptr, it.key()) && !stands_for_missing(object, schema, it.key()))
        ignored.push_back(it.key());
    for (const std::string& key : ignored) {
      release(object[key]);
      object.erase(key);
      note(join(place, key) + " is ignored: the course knows no such key");
    }
  }

  void note(std::string text) {
    if (file_.notes.size() < kMostNotes)
      file_.notes.push_back(std::move(text));
    else if (file_.notes.size() == kMostNotes)
      file_.notes.push_back("… and more that is ignored");
  }

  static constexpr std::size_t kMostBodies = 1001;  // one more than a scene takes, which is told
  CourseFile file_;
};

}  // namespace

CourseFile take_apart(Json document) {
  return TakeApart(std::move(document)).run();
}

std::vector<std::size_t> first_pins(const Json& document) {
  std::vector<std::size_t> first;
  const Json* cloth = member(document, "cloth");
  const Json* pinned = cloth ? member(*cloth, "pinned") : nullptr;
  if (!pinned || !pinned->is_array()) return first;
  std::set<std::pair<double, double>> held;
  for (std::size_t k = 0; k < pinned->size(); ++k) {
    const Json& pin = (*pinned)[k];
    const bool sound =
        pin.is_array() && pin.size() == 2 && pin[0].is_number() && pin[1].is_number();
    if (!sound || held.insert({pin[0].get<double>(), pin[1].get<double>()}).second)
      first.push_back(k);
  }
  return first;
}

}  // namespace weft::text
