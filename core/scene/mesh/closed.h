// Whether a mesh encloses a gas.
#pragma once

#include "scene/schema.h"
#include "weft/scene.h"

namespace weft::text {

// Adds a fault for what keeps a cloth with pressure from holding a gas. `place`: of the cloth.
void check_pressure(const Cloth& cloth, const std::string& place, Check& result);

}  // namespace weft::text
