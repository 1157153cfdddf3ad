// Any bytes as text that can be shown in one line.
#pragma once

#include <string>
#include <string_view>

namespace weft {

// Control characters as \n or \x1b, bytes that are not UTF-8 as \xff: for file names in messages.
std::string printable(std::string_view text);

}  // namespace weft
