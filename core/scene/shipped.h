// The folder of the shipped scenes.
#pragma once

#include <string>

namespace weft::text {

// The file of a shipped scene, "" when there is none of that name.
std::string shipped_path(const std::string& name);

}  // namespace weft::text
