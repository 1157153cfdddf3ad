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

// These bound the memory of any file to some 400 MB; x-limits in docs/scene.schema.json states them.
inline constexpr std::size_t kMaxTextBytes = 64u << 20;
inline constexpr std::size_t kMaxDepth = 32;           // of lists and objects inside each other
inline constexpr std::size_t kMaxKeys = 1000;          // of one object
inline constexpr std::size_t kMaxKeyBytes = 200;       // of one key
inline constexpr std::size_t kMaxLists = 2'000'000;    // lists and objects
inline constexpr std::size_t kMaxValues = 20'000'000;  // numbers, words, lists and objects

// Plain JSON only: no comments, no repeated keys, nothing beyond the limits above. With faults the
// result is null.
Json parse(std::string_view text, std::vector<Fault>& faults);

// Sets a member of an object. The library's own way copies all members there are whenever their list
// grows, however large they are.
Json& put(Json& object, const std::string& key, Json&& value);

// Makes the value null, without the room that its destructor takes for long lists.
void release(Json& value);

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
