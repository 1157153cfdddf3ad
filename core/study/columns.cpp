#include "study/columns.h"

#include <algorithm>
#include <set>

#include "weft/report.h"

namespace weft {

std::string name_of_pointer(const std::string& pointer) {
  std::string name = pointer.substr(std::min<std::size_t>(1, pointer.size()));
  std::ranges::replace(name, '/', '.');
  return name;
}

nlohmann::ordered_json empty_report() {
  Report report;
  report.strain.max_of_frames = 0;
  return nlohmann::ordered_json::parse(to_json(report));
}

void Study::add_columns() {
  using Kind = Column::Kind;
  constexpr std::size_t kMeasureBytes = 64, kStatusBytes = 160;
  const auto add = [&](const std::string& name, Kind kind, std::size_t bytes = 8) {
    columns_.push_back({name, kind, bytes, row_bytes()});
  };
  add("run", Kind::whole);
  add("particles", Kind::whole);
  for (const Parameter& p : parameters_) {
    std::size_t bytes = 1;
    for (const Json& v : p.values) bytes = std::max(bytes, v.dump().size());
    p.text ? add(p.name, Kind::text, bytes) : add(p.name, Kind::number);
  }
  const Json report = empty_report();
  for (const std::string& measure : measures_) {
    const Json& value = report.at(Json::json_pointer(measure));
    value.is_string() ? add(name_of_pointer(measure), Kind::text, kMeasureBytes)
                      : add(name_of_pointer(measure), Kind::number);
  }
  add("seconds", Kind::number);
  // The report's own status comes under another name.
  add("outcome", Kind::text, kStatusBytes);
  std::set<std::string> names;
  for (const Column& c : columns_)
    if (!names.insert(c.name).second)
      throw StudyError({{"/parameters", "two columns have the name \"" + c.name + "\"",
                         "another \"name\" of a parameter, each measure once"}});
}

std::size_t Study::row_bytes() const {
  return columns_.empty() ? 0 : columns_.back().offset + columns_.back().bytes;
}

}  // namespace weft
