// What documents can say of meshes in forms that no Scene holds.
#pragma once

#include "scene/schema.h"

namespace weft::text {

// Adds a fault for each mesh that names no file, which a Scene takes for none, and for each pin of a mesh that has a
// column and a row, which a Scene takes for a number.
void check_forms(const Json& document, Check& result);

}  // namespace weft::text
