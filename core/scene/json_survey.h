// A first look at JSON text, before memory is spent on it: how much it holds, and how long its long
// lists are.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace weft::text {

struct ListLength {
  std::size_t nth = 0;    // of all lists and objects of the text, in the order in which they open
  std::size_t items = 0;  // separated by commas
  std::size_t position = 0;  // bytes into the text
};

struct Survey {
  std::size_t values = 0;              // at most so many: numbers, words, lists and objects
  std::size_t lists = 0;               // lists and objects
  ListLength longest;                  // of lists
  std::vector<ListLength> long_lists;  // those of more than a thousand items, as they open
};

// Right for JSON; of any other text it says something, in the same time.
Survey survey(std::string_view text);

}  // namespace weft::text
