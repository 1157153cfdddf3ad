// Values of a glTF document, each with its place, so that what is wrong is told where it is. Faults are thrown as
// Refused and caught by read_gltf_file().
#pragma once

#include <optional>

#include "scene/json_text.h"

namespace weft::text {

struct Refused {
  Fault fault;  // place: a JSON pointer
};

class GltfValue {
 public:
  GltfValue(const Json& json, std::string place) : json_(&json), place_(std::move(place)) {}

  const std::string& place() const { return place_; }
  [[noreturn]] void refuse(std::string what, std::string allowed) const {
    throw Refused{{place_, std::move(what), std::move(allowed)}};
  }

  // A member; nothing where it is not there.
  std::optional<GltfValue> find(const char* key) const {
    if (!json_->is_object()) refuse(brief(*json_) + " is out of place", "an object");
    const Json* found = member(*json_, key);
    if (!found) return {};
    return GltfValue(*found, join(place_, key));
  }
  GltfValue at(const char* key) const {
    const std::optional<GltfValue> found = find(key);
    if (!found) refuse(std::string(key) + " is missing", "every key that glTF 2.0 asks for");
    return *found;
  }

  std::size_t size() const {
    if (!json_->is_array()) refuse(brief(*json_) + " is out of place", "a list");
    return json_->size();
  }
  GltfValue item(std::size_t n) const {
    if (n >= size())
      refuse("there is no item " + std::to_string(n),
             size() > 0 ? "0 to " + std::to_string(size() - 1) : "the list is empty");
    return {(*json_)[n], join(place_, std::to_string(n))};
  }

  std::size_t whole(std::size_t most) const {
    if (!json_->is_number_unsigned() || json_->get<std::uint64_t>() > most)
      refuse(brief(*json_) + " is out of place", "a whole number, 0 to " + std::to_string(most));
    return json_->get<std::size_t>();
  }
  double number() const {
    if (!json_->is_number()) refuse(brief(*json_) + " is out of place", "a number");
    return json_->get<double>();
  }
  const std::string& words() const {
    if (!json_->is_string()) refuse(brief(*json_) + " is out of place", "text");
    return json_->get_ref<const std::string&>();
  }
  bool is_true() const { return json_->is_boolean() && json_->get<bool>(); }

  std::size_t whole_or(const char* key, std::size_t other, std::size_t most) const {
    const auto found = find(key);
    return found ? found->whole(most) : other;
  }
  std::string words_or(const char* key, const char* other) const {
    const auto found = find(key);
    return found ? found->words() : other;
  }
  template <std::size_t N>
  std::array<double, N> numbers_or(const char* key, std::array<double, N> values) const {
    const auto found = find(key);
    if (!found) return values;
    if (found->size() != N)
      found->refuse("the list has " + std::to_string(found->size()) + " numbers",
                    std::to_string(N));
    for (std::size_t k = 0; k < N; ++k) values[k] = found->item(k).number();
    return values;
  }

 private:
  const Json* json_;
  std::string place_;
};

}  // namespace weft::text
