// Overrides: single values of a document, replaced by JSON pointer before it is checked.
#pragma once

#include <string>
#include <vector>

#include "scene/json_text.h"
#include "scene/schema.h"
#include "weft/read_scene.h"

namespace weft::text {

// The tokens of a JSON pointer, unescaped; false when it is none or names the whole document.
bool split_pointer(const std::string& pointer, std::vector<std::string>& tokens);

// Replaces the value, filling in what is missing on the way with the schema's defaults.
void apply_override(const Json& schema, const Override& change, Json& document, Check& result);

}  // namespace weft::text
