// Shared by the kernel sources: wide loads of a row, the leapfrog move, and the declarations that
// table.cpp collects.
#pragma once

#include <cstddef>

#include "physics/kernels/kernels.h"
#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

using physics::Advance;
using physics::AdvanceRow;
using physics::CollideRow;
using physics::ConstRow3;
using physics::FacesRow;
using physics::ProjectRows;
using physics::Row3;
using physics::RowReach;
using physics::SpringConstants;
using physics::SpringRows;
using physics::StencilRow;

WEFT_INLINE Wide3 load3(ConstRow3 r, std::ptrdiff_t i) {
  return {load(r.x + i), load(r.y + i), load(r.z + i)};
}
WEFT_INLINE void store3(Row3 r, std::ptrdiff_t i, Wide3 v) {
  store(r.x + i, v.x);
  store(r.y + i, v.y);
  store(r.z + i, v.z);
}

// Components whose arrays lie `plane` floats apart, from that of x on.
WEFT_INLINE Wide3 load_planes(const float* x, std::ptrdiff_t plane) {
  return {load(x), load(x + plane), load(x + 2 * plane)};
}
WEFT_INLINE void store_planes(float* x, std::ptrdiff_t plane, Wide3 v) {
  store(x, v.x);
  store(x + plane, v.y);
  store(x + 2 * plane, v.z);
}

// Delay3<N> for any N up to 16 known only at run time: through a buffer that holds the lanes before.
class LongDelay3 {
 public:
  explicit LongDelay3(int lanes) : lanes_(lanes) {}
  WEFT_INLINE Wide3 next(Wide3 block) {
    store3({x_ + 16, y_ + 16, z_ + 16}, 0, block);
    const Wide3 delayed = load3(ConstRow3(x_, y_, z_), 16 - lanes_);
    for (int i = 0; i < 16; ++i) {
      x_[i] = x_[i + kLanes];
      y_[i] = y_[i + kLanes];
      z_[i] = z_[i + kLanes];
    }
    return delayed;
  }

 private:
  int lanes_;
  alignas(64) float x_[32] = {}, y_[32] = {}, z_[32] = {};
};

// Rows are worked through in whole groups of 16 lanes at every width, so that lanes past the end see
// the same operations whatever the instruction set.
WEFT_INLINE int padded(int count) {
  return (count + 15) & ~15;
}

// c v + kick (f/m + g); nothing is added where the inverse mass w is 0, that of a pinned particle.
WEFT_INLINE Wide3 moved(Wide3 v, Wide w, Wide3 f, const Advance& a) {
  const WideInt free = w > 0.0f;
  const Wide3 g = select(free, wide3(a.gx, a.gy, a.gz), Wide3{});
  return fma(f, w * a.kick, fma(v, wide(a.drag), g));
}
// The same where all particles are free; `gain`: w kick.
WEFT_INLINE Wide3 moved_free(Wide3 v, Wide gain, Wide3 f, const Advance& a) {
  return fma(f, gain, fma(v, wide(a.drag), wide3(a.gx, a.gy, a.gz)));
}

// v <- c v + kick (f/m + g), x <- x + dt v.
WEFT_INLINE void move(Row3 x, Row3 v, const float* inverse_mass, Wide3 f, const Advance& a,
                      std::ptrdiff_t i) {
  const Wide3 velocity = moved(load3(v, i), load(inverse_mass + i), f, a);
  store3(v, i, velocity);
  store3(x, i, fma(velocity, wide(a.dt), load3(x, i)));
}

// Moves the block at `x` in the positions of a sheet's rows, of whose row `left` columns are left from its
// first lane on. kSides: columns at the sides stand for half of an inner one; kAlike: all that the rows
// hold is free, and of one mass but for that.
template <bool kSides, bool kAlike>
WEFT_INLINE void leapfrog(const physics::LeapfrogRows& r, float* x, int left, Wide3 force) {
  const std::ptrdiff_t lane = x - r.x.x, plane = r.x.y - r.x.x;
  const Wide3 before = load_planes(r.v.x + lane, plane);
  Wide3 velocity;
  if constexpr (kAlike) {
    Wide gain = wide(r.alike * r.advance.kick);
    if constexpr (kSides) gain = gain * load(r.inverse_width + (r.columns - left));
    velocity = moved_free(before, gain, force, r.advance);
    velocity = select(lanes_below(left), velocity, Wide3{});
  } else {
    velocity = moved(before, load(r.w + lane), force, r.advance);
  }
  store_planes(r.v.x + lane, plane, velocity);
  store_planes(x, plane, fma(velocity, wide(r.advance.dt), load_planes(x, plane)));
}

void spring_rows(const SpringRows&);
void membrane_rows(const physics::MembraneRows&);
void spring_stencil(const StencilRow&);
void damped_spring_stencil(const StencilRow&);
int tear(const physics::TearRow&);
bool tear_edges(const physics::TearEdges&);
void integrate(const AdvanceRow&);
void predict(const AdvanceRow&);
void velocity(const AdvanceRow&);
void project(const physics::Projection&);
void jacobi_rows(const physics::JacobiRows&);
void jacobi_stencil(const ProjectRows&, int row, Row3 sum, Row3 sum_far);
void apply_corrections(const AdvanceRow&);
void line_batch(const physics::LineBatch&);
void membrane_line_batch(const physics::LineBatch&);
void membrane_squares(const physics::MembraneSquares&);
void rows_to_lanes(const physics::TransposeRows&);
void lanes_to_rows(const physics::TransposeRows&);
void predict_second_order(const physics::SecondOrderRow&);
void velocity_second_order(const physics::SecondOrderRow&);
void tethers(const physics::TetherRow&);
void bend_row(const physics::BendRow&);
void bend_line(const physics::BendLine&);
void bend_twist(const physics::TwistRow&);

float greatest(const float* values, std::ptrdiff_t count);
physics::EnergySum energy_sum(const physics::EnergyRow&);
float greatest_square(const physics::FarRows&);
double stretch_energy(const physics::StretchRow&);
void tangent(const physics::TangentRow&);
void mesh_load(const physics::MeshRow&);
void mesh_forces(const physics::MeshForces&);
void mesh_move(const physics::MeshRow&);
void load_records(const physics::RecordRow&);
void store_records(const physics::RecordRow&);
void sweep_edges(const physics::EdgeSweep&);
void sweep_hinges(const physics::HingeSweep&);
void sweep_strains(const physics::StrainSweep&);
void wind(const physics::WindRow&);
void mesh_wind(const physics::MeshWind&);
void push(const physics::PushRow&);
void block_bounds(const physics::BlockRows&);
void block_edges(const physics::BlockRows&);
int near_boxes(const physics::NearBoxes&);
void cell_keys(const physics::CellKeys&);
physics::NearFound near_pairs(const physics::NearSearch&);
physics::BesideFound beside_pairs(const physics::BesidePairs&);
void gather_bodies(const physics::BodyBlock&);
int meeting_pairs(const physics::MeetingPairs&);
int squares_within(const physics::SquaresWithin&);
int squares_not_apart(const physics::SquaresApart&);
int surface_pairs(const physics::SurfacePairs&);
extern const physics::ContactKernels<2> kContactsOfTwo;
extern const physics::ContactKernels<4> kContactsOfFour;

#define WEFT_KERNELS_OF_SHAPE(Type, name) extern const physics::ColliderKernels k##Type;
WEFT_SHAPES(WEFT_KERNELS_OF_SHAPE)
#undef WEFT_KERNELS_OF_SHAPE

}  // namespace weft::WEFT_KERNELS
