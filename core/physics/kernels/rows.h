// Rows of particles, as all kernels see them.
//
// A row holds `columns` particles in component arrays; all arrays are 64-byte aligned at lane 0 and have at least
// 16 lanes of padding behind the last particle, which kernels may read and may overwrite with finite values of no
// meaning.
#pragma once

#include <cstddef>
#include <cstdint>

namespace weft::physics {

// Component arrays of one row.
struct Row3 {
  float* x;
  float* y;
  float* z;
  Row3 from(int i) const { return {x + i, y + i, z + i}; }  // particle i on
};

struct ConstRow3 {
  const float* x;
  const float* y;
  const float* z;
  ConstRow3() = default;
  ConstRow3(const float* ax, const float* ay, const float* az) : x(ax), y(ay), z(az) {}
  ConstRow3(Row3 r) : x(r.x), y(r.y), z(r.z) {}
  ConstRow3 from(int i) const { return {x + i, y + i, z + i}; }  // particle i on
};

// What positions [m] and velocities [m/s] lack by rounding, which goes into their next steps; null: is left aside.
struct Left {
  Row3 x, v;
};

// Where particles were before the substep: there, or else x - dt v, with x and v as they are before the sweeps. Row 0.
struct SubstepStart {
  ConstRow3 previous, v;
  float dt;
};

// A run of particles that follow each other.
struct Run {
  std::int32_t first, last;
};

}  // namespace weft::physics
