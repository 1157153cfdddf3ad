// The distances at which contact holds things apart.
#pragma once

#include "physics/contact/self/blocks.h"

namespace weft::physics {

// Thicknesses: layers of a stack sink in a little.
inline constexpr float kHeld = 1.02f;

// Of the distance held: pairs that end an interval nearer than that, unhindered, may touch once others push
// them, and so are contacts.
inline constexpr float kReach = 1.03f;

// Of the distance held: surfaces do not come nearer than that, whatever presses them.
inline constexpr float kLeastApart = 0.02f;

// m
inline float held(const Sheet& sheet) {
  return sheet.thickness * kHeld;
}

}  // namespace weft::physics
