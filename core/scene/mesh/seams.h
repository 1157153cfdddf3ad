// Which vertices of a mesh seams join.
#pragma once

#include "scene/schema.h"
#include "weft/scene.h"

namespace weft::text {

// Adds a fault for each seam of a cloth that cannot be. `place`: of the cloth.
void check_seams(const Cloth& cloth, const std::string& place, Check& result);

}  // namespace weft::text
