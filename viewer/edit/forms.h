// The forms that a value of the scene may have: one number or several apart, a vector or its keys over time.
#pragma once

#include <string>

#include "scene/json_text.h"

namespace weft::viewer {

// What a person calls one of a schema's alternatives: "one value", "constant", "over time", or the names of
// its members.
std::string name_of_form(const text::Json& form);

// The value in another form, as far as it says the same: one number becomes every member of that kind, a vector
// its only key; the first of several stays.
text::Json in_form(const text::Json& value, const text::Json& from, const text::Json& to);

}  // namespace weft::viewer
