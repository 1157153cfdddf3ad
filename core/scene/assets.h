// What the build puts inside the library (core/assets.cmake): the schemas, and where scenes lie.
#pragma once

#include <string_view>

namespace weft::text {

extern const std::string_view kSceneSchema;      // docs/scene.schema.json
extern const std::string_view kCourseSchema;     // docs/course.schema.json
extern const std::string_view kInstalledScenes;  // folder of the shipped scenes once installed
extern const std::string_view kSourceScenes;     // the same in the source tree

}  // namespace weft::text
