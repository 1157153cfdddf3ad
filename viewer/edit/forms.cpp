#include "edit/forms.h"

#include <algorithm>

namespace weft::viewer {

using text::Json;
using text::member;

namespace {

bool takes(const Json& form, std::string_view type) {
  const Json* name = member(form, "type");
  return name && *name == type;
}

// Of the value's first number.
double number_of(const Json& value) {
  if (value.is_number()) return value.get<double>();
  return value.is_structured() && !value.empty() ? number_of(*value.begin()) : 0;
}

// Whether a member means what the number alone does: it must be there, or has its range and unit.
bool is_alike(const Json& form, const std::string& key, const Json& schema, const Json& number) {
  if (const Json* required = member(form, "required"))
    return std::find(required->begin(), required->end(), key) != required->end();
  for (const char* word : {"minimum", "maximum", "x-unit"}) {
    const Json *of = member(schema, word), *alone = member(number, word);
    if ((of != nullptr) != (alone != nullptr) || (of != nullptr && *of != *alone)) return false;
  }
  return true;
}

}  // namespace

std::string name_of_form(const Json& form) {
  const Json* properties = member(form, "properties");
  if (!properties) return takes(form, "array") ? "constant" : "one value";
  if (properties->contains("keys")) return "over time";
  std::string names;
  for (auto it = properties->begin(); it != properties->end(); ++it)
    names += (names.empty() ? "" : ", ") + it.key();
  return names;
}

Json in_form(const Json& value, const Json& from, const Json& to) {
  const Json* properties = member(to, "properties");
  if (!properties) {
    if (!takes(to, "array")) return number_of(value);
    const Json& first = value.at("keys").at(0);
    return {first[1], first[2], first[3]};
  }
  Json object = Json::object();
  if (properties->contains("keys")) {
    object["keys"] = Json::array({Json::array({0, value[0], value[1], value[2]})});
    return object;
  }
  for (auto it = properties->begin(); it != properties->end(); ++it) {
    const Json* most = member(*it, "maximum");
    const double number = most ? std::min(number_of(value), most->get<double>()) : number_of(value);
    object[it.key()] =
        is_alike(to, it.key(), *it, from) ? Json(number) : it->value("default", Json(0));
  }
  return object;
}

}  // namespace weft::viewer
