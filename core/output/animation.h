// The animation formats, one file each.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>

#include "weft/output.h"

namespace weft {

std::unique_ptr<Animation> open_pc2(const std::string& path, const View& first);
std::unique_ptr<Animation> open_obj_sequence(const std::string& path, const View& first);

}  // namespace weft
