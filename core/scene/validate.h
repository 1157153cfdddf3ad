// What no single value of a scene can tell: whether its values fit together.
#pragma once

#include "scene/schema.h"
#include "weft/scene.h"

namespace weft::text {

// Adds the faults between values to those found by the schema. Values at unsound places are left
// alone.
void check_together(const Scene& scene, Check& result);

}  // namespace weft::text
