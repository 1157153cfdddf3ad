#include "minimise.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "random_mesh.h"
#include "weft/read_scene.h"

namespace fuzz {

namespace {

constexpr std::size_t kLongList = 6;

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;

// Every place of a document, the outermost first and later list items before earlier ones, so that
// indices of what is left hold.
void list_places(const Json& value, const Pointer& here, std::vector<Pointer>& places) {
  if (!here.empty()) places.push_back(here);
  if (value.is_object())
    for (const auto& [key, member] : value.items()) list_places(member, here / key, places);
  if (value.is_array())
    for (std::size_t n = value.size(); n-- > 0;) list_places(value[n], here / n, places);
}

// The number with one digit.
double rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.0e", value);
  return std::strtod(text, nullptr);
}

// What may be put in the place of a number, the simplest first.
std::vector<Json> simpler(const Json& value) {
  std::vector<Json> all;
  if (value.is_number_integer()) {
    const auto n = value.get<std::int64_t>();
    for (const std::int64_t m : {std::int64_t{0}, std::int64_t{1}, std::int64_t{2}, n / 2, n - 1})
      if (std::abs(m) < std::abs(n)) all.push_back(m);
  } else if (value.is_number()) {
    const double v = value.get<double>();
    if (v != 0) all = {0, 1};
    if (rounded(v) != v) all.push_back(rounded(v));
  }
  return all;
}

class Minimiser {
 public:
  Minimiser(const Case& c, const Trial& trial, const std::function<void(const Case&)>& tell)
      : best_(c), trial_(trial), tell_(tell), kind_(kind_of(trial(c))) {}

  Case run() {
    if (kind_ == "ok") return best_;
    Case still = best_;
    still.inputs = Inputs::none;
    still.speed = 0;
    keep(still);
    halve_lists();
    while (pass()) {
    }
    return best_;
  }

 private:
  bool keep(const Case& c) {
    if (kind_of(trial_(c)) != kind_) return false;
    best_ = c;
    tell_(best_);
    return true;
  }

  bool keep(const Json& document) {
    weft::SceneFile file = weft::read_scene_text(document.dump());
    if (!file.faults.empty() || file.scene == best_.scene) return false;
    adopt_meshes(file.scene, best_.scene);
    if (!weft::validate(file.scene).empty()) return false;
    Case c = best_;
    c.scene = file.scene;
    return keep(c);
  }

  Json document() const { return Json::parse(weft::write_scene_text(best_.scene)); }

  // Leaves halves of long lists out, so that single values are few.
  void halve_lists() {
    std::vector<Pointer> places;
    list_places(document(), Pointer(), places);
    for (const Pointer& place : places) {
      bool smaller = true;
      while (std::exchange(smaller, false) && document().contains(place)) {
        Json changed = document();
        Json& list = changed[place];
        if (!list.is_array() || list.size() < kLongList) break;
        const auto middle = list.begin() + std::ptrdiff_t(list.size() / 2);
        const Json late(std::vector<Json>(middle, list.end()));
        list.erase(middle, list.end());
        smaller = keep(changed);
        if (smaller) continue;
        changed[place] = late;
        smaller = keep(changed);
      }
    }
  }

  // Tries every place once; tells whether anything was left out.
  bool pass() {
    bool smaller = false;
    std::vector<Pointer> places;
    list_places(document(), Pointer(), places);
    for (const Pointer& place : places) smaller |= document().contains(place) && simplify(place);
    return smaller;
  }

  bool simplify(const Pointer& place) {
    Json without = document();
    Json& parent = without[place.parent_pointer()];
    if (parent.is_array())
      parent.erase(std::stoul(place.back()));
    else
      parent.erase(place.back());
    if (keep(without)) return true;
    for (const Json& value : simpler(document()[place])) {
      Json changed = document();
      changed[place] = value;
      if (keep(changed)) return true;
    }
    return false;
  }

  Case best_;
  const Trial& trial_;
  const std::function<void(const Case&)>& tell_;
  std::string kind_;
};

}  // namespace

std::string kind_of(const std::string& answer) {
  return answer.substr(0, answer.find(':'));
}

Case minimised(const Case& c, const Trial& trial, const std::function<void(const Case&)>& tell) {
  return Minimiser(c, trial, tell).run();
}

}  // namespace fuzz
