// What the kernels of the wind work on (kernels/wind.cpp).
#pragma once

#include "physics/kernels/rows.h"

namespace weft::physics {

// Gusts: each component of the wind gains three waves, of phase k·x + at.
inline constexpr int kGusts = 9;  // 3 for each component
struct Gust {
  float kx, ky, kz;  // 1/m
  float at;          // phase at x = 0, in turns
};

// What air does to each particle of a row, added up over its triangles: forces [N], and how they
// resist, A/3 drag (u·n) and A/3 lift |u| [kg/s].
struct AirRow {
  Row3 f;
  float *drag, *lift;
};

// The air at a time, and how it acts on cloth.
struct Air {
  float wx, wy, wz;  // m/s
  float drag, lift;  // kg/m³
  float gust_speed;  // m/s; 0: none
  Gust gusts[kGusts];
};

// Air on the triangles between a row and the next.
struct WindRow : Air {
  int columns;
  ConstRow3 x, x_next, v, v_next;
  AirRow air, air_next;
};

// Moves a row by what air has done to it, and starts its sums anew.
struct PushRow {
  int columns;
  Row3 x, v;
  const float* w;
  AirRow air;
  float time;     // s, that the air pushes for
  float resists;  // s, that what is gained resists it for
  float dt;       // s; how far positions follow the velocity that is gained
  bool
      at_end;  // drag is that of the velocity after the push; else as in the exact motion of a plate
};

}  // namespace weft::physics
