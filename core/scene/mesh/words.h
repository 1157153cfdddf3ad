// Words and numbers of text files that give meshes.
#pragma once

#include <charconv>
#include <string_view>

namespace weft::text {

// A text without the mark that some programs put before UTF-8.
inline std::string_view without_mark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  return text.substr(text.starts_with(kMark) ? kMark.size() : 0);
}

// Words between blanks, one after the other; "" after the last.
class Words {
 public:
  explicit Words(std::string_view line) : left_(line) {}
  std::string_view next() {
    const auto begin = left_.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return left_ = {};
    left_.remove_prefix(begin);
    const std::string_view word = left_.substr(0, left_.find_first_of(" \t\r"));
    left_.remove_prefix(word.size());
    return word;
  }
  std::string_view rest() {
    const auto begin = left_.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) return {};
    return left_.substr(begin, left_.find_last_not_of(" \t\r") + 1 - begin);
  }

 private:
  std::string_view left_;
};

// Whether the whole word is a number.
template <class Number>
bool parse_number(std::string_view word, Number& number) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc() && end == word.data() + word.size() && !word.empty();
}

}  // namespace weft::text
