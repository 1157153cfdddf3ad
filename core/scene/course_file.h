// Course files as students write them: with keys of their own, several bodies, pins that repeat. What is
// meant is taken out in the form that the course's schema knows; what has no meaning is left out and told.
#pragma once

#include <string>
#include <vector>

#include "scene/json_text.h"

namespace weft::text {

// A body besides the one sphere and the one plane of the course: an element of a list ("sphere": [ … ],
// "spheres") or of a number ("sphere0").
struct CourseBody {
  std::string kind;   // "sphere" or "plane"
  std::string place;  // in the file
  Json document;      // a course document with this body alone
};

struct CourseFile {
  Json document;  // at most one sphere and one plane
  std::vector<CourseBody> more;
  std::vector<std::string> notes;
};

// Takes apart what was read from a file.
CourseFile take_apart(Json document);

// Places of the pins that name a particle first, in their order; a pin that is malformed counts as one.
std::vector<std::size_t> first_pins(const Json& document);

}  // namespace weft::text
