// Course scenes: what the course's files mean as a Scene.
#pragma once

#include <string>

#include "scene/course_file.h"
#include "weft/scene.h"

namespace weft::text {

// Whether a document is a course scene by its keys.
bool is_course(const Json& document);

// The scene that a course file means; reads what is well-formed. A particle that is pinned twice is held
// once.
Scene scene_of_course(const CourseFile& file);

// Places of a course file and of the scene that it means: each of the file's, the more special first.
class CoursePlaces {
 public:
  explicit CoursePlaces(const CourseFile& file);
  std::string in_scene(const std::string& place) const;
  std::string in_file(const std::string& place) const;
  std::size_t repeated_pins() const { return repeated_; }

 private:
  std::vector<std::pair<std::string, std::string>> pairs_;
  std::vector<std::size_t> pins_;  // by their number in the scene; empty: the same numbers
  std::size_t repeated_ = 0;
};

}  // namespace weft::text
