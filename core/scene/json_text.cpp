#include "scene/json_text.h"

#include <algorithm>
#include <utility>

#include "scene/json_survey.h"

namespace weft::text {
namespace {

std::string line_and_column(std::string_view text, std::size_t position) {
  const std::string_view before = text.substr(0, position);
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  const auto column = before.size() - (before.rfind('\n') + 1) + 1;  // npos + 1 is 0
  return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

// Builds the document event by event; stops at the first fault.
class Builder : public nlohmann::json_sax<Json> {
 public:
  Builder(std::string_view text, const Survey& survey, Json& root, std::vector<Fault>& faults)
      : text_(text), survey_(survey), root_(root), faults_(faults) {}

  bool null() override { return add(nullptr); }
  bool boolean(bool value) override { return add(value); }
  bool number_integer(number_integer_t value) override { return add(value); }
  bool number_unsigned(number_unsigned_t value) override { return add(value); }
  bool number_float(number_float_t value, const string_t&) override { return add(value); }
  bool string(string_t& value) override { return add(std::move(value)); }
  bool binary(binary_t&) override { return false; }
  bool start_object(std::size_t) override { return open(Json::object(), 0); }
  bool start_array(std::size_t) override { return open(Json::array(), length()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    const Json& object = *open_.back().value;
    if (name.size() > kMaxKeyBytes)
      return fail(open_.back().place, "a key has " + std::to_string(name.size()) + " bytes",
                  "at most 200");
    if (object.contains(name))
      return fail(join(open_.back().place, name), "the key is given twice", "each key once");
    if (object.size() == kMaxKeys)
      return fail(open_.back().place, "the object has more than 1000 keys", "at most 1000");
    key_ = name;
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    const std::string where = line_and_column(text_, position > 0 ? position - 1 : 0);
    return fail("", where + ": " + reason(error.what()), "plain JSON");
  }

 private:
  struct Open {
    Json* value;
    std::string place;
  };

  // What the parser says, without its prefix and without the text that it quotes.
  static std::string reason(std::string what) {
    const auto start = what.find("column ");
    const auto from =
        what.find(start == std::string::npos ? "] " : ": ", start == std::string::npos ? 0 : start);
    if (from != std::string::npos) what.erase(0, from + 2);
    if (what.starts_with("number overflow")) return "the number is too large";
    const auto quote = what.find("; last read: ");
    if (quote == std::string::npos) return what;
    const auto rest = what.rfind("; expected ");
    return what.substr(0, quote) +
           (rest != std::string::npos && rest > quote ? what.substr(rest) : "");
  }

  bool fail(std::string place, std::string what, std::string allowed) {
    faults_.push_back({std::move(place), std::move(what), std::move(allowed)});
    return false;
  }

  Json* place_value(Json&& value) {
    if (open_.empty()) return &(root_ = std::move(value));
    Json& parent = *open_.back().value;
    if (parent.is_array()) return &parent.emplace_back(std::move(value));
    return &put(parent, key_, std::move(value));
  }

  bool add(Json&& value) {
    place_value(std::move(value));
    return true;
  }

  // Of the list that opens now, where it is long: 0 else.
  std::size_t length() {
    if (next_long_ == survey_.long_lists.size()) return 0;
    if (survey_.long_lists[next_long_].nth != opened_) return 0;
    return survey_.long_lists[next_long_++].items;
  }

  // Room for all items at once: a list that grows step by step takes up to three times as much.
  bool open(Json&& value, std::size_t items) {
    ++opened_;
    if (open_.size() == kMaxDepth)
      return fail("", "lists and objects are nested deeper than 32", "at most 32");
    std::string place;
    if (!open_.empty()) {
      const Open& parent = open_.back();
      const bool list = parent.value->is_array();
      place = join(parent.place, list ? std::to_string(parent.value->size()) : key_);
    }
    Json* placed = place_value(std::move(value));
    if (items > 0) placed->get_ref<Json::array_t&>().reserve(items);
    open_.push_back({placed, std::move(place)});
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::string_view text_;
  const Survey& survey_;
  std::size_t opened_ = 0;     // lists and objects
  std::size_t next_long_ = 0;  // of the survey's
  Json& root_;
  std::vector<Fault>& faults_;
  std::vector<Open> open_;  // from the root to the list or object being read
  std::string key_;
};

// Whether the text holds more than any document may.
bool is_too_much(std::string_view text, const Survey& survey, std::vector<Fault>& faults) {
  const auto fault = [&](std::size_t count, const std::string& what, std::size_t most) {
    std::string where;
    if (survey.longest.items > 1)
      where = "; the longest list, at " + line_and_column(text, survey.longest.position) +
              ", has " + std::to_string(survey.longest.items) + " items";
    faults.push_back({"", "the text holds " + std::to_string(count) + " " + what + where,
                      "at most " + std::to_string(most) + " in all"});
    return true;
  };
  if (survey.lists > kMaxLists) return fault(survey.lists, "lists and objects", kMaxLists);
  return survey.values > kMaxValues && fault(survey.values, "values", kMaxValues);
}

constexpr std::size_t kLineWidth = 90;

// Whether the value reads well on one line: no member of it is itself nested more than once.
bool is_flat(const Json& value, int depth) {
  if (!value.is_structured()) return true;
  if (depth == 0 || value.size() > 32) return false;
  return std::all_of(value.begin(), value.end(),
                     [&](const Json& item) { return is_flat(item, depth - 1); });
}

std::string one_line(const Json& value) {
  if (!value.is_structured()) return value.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text = value.is_array() ? "[" : "{";
  for (auto it = value.begin(); it != value.end(); ++it) {
    if (it != value.begin()) text += ", ";
    if (value.is_object()) text += one_line(Json(it.key())) + ": ";
    text += one_line(*it);
  }
  return text + (value.is_array() ? "]" : "}");
}

void print(const Json& value, std::size_t indent, std::string& text) {
  if (is_flat(value, 3)) {
    const std::string line = one_line(value);
    if (indent + line.size() <= kLineWidth || !value.is_structured()) {
      text += line;
      return;
    }
  }
  text += value.is_array() ? "[" : "{";
  for (auto it = value.begin(); it != value.end(); ++it) {
    text += it == value.begin() ? "\n" : ",\n";
    text.append(indent + 2, ' ');
    if (value.is_object()) text += one_line(Json(it.key())) + ": ";
    print(*it, indent + 2, text);
  }
  text += "\n" + std::string(indent, ' ') + (value.is_array() ? "]" : "}");
}

}  // namespace

Json parse(std::string_view text, std::vector<Fault>& faults) {
  Json root;
  if (text.size() > kMaxTextBytes) {
    faults.push_back({"", "the text is longer than 64 MiB", "at most 64 MiB"});
    return root;
  }
  const Survey found = survey(text);
  if (is_too_much(text, found, faults)) return root;
  const std::size_t known = faults.size();
  Builder builder(text, found, root, faults);
  Json::sax_parse(text.begin(), text.end(), &builder);
  if (faults.size() > known) release(root);
  return root;
}

Json& put(Json& object, const std::string& key, Json&& value) {
  auto& members = object.get_ref<Json::object_t&>();
  if (members.size() == members.capacity()) {
    Json::object_t wider;
    wider.reserve(std::max<std::size_t>(2 * members.size(), 2));
    for (auto& [name, kept] : members) wider.emplace_back(name, std::move(kept));
    members = std::move(wider);
  }
  return object[key] = std::move(value);
}

// The library's destructor first moves the items of a list into one as long.
void release(Json& value) {
  if (value.is_structured())
    for (Json& item : value)
      if (item.is_structured()) release(item);
  if (value.is_array()) value.get_ref<Json::array_t&>() = {};
  value = nullptr;
}

std::string print(const Json& value) {
  std::string text;
  print(value, 0, text);
  return text + "\n";
}

std::string brief(const Json& value) {
  constexpr std::size_t kMost = 40;
  if (value.is_object()) return "an object";
  if (value.is_array()) {
    if (!is_flat(value, 1) || value.size() > 4) return "a list of " + std::to_string(value.size());
  }
  if (value.is_number_float()) return number_words(value.get<double>());
  std::string text;
  if (value.is_string() && value.get_ref<const std::string&>().size() > kMost) {
    text = one_line(Json(value.get_ref<const std::string&>().substr(0, kMost)));
    return text.substr(0, text.size() - 1) + "…\"";
  }
  text = one_line(value);
  return text.size() > 4 * kMost ? "a list of " + std::to_string(value.size()) : text;
}

const Json* member(const Json& object, std::string_view key) {
  if (!object.is_object()) return nullptr;
  for (auto it = object.begin(); it != object.end(); ++it)
    if (it.key() == key) return &*it;
  return nullptr;
}

std::string join(std::string_view place, std::string_view token) {
  std::string joined(place);
  joined += '/';
  for (const char c : token) {
    if (c == '~')
      joined += "~0";
    else if (c == '/')
      joined += "~1";
    else
      joined += c;
  }
  return joined;
}

}  // namespace weft::text
