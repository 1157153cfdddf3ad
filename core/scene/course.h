// Course scenes: what the course's files mean as a Scene.
#pragma once

#include <string>
#include <vector>

#include "scene/json_text.h"
#include "weft/scene.h"

namespace weft::text {

// Whether a document is a course scene by its keys.
bool is_course(const Json& document);

// The scene that a course document means; reads what is well-formed.
Scene scene_of_course(const Json& document);

// Places of a course document as places of its scene, and back.
std::string scene_place(const Json& document, const std::string& course_place);
std::string course_place(const Json& document, const std::string& scene_place);

}  // namespace weft::text
