// Colours as scenes have them.
#pragma once

#include <optional>
#include <string>

namespace weft::viewer {

// A swatch that opens a picker. `shown` is "#rrggbb"; returns another that is chosen.
std::optional<std::string> pick_color(const std::string& label, const std::string& shown);

}  // namespace weft::viewer
