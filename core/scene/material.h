// Whether what a cloth is made of fits together.
#pragma once

#include "scene/schema.h"
#include "weft/scene.h"

namespace weft::text {

// Adds the faults of a cloth's membrane and bending. `place`: of the cloth.
void check_material(const Scene& scene, const Cloth& cloth, const std::string& place,
                    Check& result);

}  // namespace weft::text
