// Counts brackets and commas outside of strings (json_survey.h).
#include "scene/json_survey.h"

#include <algorithm>

#include "scene/json_text.h"

namespace weft::text {
namespace {

constexpr std::size_t kLong = 1000;

// The position of the quote that ends a string, which begins after `at`; the text's end without one.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  for (++at; at < text.size() && text[at] != '"'; ++at)
    if (text[at] == '\\') ++at;
  return at;
}

class Counter {
 public:
  void open(std::size_t position, bool is_list) {
    open_.push_back({{result_.lists++, 1, position}, is_list});
    ++result_.values;
  }

  void comma() {
    ++result_.values;
    if (!open_.empty()) ++open_.back().length.items;
  }

  void close() {
    if (open_.empty()) return;
    const auto [length, is_list] = open_.back();
    open_.pop_back();
    if (!is_list) return;
    if (length.items > result_.longest.items) result_.longest = length;
    if (length.items > kLong) result_.long_lists.push_back(length);
  }

  // Too deep for the parser, which will say so.
  bool too_deep() const { return open_.size() > kMaxDepth; }

  // What is still open counts, too.
  Survey take() {
    while (!open_.empty()) close();
    std::ranges::sort(result_.long_lists, {}, &ListLength::nth);
    ++result_.values;
    return std::move(result_);
  }

 private:
  struct Open {
    ListLength length;
    bool is_list;
  };
  Survey result_;
  std::vector<Open> open_;
};

}  // namespace

Survey survey(std::string_view text) {
  Counter counter;
  for (std::size_t k = 0; k < text.size() && !counter.too_deep(); ++k) {
    const char c = text[k];
    if (c == '"')
      k = end_of_string(text, k);
    else if (c == '[' || c == '{')
      counter.open(k, c == '[');
    else if (c == ',')
      counter.comma();
    else if (c == ']' || c == '}')
      counter.close();
  }
  return counter.take();
}

}  // namespace weft::text
