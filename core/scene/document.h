// Scene <-> its Weft document.
#pragma once

#include "scene/json_text.h"
#include "weft/scene.h"

namespace weft::text {

// Reads what is well-formed; check the document against the schema for the rest.
Scene scene_of(const Json& document);

// Every value of the scene, defaults included.
Json document_of(Scene scene);

// Leaves out what equals its default in the schema.
void drop_defaults(const Json& schema, Json& value);

}  // namespace weft::text
