// Where a cloth starts: moved, turned and sized as a whole, with the paths of its pins.
#pragma once

#include "weft/scene.h"

namespace weft::viewer {

// The middle of the box along the axes that the cloth starts in; a mesh is read.
Vec3 middle_of(const Cloth& cloth);

Cloth moved(Cloth cloth, const Vec3& by);
// About a coordinate axis [0 … 2] through its middle [rad].
Cloth turned(Cloth cloth, std::size_t axis, double angle);
// All lengths times `factor`, about its middle. A sheet keeps its particles, which then are farther apart.
Cloth sized(Cloth cloth, double factor);

// Whether a cloth of one scene starts in another place, or larger, than the same of the other, with as many
// particles.
bool starts_elsewhere(const Scene& a, const Scene& b);

}  // namespace weft::viewer
