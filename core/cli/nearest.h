// Which known names a mistyped one may have meant.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace weft::cli {

// The known names at most half a word away from `name`, nearest first, at most three; upper and
// lower case count as equal.
std::vector<std::string> nearest(std::string_view name, const std::vector<std::string>& known);

}  // namespace weft::cli
