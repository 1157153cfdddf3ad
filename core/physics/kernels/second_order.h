// What the kernels of the second-order substep and of the tethers work on
// (kernels/second_order.cpp, kernels/tethers.cpp).
#pragma once

#include "physics/kernels/rows.h"

namespace weft::physics {

// One row of particles with the state of one substep before.
struct SecondOrderRow {
  int columns;
  Row3 x, v;
  Row3 previous;  // x of the substep before; receives x [m]
  Row3 v_before;  // v of the substep before; receives v [m/s]
  Row3 u;        // corrections, which x and v lack, then zero [m]; or null: sweeps have put them in
  bool v_waits;  // predict: x and v lack them still
  Row3 v_end;    // v as the substep before left it [m/s]
  Row3 left;     // what x lacks by rounding [m]; null, as v_left: is left aside
  Row3 v_left;   // and v [m/s]
  float* w;      // inverse mass, scaled while the constraints are solved [1/kg]
  const float* mass;  // inverse mass proper [1/kg]
  bool fresh;         // nothing is known of the substep before; then v does not wait
  float dt;           // s
  float drag;         // 1/s
  float gx, gy, gz;   // m/s²
};

// The most tethers a particle has.
inline constexpr int kTethers = 4;

// One row of particles and its tethers, which hold one after the other, before any other constraint.
struct TetherRow {
  int columns;
  ConstRow3 x;
  Row3 u;     // receives corrections where there are some; zero before [m]
  int count;  // of tethers that a particle may have
  struct Tether {
    ConstRow3 pin;       // where each particle's pin is [m]
    const float* reach;  // how far the particle may be from it [m]
  } tethers[kTethers];
};

}  // namespace weft::physics
