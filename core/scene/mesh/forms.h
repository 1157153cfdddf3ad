// What documents can say of meshes in forms that no Scene holds.
#pragma once

#include "scene/schema.h"

namespace weft::text {

// Adds a fault for each mesh that names no file, which a Scene takes for none, or whose shape at rest is "", which it
// takes for the mesh's own, and for each pin of a mesh that has a column and a row, which it takes for a number.
void check_forms(const Json& document, Check& result);

}  // namespace weft::text
