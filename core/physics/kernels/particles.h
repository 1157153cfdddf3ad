// Kernels on particles alone, whatever holds them together.
#pragma once

#include "physics/kernels/kernel_list.h"
#include "physics/kernels/rows.h"

namespace weft::physics {

// v <- drag v + kick (f/m + g), x <- x + dt v, pinned particles (inverse mass 0) unmoved.
struct Advance {
  float dt, kick;    // s; the same but after the substep's length has changed
  float drag;        // factor on the velocity
  float gx, gy, gz;  // velocity gained from gravity [m/s]
  float lost = 0;    // of the velocity, by drag: what the factor takes away
};

struct AdvanceRow {
  int columns;
  Row3 x, v;
  const float* w;
  Row3 f;  // force [N]; corrections [m]: predict first does as apply_corrections would, if given
  Advance advance;
  float inverse_dt;  // 1/s; what velocities gain is the corrections `f` times this
  Left left{};
};

// One row, and what a frame is judged by: the energies of its free particles, ½ Σ m v² and -Σ m g·x,
// and the greatest size of a coordinate; infinite if one is not a number.
struct EnergyRow {
  int columns;
  ConstRow3 x, v;
  const float* w;  // inverse mass [1/kg]
  double g[3];     // m/s²
};

struct EnergySum {
  double kinetic = 0, potential = 0;  // J
  float greatest = 0;                 // m
};

struct SecondOrderRow;  // kernels/second_order.h
struct TetherRow;
struct PushRow;  // kernels/wind.h

// integrate: leapfrog step from f, then f <- 0. predict: v and x advanced by gravity. apply_corrections: x += w f, v += w f inverse_dt, f <- 0 (no w: 1). greatest: the
// greatest size of `count` values, a multiple of 16; infinite if one is not a number.
#define WEFT_PARTICLE_KERNELS(KERNEL)                                  \
  KERNEL(void, integrate, (const AdvanceRow&))                         \
  KERNEL(void, predict, (const AdvanceRow&))                           \
  KERNEL(void, apply_corrections, (const AdvanceRow&))                 \
  KERNEL(void, predict_second_order, (const SecondOrderRow&))          \
  KERNEL(void, velocity_second_order, (const SecondOrderRow&))         \
  KERNEL(void, tethers, (const TetherRow&))                            \
  KERNEL(void, push, (const PushRow&))                                 \
  KERNEL(float, greatest, (const float* values, std::ptrdiff_t count)) \
  KERNEL(EnergySum, energy_sum, (const EnergyRow&))

struct ParticleKernels {
  WEFT_PARTICLE_KERNELS(WEFT_KERNEL_MEMBER)
};

}  // namespace weft::physics
