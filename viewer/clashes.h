// Files that the command line names twice.
#pragma once

#include <string>

#include "command_line.h"

namespace weft::viewer {

// Throws Failure where two outputs would go to one file, or one would overwrite what is read or
// printed. `scene`: the file that the scene is read from.
void refuse_clashes(const Arguments& arguments, const std::string& scene);

}  // namespace weft::viewer
