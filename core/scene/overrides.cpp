#include "scene/overrides.h"

#include <charconv>

namespace weft::text {
namespace {

// The value as JSON; what does not begin like JSON is a string.
bool parse_value(const Override& change, Json& value, Check& result) {
  std::vector<Fault> faults;
  value = parse(change.value, faults);
  if (faults.empty()) return true;
  const bool word = !change.value.empty() &&
                    std::string_view("{[\"-0123456789").find(change.value[0]) == std::string::npos;
  if (word) {
    value = change.value;
    return true;
  }
  const bool empty = change.value.empty();
  result.fault(change.pointer, empty ? "the value is empty" : "the value is " + faults[0].what,
               "JSON, or a bare word");
  return false;
}

// What a missing value starts from: its default, else an empty list or object.
Json starting_value(const Json& schema) {
  const Json* standard = member(schema, "default");
  if (standard && standard->is_structured()) return *standard;
  const bool list = member(schema, "items") || member(schema, "prefixItems");
  return list ? Json::array() : Json::object();
}

// How many elements of the list a token may name: those there are and, where the pointer ends and
// the list may grow, one more.
std::size_t reach(const Json& rule, const Json& list, bool last) {
  const Json* most = member(rule, "maxItems");
  const bool grows = last && (!most || list.size() < most->get<std::size_t>());
  return list.size() + (grows ? 1 : 0);
}

// The element of a list that a token names, null when there is none; "-" appends.
Json* element(Json& list, const std::string& token, std::size_t reach) {
  std::size_t k = 0;
  const char* const end = token.data() + token.size();
  const auto [stop, error] = std::from_chars(token.data(), end, k);
  if (token == "-")
    k = list.size();
  else if (error != std::errc() || stop != end)
    return nullptr;
  if (k >= reach) return nullptr;
  if (k == list.size()) list.push_back(nullptr);
  return &list[k];
}

// One token further into the document; null, with a fault, where the schema knows no such value.
Json* step(const Json& rule, const Override& change, const std::string& token, bool last,
           Json& here, Check& result) {
  if (here.is_null()) here = starting_value(rule);
  if (here.is_array()) {
    const Json* const meant = alternative(rule, here);  // where a list is one of several forms
    const std::size_t count = reach(meant ? *meant : rule, here, last);
    if (Json* found = element(here, token, count)) return found;
    result.fault(change.pointer, "the list has no element " + brief(Json(token)),
                 count ? "0 to " + std::to_string(count - 1) : "none: it is empty");
    return nullptr;
  }
  if (!descend(rule, &here, token)) {
    const std::string near = nearest(keys_of(rule), token);
    result.fault(
        change.pointer, "there is no " + brief(Json(token)) + " to override",
        near.empty() ? "a value of the scene" : "the nearest known key is \"" + near + "\"");
    return nullptr;
  }
  if (!here.is_object()) here = Json::object();  // a number that has an object form (friction)
  return &here[token];
}

}  // namespace

bool split_pointer(const std::string& pointer, std::vector<std::string>& tokens) {
  if (pointer.size() < 2 || pointer[0] != '/') return false;
  tokens.clear();
  for (std::size_t k = 0; k < pointer.size(); ++k) {
    if (pointer[k] == '/') {
      tokens.emplace_back();
    } else if (pointer[k] != '~') {
      tokens.back() += pointer[k];
    } else {
      ++k;
      if (k == pointer.size() || (pointer[k] != '0' && pointer[k] != '1')) return false;
      tokens.back() += pointer[k] == '0' ? '~' : '/';
    }
  }
  return tokens.size() <= kMaxDepth;
}

void apply_override(const Json& schema, const Override& change, Json& document, Check& result) {
  std::vector<std::string> tokens;
  Json value;
  if (!split_pointer(change.pointer, tokens)) {
    result.fault(change.pointer,
                 "the override " + brief(Json(change.pointer)) + " is no JSON pointer to a value",
                 "such as /solver/iterations");
    return;
  }
  if (!parse_value(change, value, result)) return;
  Json changed = document;  // so that a pointer that fails halfway leaves nothing behind
  const Json* rule = &schema;
  Json* here = &changed;
  for (std::size_t k = 0; k < tokens.size(); ++k) {
    Json* const above = here;
    here = step(*rule, change, tokens[k], k + 1 == tokens.size(), *above, result);
    if (!here) return;
    rule = descend(*rule, above, tokens[k]);
    if (!rule) return;
  }
  *here = std::move(value);
  document = std::move(changed);
}

}  // namespace weft::text
