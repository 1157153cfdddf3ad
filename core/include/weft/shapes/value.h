// What the shapes of colliders are made of. A shape is a struct of values with
//
//   static void values(Self& self, Visit&& visit)    calls visit(key, value, ShapeValue) for each of them, under
//                                                    its key in scene files
//   double half_thickness() const                    of the shape where it is thinnest, of one with a tip the
//                                                    radius of the largest ball within [m]; infinite for one
//                                                    without bounds
//   static Self of_size(double size)                 about the origin, `size` [m] across, as an editor adds it
//
// From these alone a shape is read and written, checked, moved, turned, sized and drawn at random. What else is
// asked of it is in its own file in core/physics/contact/colliders.
#pragma once

#include "weft/vec3.h"

namespace weft {

// What a value is to its shape.
enum class ShapeValue {
  place,      // Vec3 [m]; the point that a collider's keys move; named before other points
  point,      // Vec3 [m]; comes along with the place, and is at least 1e-6 m from it
  direction,  // Vec3, at least 1e-6 long; turns with the shape
  angles,     // Vec3 [degrees], about x, then y, then z; the shape is turned by them
  length,     // double or Vec3 [m]; grows with the shape
  radius,     // double [m]; a length, and the surface is round by it in all directions
  rounding,   // double [m]; a length, at most half_thickness()
};

}  // namespace weft
