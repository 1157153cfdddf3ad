// JSON as text: parsing that names every fault with line and column, and printing.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "weft/scene.h"

namespace weft::text {

// Objects keep the order of the file, so that faults are told in that order.
using Json = nlohmann::ordered_json;

inline constexpr std::size_t kMaxTextBytes = 64u << 20;  // bounds the memory of any scene file
inline constexpr std::size_t kMaxDepth = 32;             // of lists and objects inside each other
inline constexpr std::size_t kMaxKeys = 1000;            // of one object

// Plain JSON only: no comments, no repeated keys, nothing beyond the limits above. With faults the
// result is null.
Json parse(std::string_view text, std::vector<Fault>& faults);

// Two-space indent, short lists and objects on one line, numbers shortest-exact.
std::string print(const Json& value);

// The value on one line, cut off when it is long: for messages.
std::string brief(const Json& value);

// 1e9, 0.5, 4096: a number as a person writes it.
std::string number_words(double x);

// The member of an object, or null when there is none or it is no object.
const Json* member(const Json& object, std::string_view key);

// `place` with one more token, escaped as JSON pointers ask.
std::string join(std::string_view place, std::string_view token);

}  // namespace weft::text
