// Cloths and bodies as a person adds, copies, turns, sizes and takes them away: scenes from scenes.
#pragma once

#include "edit/document.h"

namespace weft::viewer {

enum class Kind { cloth, body };
// A cloth or a body by its number in the scene.
struct Part {
  Kind kind = Kind::body;
  std::size_t number = 0;
};

// A body of a shape about the origin, `size` [m] across, moved to `at`.
Scene with_body(Scene scene, const Shape& shape, const Vec3& at, double size);
// A level sheet about `at` of sides of `size` [m], of the first cloth's material.
Scene with_cloth(Scene scene, const Vec3& at, double size);
// A body, or a cloth of the first cloth's material, of a mesh that is read.
Scene with_mesh(Scene scene, Kind kind, const MeshSource& mesh);
// The part a second time, beside itself; the copy is the last of its kind.
Scene with_copy(Scene scene, const Part& part);
// Without the part. Pins that follow a body which is gone stay where they are.
Scene without(Scene scene, const Part& part);

// Turned about a coordinate axis [0 … 2] through its place [rad]. A sphere stays as it is.
Shape turned(Shape shape, std::size_t axis, double angle);
// All lengths times `factor`, about its place. A plane stays as it is.
Shape sized(Shape shape, double factor);
// Whether turning and sizing do anything.
bool can_turn(const Shape& shape);
bool can_size(const Shape& shape);

}  // namespace weft::viewer
