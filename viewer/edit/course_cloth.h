// The course's parameters by its own names, as they stand in a scene, and put back into one.
#pragma once

#include "edit/document.h"

namespace weft::viewer {

struct CourseCloth {
  double ks = 5000;       // N/m, of structural and shearing springs; bending springs have a fifth
  double density = 15;    // g/cm²
  double damping = 0.2;   // % of the velocity, in each of the 2700 steps of a second
  double gravity = -9.8;  // m/s², upward
  double thickness = 0.0095;  // m, half of the distance that layers keep
  bool structural = true, shearing = true, bending = true;  // which springs there are
  friend bool operator==(const CourseCloth&, const CourseCloth&) = default;
};

// Whether a scene is of a course file, or was: one sheet of springs with the course's first step.
bool is_course_cloth(const Scene& scene);

CourseCloth course_cloth_of(const Scene& scene);

// The scene with other parameters.
Scene with(Scene scene, const CourseCloth& wanted);

}  // namespace weft::viewer
