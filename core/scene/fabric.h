// The key `fabric` of a cloth: a name that stands for values.
#pragma once

#include "scene/json_text.h"
#include "scene/schema.h"

namespace weft::text {

// Writes into each cloth of a scene's document that names a fabric the values that it stands for (weft/fabric.h), where
// the cloth does not give its own: `density`, `membrane`, unless the cloth has `stiffness`, `spring_damping` or `level`,
// `bending`, and `friction` of `self_collision`, each key by itself. With method positional `stiffness` takes the
// membrane's place. A fabric that gives nothing is a fault. Faults of form are left to the schema: any JSON is accepted.
void unfold_fabrics(Json& document, Check& result);

}  // namespace weft::text
