#include "scene/schema.h"

#include <charconv>
#include <cmath>

#include "scene/assets.h"
#include "scene/overrides.h"
#include "weft/printable.h"
#include "weft/scene.h"

namespace weft::text {
namespace {

// A copy of the schema in which every $ref is replaced by what it names; keywords beside it win.
Json resolve(const Json& schema, const Json& definitions) {
  if (schema.is_array()) {
    Json list = Json::array();
    for (const Json& item : schema) list.push_back(resolve(item, definitions));
    return list;
  }
  if (!schema.is_object()) return schema;
  Json whole = Json::object();
  if (const Json* ref = member(schema, "$ref")) {
    const std::string name = ref->get<std::string>().substr(std::string_view("#/$defs/").size());
    whole = resolve(definitions.at(name), definitions);
  }
  for (auto it = schema.begin(); it != schema.end(); ++it)
    if (it.key() != "$ref" && it.key() != "$defs") whole[it.key()] = resolve(*it, definitions);
  if (whole.contains("x-unit") && whole.contains("items"))  // the unit of a vector is its values'
    whole["items"]["x-unit"] = whole["x-unit"];
  return whole;
}

Json load(std::string_view text) {
  const Json schema = Json::parse(text);
  return resolve(schema, schema.at("$defs"));
}

bool is_integer(const Json& value) {
  if (value.is_number_integer()) return true;
  return value.is_number_float() && std::trunc(value.get<double>()) == value.get<double>();
}

bool has_type(const Json& schema, const Json& value) {
  if (const Json* constant = member(schema, "const")) return value == *constant;
  const Json* type = member(schema, "type");
  if (!type) return true;
  const auto& name = type->get_ref<const std::string&>();
  if (name == "number") return value.is_number();
  if (name == "integer") return is_integer(value);
  if (name == "boolean") return value.is_boolean();
  if (name == "string") return value.is_string();
  if (name == "array") return value.is_array();
  return value.is_object();
}

bool has_required(const Json& schema, const Json& value) {
  const Json* required = member(schema, "required");
  if (!required) return true;
  for (const Json& key : *required)
    if (!member(value, key.get_ref<const std::string&>())) return false;
  return true;
}

// Walks a document beside its schema.
class Walk {
 public:
  explicit Walk(Check& result) : result_(result) {}

  void value(const Json& schema, const Json& value) {
    if (result_.full()) return;
    const Json* chosen = alternative(schema, value);
    if (!chosen || !has_type(*chosen, value)) {
      fault(is(value), kind_words(chosen ? *chosen : schema));
      return;
    }
    if (value.is_number()) number(*chosen, value);
    if (value.is_string()) word(*chosen, value);
    if (value.is_array()) list(*chosen, value);
    if (value.is_object()) object(*chosen, value);
  }

 private:
  std::string is(const Json& value) const { return name_of(place_) + " is " + brief(value); }

  void fault(std::string what, std::string allowed) {
    result_.fault(place_, std::move(what), std::move(allowed));
  }

  void number(const Json& schema, const Json& value) {
    const double x = value.get<double>();
    const Json* low = member(schema, "minimum");
    const Json* high = member(schema, "maximum");
    const bool inside = std::isfinite(x) && (!low || x >= low->get<double>()) &&
                        (!high || x <= high->get<double>());
    if (!inside) fault(is(value), range_words(schema));
  }

  void word(const Json& schema, const Json& value) {
    const Json* names = member(schema, "enum");
    const Json* most = member(schema, "maxLength");
    const auto& text = value.get_ref<const std::string&>();
    if (names && std::find(names->begin(), names->end(), value) == names->end()) {
      fault(is(value), kind_words(schema));
    } else if (most && text.size() > most->get<std::size_t>()) {
      fault(name_of(place_) + " has " + std::to_string(text.size()) + " bytes",
            "0 to " + most->dump());
    } else if (!is_utf8(text)) {
      fault(name_of(place_) + " has bytes that are not UTF-8", "one line of text");
    } else if (std::any_of(text.begin(), text.end(),
                           [](char c) { return (c >= 0 && c < ' ') || c == 0x7f; })) {
      fault(name_of(place_) + " has control characters", "one line of text");
    } else if (schema.contains("format") && !text.empty() && !linear_color(text)) {
      fault(is(value), "#rrggbb in hexadecimal digits, or nothing");
    }
  }

  void list(const Json& schema, const Json& value) {
    const Json* least = member(schema, "minItems");
    const Json* most = member(schema, "maxItems");
    if ((least && value.size() < least->get<std::size_t>()) ||
        (most && value.size() > most->get<std::size_t>())) {
      const std::string count = std::to_string(value.size());
      fault(name_of(place_) + " has " + (value.empty() ? "no" : count) +
                (value.size() == 1 ? " item" : " items"),
            kind_words(schema));
      return;
    }
    const Json* items = member(schema, "items");
    const Json* first = member(schema, "prefixItems");
    for (std::size_t k = 0; k < value.size() && !result_.full(); ++k) {
      const Step step(place_, std::to_string(k));
      this->value(first ? first->at(k) : *items, value[k]);
    }
  }

  void object(const Json& schema, const Json& value) {
    const Json& properties = schema.at("properties");
    for (auto it = value.begin(); it != value.end() && !result_.full(); ++it) {
      if (const Json* known = member(properties, it.key())) {
        const Step step(place_, it.key());
        this->value(*known, *it);
      } else {
        unknown(schema, it.key());
      }
    }
    if (const Json* required = member(schema, "required"))
      for (const Json& key : *required)
        if (!value.contains(key.get_ref<const std::string&>())) missing(schema, key);
    one_of(schema, value);
  }

  void unknown(const Json& schema, const std::string& key) {
    const std::string near = nearest(keys_of(schema), key);
    const std::string parent = place_;
    const Step step(place_, key);
    fault("unknown key " + brief(key), "the nearest known key is \"" + near + "\"");
    result_.unsound.push_back(join(parent, near));
  }

  void missing(const Json& schema, const Json& key) {
    const auto& name = key.get_ref<const std::string&>();
    fault(name + " is missing", kind_words(schema.at("properties").at(name)));
  }

  // Exactly one of the keys that the alternatives require (the shapes of a collider).
  void one_of(const Json& schema, const Json& value) {
    const Json* alternatives = member(schema, "oneOf");
    if (!alternatives) return;
    std::string found, all;
    std::size_t count = 0;
    bool misspelt = false;  // already told
    for (const Json& option : *alternatives) {
      const std::string key = option.at("required").at(0).get<std::string>();
      all += (all.empty() ? "" : ", ") + key;
      if (!value.contains(key)) {
        misspelt = misspelt || !result_.sound(join(place_, key));
        continue;
      }
      found += (count++ ? " and " : "") + key;
    }
    if (count == 1 || (count == 0 && misspelt)) return;
    fault(name_of(place_) + " has " + (count ? found : "no shape"), "exactly one of " + all);
  }

  // One token further into the document, and back.
  class Step {
   public:
    Step(std::string& place, std::string_view token) : place_(place), length_(place.size()) {
      place_ = join(place_, token);
    }
    ~Step() { place_.resize(length_); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    std::string& place_;
    std::size_t length_;
  };

  Check& result_;
  std::string place_;
};

// The value at a place; null where there is none, or where the place is no JSON pointer.
Json* value_at(Json& document, const std::string& place) {
  std::vector<std::string> tokens;
  if (!place.empty() && !split_pointer(place, tokens)) return nullptr;
  Json* here = &document;
  for (const std::string& token : tokens) {
    std::size_t k = 0;
    const auto [stop, error] = std::from_chars(token.data(), token.data() + token.size(), k);
    if (here->is_object() && here->contains(token))
      here = &(*here)[token];
    else if (here->is_array() && error == std::errc() && k < here->size())
      here = &(*here)[k];
    else
      return nullptr;
  }
  return here;
}

// Whether `inner` is `outer` or lies below it.
bool within(std::string_view inner, std::string_view outer) {
  return inner.starts_with(outer) && (inner.size() == outer.size() || inner[outer.size()] == '/');
}

}  // namespace

void Check::fault(const std::string& place, std::string what, std::string allowed) {
  if (full()) return;
  faults.push_back({place, std::move(what), std::move(allowed)});
  unsound.push_back(place);
}

bool Check::sound(std::string_view place) const {
  return std::none_of(unsound.begin(), unsound.end(), [&](const std::string& bad) {
    return within(place, bad) || within(bad, place);
  });
}

const Json& scene_schema_json() {
  static const Json schema = load(kSceneSchema);
  return schema;
}

const Json& course_schema_json() {
  static const Json schema = load(kCourseSchema);
  return schema;
}

void check(const Json& schema, const Json& value, Check& result) {
  Walk(result).value(schema, value);
}

void drop_unsound(const Check& result, Json& document) {
  for (const std::string& place : result.unsound)
    if (Json* value = value_at(document, place)) release(*value);
}

const Json* alternative(const Json& schema, const Json& value) {
  const Json* options = member(schema, "oneOf");
  if (!options || member(schema, "type")) return &schema;
  const Json* fitting = nullptr;
  for (const Json& option : *options) {
    if (!has_type(option, value)) continue;
    if (has_required(option, value)) return &option;
    if (!fitting) fitting = &option;
  }
  return fitting;
}

const Json* descend(const Json& schema, const Json* value, std::string_view token) {
  const Json* options = member(schema, "oneOf");
  if (options && !member(schema, "type")) {
    if (value && !value->is_null()) {
      const Json* chosen = alternative(schema, *value);
      if (const Json* found = chosen ? descend(*chosen, value, token) : nullptr) return found;
    }
    for (const Json& option : *options)
      if (const Json* found = descend(option, nullptr, token)) return found;
    return nullptr;
  }
  if (const Json* properties = member(schema, "properties")) return member(*properties, token);
  const bool index =
      token == "-" ||  // one past the end
      (!token.empty() && token.size() < 10 &&
       std::all_of(token.begin(), token.end(), [](char c) { return '0' <= c && c <= '9'; }));
  if (!index) return nullptr;
  if (const Json* first = member(schema, "prefixItems")) {
    const std::size_t k = token == "-" ? first->size() : std::stoul(std::string(token));
    return k < first->size() ? &first->at(k) : nullptr;
  }
  return member(schema, "items");
}

}  // namespace weft::text
