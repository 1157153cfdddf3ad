// The words of schema messages: ranges, kinds of value, names and nearest keys.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include "scene/schema.h"

namespace weft::text {

// 1e9, 0.5, 4096: as a person writes it.
std::string number_words(double x) {
  if (std::isnan(x)) return "not a number (NaN)";
  if (std::isinf(x)) return "infinite";
  char digits[32];
  const bool plain = std::abs(x) < 1e6 && std::trunc(x) == x;
  const auto end = plain ? std::to_chars(digits, digits + 32, static_cast<long>(x)).ptr
                         : std::to_chars(digits, digits + 32, x).ptr;
  std::string text(digits, end);
  for (const auto* padded : {"e+0", "e-0", "e+"}) {
    const std::string from(padded);
    const auto at = text.find(from);
    if (at != std::string::npos) text.replace(at, from.size(), from == "e-0" ? "e-" : "e");
  }
  return text;
}

namespace {

std::string list_words(const Json& schema) {
  const Json* least = member(schema, "minItems");
  const Json* most = member(schema, "maxItems");
  const Json* items = member(schema, "items");
  if (!items) items = &schema.at("prefixItems").at(0);
  const Json* type = member(*items, "type");
  std::string kind = "items";
  if (type && *type == "number") kind = "numbers";
  if (type && *type == "integer") kind = "integers";
  if (least && most && *least == *most) return "a list of " + least->dump() + " " + kind;
  if (least && most) return "a list of " + least->dump() + " to " + most->dump() + " " + kind;
  return most ? "a list of at most " + most->dump() + " " + kind : "a list of " + kind;
}

std::string enum_words(const Json& names) {
  std::string words;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (k > 0) words += k + 1 == names.size() ? " or " : ", ";
    words += names[k].get<std::string>();
  }
  return words;
}

}  // namespace

std::string range_words(const Json& schema) {
  const Json* low = member(schema, "minimum");
  const Json* high = member(schema, "maximum");
  if (!low || !high) return "";
  const Json* unit = member(schema, "x-unit");
  const bool pair =
      *member(schema, "type") == "integer" && high->get<double>() - low->get<double>() == 1;
  return number_words(low->get<double>()) + (pair ? " or " : " to ") +
         number_words(high->get<double>()) + (unit ? " " + unit->get<std::string>() : "");
}

std::string kind_words(const Json& schema) {
  if (const Json* constant = member(schema, "const")) return constant->dump();
  if (const Json* names = member(schema, "enum")) return enum_words(*names);
  const Json* type = member(schema, "type");
  if (!type) {
    std::string words;
    for (const Json& option : schema.at("oneOf"))
      words += (words.empty() ? "" : " or ") + kind_words(option);
    return words;
  }
  if (*type == "number") return "a number, " + range_words(schema);
  if (*type == "integer") return "an integer, " + range_words(schema);
  if (*type == "boolean") return "true or false";
  if (*type == "string") return "text";
  if (*type == "array") return list_words(schema);
  std::string keys;
  for (const std::string& key : keys_of(schema)) keys += (keys.empty() ? "" : ", ") + key;
  return "an object with " + keys;
}

std::vector<std::string> keys_of(const Json& schema) {
  std::vector<std::string> keys;
  if (const Json* properties = member(schema, "properties"))
    for (auto it = properties->begin(); it != properties->end(); ++it) keys.push_back(it.key());
  if (const Json* options = member(schema, "oneOf"))
    for (const Json& option : *options)
      for (std::string& key : keys_of(option)) keys.push_back(std::move(key));
  return keys;
}

std::size_t edit_distance(std::string_view word, std::string_view name) {
  word = word.substr(0, 64);
  std::vector<std::size_t> row(name.size() + 1);  // Levenshtein's, one row at a time
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < word.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < name.size(); ++j) {
      const std::size_t change = diagonal + (word[i] == name[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({change, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::string nearest(const std::vector<std::string>& names, std::string_view word) {
  std::string best;
  std::size_t least = std::string::npos;
  for (const std::string& name : names)
    if (const std::size_t distance = edit_distance(word, name); distance < least) {
      least = distance;
      best = name;
    }
  return best;
}

std::string name_of(std::string_view place) {
  std::string indices;
  while (!place.empty()) {
    const auto slash = place.rfind('/');
    const std::string_view token = place.substr(slash + 1);
    const bool index = !token.empty() && std::all_of(token.begin(), token.end(),
                                                     [](char c) { return '0' <= c && c <= '9'; });
    if (!index) return std::string(token) + indices;
    indices.insert(0, "[" + std::string(token) + "]");
    place = place.substr(0, slash);
  }
  return "the scene" + indices;
}

}  // namespace weft::text
