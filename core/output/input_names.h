// The names of inputs in recordings.
#pragma once

#include <array>

namespace weft {

// In the order of Input::Kind.
inline constexpr std::array<const char*, 8> kInputNames{
    "grab", "release", "pin", "unpin", "carry", "cut", "move_collider", "set_scene"};

}  // namespace weft
