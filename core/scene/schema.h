// The schemas of docs/ at work: checking a document against one, and looking values up in one.
// Understood is the part of JSON Schema 2020-12 that they use: type, const, enum, minimum, maximum,
// items, prefixItems, minItems, maxItems, maxLength, properties, required, additionalProperties
// false, oneOf, default, description, $ref to $defs, and our x-unit. Our x-limits are told only:
// json_text.h has them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "scene/json_text.h"
#include "weft/scene.h"

namespace weft::text {

inline constexpr std::size_t kMaxFaults = 100;

// Every fault found so far. `unsound` names the places whose values cannot be relied on, so that
// one mistake is told once: checks that need them are left out.
struct Check {
  std::vector<Fault> faults;
  std::vector<std::string> unsound;

  bool full() const { return faults.size() >= kMaxFaults; }
  void fault(const std::string& place, std::string what, std::string allowed);
  // Whether nothing at, above or below the place is unsound.
  bool sound(std::string_view place) const;
};

// Parsed once, all $ref resolved.
const Json& scene_schema_json();
const Json& course_schema_json();

// All that the schema has against the value, in the order of the document.
void check(const Json& schema, const Json& value, Check& result);

// Makes null what is unsound, so that nobody reads it. The other values stay where they are.
void drop_unsound(const Check& result, Json& document);

// The schema of one member or element; null when the schema knows none. `value` chooses among
// alternatives and may be null.
const Json* descend(const Json& schema, const Json* value, std::string_view token);

// The alternative of a oneOf that the value is meant as; the schema itself when it has none.
const Json* alternative(const Json& schema, const Json& value);

// "0 to 1e9 N/m", or "" without bounds.
std::string range_words(const Json& schema);

// What the schema takes: "a number, 0 to 1e9 N/m", "a list of 3 numbers", "spring or compliant".
std::string kind_words(const Json& schema);

// Edits (of one character each) between a word, cut to 64 bytes, and a name.
std::size_t edit_distance(std::string_view word, std::string_view name);

// The key of the schema's objects nearest to a misspelt one by edit distance, "" when it has none.
std::string nearest(const std::vector<std::string>& names, std::string_view word);
std::vector<std::string> keys_of(const Json& schema);

// How a message calls the value at a place: "/cloths/0/grid/u/1" is "u[1]".
std::string name_of(std::string_view place);

}  // namespace weft::text
