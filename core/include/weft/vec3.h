// A point or a direction.
#pragma once

#include <array>

namespace weft {

using Vec3 = std::array<double, 3>;

}  // namespace weft
