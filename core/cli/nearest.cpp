// Edit distance (Levenshtein): letters to insert, drop or change to turn one word into another.
#include "nearest.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <numeric>
#include <utility>

namespace weft::cli {

namespace {

bool same_letter(char a, char b) {
  return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (same_letter(a[i - 1], b[j - 1]) ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({changed, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string> nearest(std::string_view name, const std::vector<std::string>& known) {
  constexpr std::size_t kMost = 3;
  std::vector<std::pair<std::size_t, std::string>> found;
  for (const std::string& word : known) {
    const std::size_t distance = edit_distance(name, word);
    if (2 * distance <= std::max(name.size(), word.size())) found.emplace_back(distance, word);
  }
  std::ranges::sort(found);
  std::vector<std::string> words;
  for (auto& [distance, word] : found) {
    if (words.size() < kMost) words.push_back(std::move(word));
  }
  return words;
}

}  // namespace weft::cli
