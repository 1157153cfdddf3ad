// The text of a study -> Study, with every fault named by its place.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "scene/course.h"
#include "scene/course_file.h"
#include "scene/document.h"
#include "scene/json_text.h"
#include "scene/overrides.h"
#include "scene/schema.h"
#include "study/columns.h"
#include "study/draws.h"
#include "study/study.h"
#include "study/triangles.h"
#include "weft/mesh.h"
#include "weft/read_scene.h"

namespace weft {

namespace {

using text::Json;
using text::member;

constexpr double kMostRuns = 1e7;
constexpr std::size_t kMostParameters = 100, kMostSamples = 100'000, kChunkBytes = 1u << 20;
constexpr std::size_t kMostTextBytes = 200;

std::string fault_lines(const std::vector<Fault>& faults) {
  std::string lines;
  for (const Fault& f : faults)
    lines += (lines.empty() ? "" : "\n") + f.place + ": " + f.what +
             (f.allowed.empty() ? "" : " (" + f.allowed + ")");
  return lines;
}

std::string count_words(double count) {
  return count < 1e15 ? std::to_string(std::uint64_t(count)) : text::number_words(count);
}

}  // namespace

StudyError::StudyError(std::vector<Fault> found)
    : std::invalid_argument(fault_lines(found)), faults(std::move(found)) {}

// Reads one study; what is wrong is collected.
struct Study::Reader {
  Study& study;
  std::string folder;
  Json document{};
  std::vector<Fault> faults{};
  Scene scene{};

  void fault(const std::string& place, const std::string& what, const std::string& allowed) {
    faults.push_back({place, what, allowed});
  }
  void known(const Json& object, const std::string& place, const std::vector<std::string>& keys) {
    for (const auto& [key, value] : object.items())
      if (std::ranges::find(keys, key) == keys.end()) {
        const std::string near = text::nearest(keys, key);
        fault(text::join(place, key), "there is no such key",
              near.empty() ? "" : "the nearest is \"" + near + "\"");
      }
  }
  // A number in its range, `otherwise` where it is not given or wrong.
  double number(const Json& object, const std::string& place, const char* key, double least,
                double most, bool whole, double otherwise) {
    const Json* const value = member(object, key);
    if (value == nullptr) return otherwise;
    const bool good = value->is_number() && value->get<double>() >= least &&
                      value->get<double>() <= most &&
                      (!whole || value->get<double>() == std::floor(value->get<double>()));
    if (good) return value->get<double>();
    fault(text::join(place, key), "the value is " + text::brief(*value),
          (whole ? "a whole number, " : "a number, ") + text::number_words(least) + " to " +
              text::number_words(most));
    return otherwise;
  }
  std::string word(const Json& object, const std::string& place, const char* key,
                   const std::vector<std::string>& words) {
    const Json* const value = member(object, key);
    if (value == nullptr) return words[0];
    if (value->is_string() && std::ranges::find(words, value->get<std::string>()) != words.end())
      return value->get<std::string>();
    std::string allowed;
    for (const std::string& w : words) allowed += (allowed.empty() ? "" : ", ") + w;
    fault(text::join(place, key), "the value is " + text::brief(*value), allowed);
    return words[0];
  }

  // Puts the scene that a name stands for in its place.
  void read_scene_value() {
    Json& value = document["scene"];
    if (value.is_string()) {
      const auto name = value.get<std::string>();
      std::error_code unknown;
      const std::filesystem::path beside = std::filesystem::path(folder) / name;
      const bool there = std::filesystem::is_regular_file(beside, unknown);
      const SceneFile file = read_scene(there ? beside.string() : name);
      if (!file.faults.empty()) return scene_faults(file);
      std::ostringstream bytes;
      bytes << std::ifstream(file.path, std::ios::binary).rdbuf();
      std::vector<Fault> none;
      value = text::parse(bytes.str(), none);
    }
    if (!value.is_object())
      return fault("/scene", "the value is " + text::brief(value), "a scene, or the name of one");
    study.scene_ = value.dump();
    const SceneFile file = read_scene_text(study.scene_);
    if (!file.faults.empty()) return scene_faults(file);
    std::string mesh;
    for_each_mesh(file.scene, [&](const MeshSource&, const std::string& place) {
      if (mesh.empty()) mesh = place;
    });
    if (!mesh.empty())
      return fault("/scene" + mesh, "a study has a mesh", "grids, and bodies of other shapes");
    scene = file.scene;
  }
  void scene_faults(const SceneFile& file) {
    for (const Fault& f : file.faults) fault("/scene" + f.place, f.what, f.allowed);
  }

  // Whether a pointer names a value of the scene; a fault where not. The value is not looked at.
  void require_target(const std::string& place, const std::string& pointer) {
    if (study.scene_.empty() || !faults.empty()) return;
    std::vector<std::string> tokens;
    Json file = document["scene"];
    const bool course = text::is_course(file) && text::split_pointer(pointer, tokens) &&
                        text::descend(text::course_schema_json(), nullptr, tokens[0]) != nullptr;
    if (!course && text::is_course(file)) file = text::document_of(scene);
    text::Check check;
    text::apply_override(course ? text::course_schema_json() : text::scene_schema_json(),
                         {pointer, "0"}, file, check);
    for (const Fault& f : check.faults) fault(place, f.what, f.allowed);
  }

  void read_range(const Json& range, const std::string& place, Parameter& p) {
    if (!range.is_object())
      return fault(place, "the value is " + text::brief(range), "{\"from\", \"to\", \"count\"}");
    known(range, place, {"from", "to", "count", "scale"});
    bounds(range, place, p);
    const auto count = std::size_t(number(range, place, "count", 2, kMostRuns, true, 2));
    for (std::size_t k = 0; k < count && faults.empty(); ++k)
      p.values.push_back(between(p, double(k) / double(count - 1)));
  }
  void bounds(const Json& range, const std::string& place, Parameter& p) {
    for (const char* key : {"from", "to"})
      if (member(range, key) == nullptr) fault(text::join(place, key), "it is missing", "a number");
    p.log = word(range, place, "scale", {"linear", "log"}) == "log";
    const double least = p.log ? 1e-300 : -1e300;
    p.from = number(range, place, "from", least, 1e300, false, 1);
    p.to = number(range, place, "to", least, 1e300, false, 1);
  }
  void read_values(const Json& values, const std::string& place, Parameter& p) {
    if (!values.is_array() || values.empty())
      return fault(place, "the value is " + text::brief(values), "a list of at least one value");
    p.values.assign(values.begin(), values.end());
    p.text = !std::ranges::all_of(p.values, [](const Json& v) { return v.is_number(); });
    for (std::size_t k = 0; k < p.values.size(); ++k)
      if (p.text && p.values[k].dump().size() > kMostTextBytes)
        fault(place + "/" + std::to_string(k), "the value is long", "at most 200 bytes of JSON");
  }
  void read_parameter(const Json& value, const std::string& place) {
    if (!value.is_object() || !member(value, "pointer") || !member(value, "pointer")->is_string())
      return fault(place, "there is no pointer", "an object with \"pointer\": \"/gravity/1\"");
    known(value, place, {"pointer", "name", "values", "range", "draw"});
    Parameter p;
    p.pointer = value["pointer"].get<std::string>();
    p.name = name_of_pointer(p.pointer);
    if (const Json* name = member(value, "name")) {
      if (name->is_string() && !name->get<std::string>().empty())
        p.name = name->get<std::string>();
      else
        fault(place + "/name", "the value is " + text::brief(*name), "a word");
    }
    require_target(place + "/pointer", p.pointer);
    const Json *values = member(value, "values"), *range = member(value, "range"),
               *draw = member(value, "draw");
    if ((values != nullptr) + (range != nullptr) + (draw != nullptr) != 1)
      return fault(place, "it has not one of values, range and draw", "exactly one of them");
    if (values != nullptr) read_values(*values, place + "/values", p);
    if (range != nullptr) read_range(*range, place + "/range", p);
    if (draw != nullptr) {
      known(*draw, place + "/draw", {"from", "to", "scale", "whole"});
      bounds(*draw, place + "/draw", p);
      const Json* whole = member(*draw, "whole");
      p.whole = whole != nullptr && *whole == true;
      ++study.dimensions_;
    }
    study.parameters_.push_back(std::move(p));
  }
  void read_parameters() {
    const Json* const list = member(document, "parameters");
    if (list == nullptr) return;
    if (!list->is_array() || list->size() > kMostParameters)
      return fault("/parameters", "the value is " + text::brief(*list), "a list of at most 100");
    for (std::size_t k = 0; k < list->size(); ++k)
      read_parameter((*list)[k], "/parameters/" + std::to_string(k));
  }
  void count_runs() {
    const Json* const draws = member(document, "draws");
    if ((draws != nullptr) != (study.dimensions_ > 0))
      return fault("/draws", draws ? "no parameter is drawn" : "it is missing",
                   "together with parameters that have \"draw\"");
    Draw draw = Draw::random;
    if (draws != nullptr) {
      known(*draws, "/draws", {"method", "count"});
      const std::string method =
          word(*draws, "/draws", "method", {"latin_hypercube", "sobol", "random"});
      draw = method == "sobol"    ? Draw::sobol
             : method == "random" ? Draw::random
                                  : Draw::latin_hypercube;
      if (member(*draws, "count") == nullptr) fault("/draws/count", "it is missing", "a number");
      study.drawn_ = std::uint64_t(number(*draws, "/draws", "count", 1, kMostRuns, true, 1));
      if (draw == Draw::sobol && study.dimensions_ > kSobolDimensions)
        fault("/draws/method", "sobol has " + std::to_string(kSobolDimensions) + " dimensions",
              "at most so many drawn parameters, or latin_hypercube");
    }
    double runs = double(study.drawn_);
    for (const Parameter& p : study.parameters_)
      if (!p.values.empty()) runs *= double(p.values.size());
    if (runs > kMostRuns)
      return fault("/parameters", "the study has " + count_words(runs) + " runs",
                   "at most " + count_words(kMostRuns));
    study.runs_ = std::uint64_t(runs);
    if (faults.empty())
      study.points_ = draw_points(draw, study.drawn_, study.dimensions_, study.seed_);
  }

  void read_measures() {
    const Json* const list = member(document, "measures");
    const Json report = empty_report();
    if (list != nullptr && !list->is_array())
      return fault("/measures", "the value is " + text::brief(*list), "a list of JSON pointers");
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
      const std::string place = "/measures/" + std::to_string(k);
      std::vector<std::string> tokens;
      const Json& value = (*list)[k];
      const bool pointer =
          value.is_string() && text::split_pointer(value.get<std::string>(), tokens);
      const Json::json_pointer at(pointer ? value.get<std::string>() : "");
      if (pointer && report.contains(at) && report.at(at).is_primitive())
        study.measures_.push_back(value.get<std::string>());
      else
        fault(place, "the report has no single value at " + text::brief(value),
              "a JSON pointer such as /strain/max");
    }
  }

  void read_positions() {
    const double frame = scene.time.frame;
    study.frames_ =
        std::llround(number(document, "", "seconds", 0, 1e9, false, scene.time.seconds) / frame);
    study.frames_ =
        std::int64_t(number(document, "", "frames", 0, 1e9, true, double(study.frames_)));
    if (member(document, "frames") && member(document, "seconds"))
      fault("/seconds", "the length is given twice", "frames or seconds");
    const Json* const positions = member(document, "positions");
    if (positions == nullptr) return;
    known(*positions, "/positions", {"every", "frames"});
    std::vector<std::int64_t>& frames = study.chunks_.frames;
    if (const Json* list = member(*positions, "frames")) {
      for (std::size_t k = 0; k < list->size(); ++k) {
        const Json& at = (*list)[k];
        const std::int64_t before = frames.empty() ? -1 : frames.back();
        if (!at.is_number_integer() || at.get<double>() <= double(before) ||
            at.get<double>() > double(study.frames_))
          return fault("/positions/frames/" + std::to_string(k), "the value is " + text::brief(at),
                       "frames in order, 0 to " + std::to_string(study.frames_));
        frames.push_back(at.get<std::int64_t>());
      }
    } else {
      const auto every = std::int64_t(number(*positions, "/positions", "every", 1, 1e9, true, 1));
      if (double(study.frames_) / double(every) <= double(kMostSamples))
        for (std::int64_t n = every; n <= study.frames_; n += every) frames.push_back(n);
      else
        fault("/positions/every", "that makes more than 100000 samples", "a larger number");
    }
    if (frames.empty()) fault("/positions", "no frame is kept", "at least one");
  }
  void shape_chunks() {
    study.chunks_.particles = 0;
    for (const Cloth& c : scene.cloths)
      study.chunks_.particles += std::size_t(c.grid.nx) * std::size_t(c.grid.ny);
    study.chunks_.samples =
        std::clamp<std::size_t>(kChunkBytes / (12 * study.chunks_.particles), 1,
                                std::max<std::size_t>(study.chunks_.frames.size(), 1));
  }
  void list_triangles() {
    std::uint32_t first = 0;
    for (const Cloth& c : scene.cloths) {
      const auto nx = std::uint32_t(c.grid.nx), ny = std::uint32_t(c.grid.ny);
      append_triangles(nx, ny, first, study.triangles_);
      first += nx * ny;
    }
  }

  void read() {
    if (!document.is_object() || document.value("weft_study", Json()) != 1)
      throw StudyError({{"", "this is no study", "an object with \"weft_study\": 1"}});
    known(document, "",
          {"weft_study", "name", "about", "scene", "seed", "frames", "seconds", "parameters",
           "draws", "measures", "positions"});
    if (!document.contains("scene"))
      fault("/scene", "it is missing", "a scene, or its name");
    else
      read_scene_value();
    study.seed_ = std::uint64_t(number(document, "", "seed", 0, 0x1p53, true, 1));
    read_parameters();
    if (faults.empty()) count_runs();
    read_measures();
    if (faults.empty()) read_positions();
    if (faults.empty()) shape_chunks();
  }

  static double between(const Parameter& p, double t) {
    if (!p.log) return p.from + (p.to - p.from) * t;
    return t == 1 ? p.to : p.from * std::pow(p.to / p.from, t);
  }
};

Study::Study(std::string_view json, const std::string& folder) {
  Reader reader{*this, folder};
  reader.document = text::parse(json, reader.faults);
  if (!reader.faults.empty()) throw StudyError(std::move(reader.faults));
  reader.read();
  if (!reader.faults.empty()) throw StudyError(std::move(reader.faults));
  reader.list_triangles();
  text_ = reader.document.dump();
  add_columns();
}

std::vector<Study::Json> Study::values_of(std::uint64_t run) const {
  std::vector<Json> values(parameters_.size());
  const std::uint64_t draw = run % drawn_;
  std::uint64_t rest = run / drawn_;
  std::size_t dimension = dimensions_;
  for (std::size_t k = parameters_.size(); k-- > 0;) {  // the first parameter changes slowest
    const Parameter& p = parameters_[k];
    if (p.values.empty()) {
      const double v = Reader::between(p, points_[draw * dimensions_ + --dimension]);
      values[k] = p.whole ? Json(std::int64_t(std::floor(v))) : Json(v);
    } else {
      values[k] = p.values[rest % p.values.size()];
      rest /= p.values.size();
    }
  }
  return values;
}

}  // namespace weft
