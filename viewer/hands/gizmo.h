// The handles about what is chosen: arrows move along the axes, rings turn about them, a square sizes.
#pragma once

#include <optional>

#include "hands/pick.h"

struct ImDrawList;

namespace weft::viewer {

struct Grip {
  enum class Kind { across, arrow, ring, square } kind = Kind::across;  // across: the thing itself
  std::size_t axis = 0;                                                 // of the arrow or the ring
};

// What of the handles there is, beside the arrows.
struct Handles {
  bool rings = true, square = true;
};

constexpr Vec3f kAxes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// The handle about `at` under a point of the window, if there is one.
std::optional<Grip> grip_under(const Camera& camera, const Area& area, Vec3f at, Handles handles,
                               float x, float y);
void draw_handles(const Camera& camera, const Area& area, Vec3f at, Handles handles,
                  ImDrawList& list);

}  // namespace weft::viewer
