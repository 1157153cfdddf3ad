// Text from outside (names, paths, keys, values) as it may stand in a line of a message.
#pragma once

#include <string>
#include <string_view>

namespace weft {

// The text on one line of valid UTF-8: control characters, line separators and marks that reverse
// the direction of writing become \n, \t, \r, \x1b, \u{2028} and so on; bytes that are not UTF-8
// become \xff. All other text is unchanged, backslashes included. At most four times as long.
std::string printable(std::string_view text);

// Whether all of the text is UTF-8: no overlong forms, surrogates or cut-off characters.
bool is_utf8(std::string_view text);

}  // namespace weft
