// Shared by the kernel sources: wide loads of a row, the leapfrog move, and the declarations that
// table.cpp collects.
#pragma once

#include "physics/kernels/kernels.h"
#include "physics/kernels/wide.h"

namespace weft::WEFT_KERNELS {

using physics::Advance;
using physics::AdvanceRow;
using physics::CollideRow;
using physics::ConstRow3;
using physics::FacesRow;
using physics::FamilyRow;
using physics::ProjectRow;
using physics::Row3;
using physics::RowReach;
using physics::SpringConstants;
using physics::SpringRow;

WEFT_INLINE Wide3 load3(ConstRow3 r, int i) { return {load(r.x + i), load(r.y + i), load(r.z + i)}; }
WEFT_INLINE void store3(Row3 r, int i, Wide3 v) {
  store(r.x + i, v.x);
  store(r.y + i, v.y);
  store(r.z + i, v.z);
}

// Rows are worked through in whole groups of 16 lanes at every width, so that lanes past the end see
// the same operations whatever the instruction set.
WEFT_INLINE int padded(int count) { return (count + 15) & ~15; }

// v <- c v + dt (f/m + g), x <- x + dt v; a pinned particle's inverse mass of 0 keeps it in place.
WEFT_INLINE void move(Row3 x, Row3 v, const float* inverse_mass, Wide3 f, const Advance& a, int i) {
  const Wide w = load(inverse_mass + i);
  const WideInt free = w > 0.0f;
  const Wide w_dt = w * a.dt;
  const Wide3 gained{select(free, wide(a.gx), Wide{}), select(free, wide(a.gy), Wide{}),
                     select(free, wide(a.gz), Wide{})};
  const Wide3 velocity = load3(v, i) * wide(a.drag) + (f * w_dt + gained);
  store3(v, i, velocity);
  store3(x, i, load3(x, i) + velocity * wide(a.dt));
}

void spring_row(const SpringRow&);
void spring_family(const FamilyRow&);
void damped_spring_family(const FamilyRow&);
void integrate(const AdvanceRow&);
void predict(const AdvanceRow&);
void velocity(const AdvanceRow&);
void project(const ProjectRow&);
void project_jacobi(const ProjectRow&);
void apply_corrections(const AdvanceRow&);

// A collider's kernels: its own file in colliders/ defines them by WEFT_COLLIDER (collide.h).
struct ColliderKernels {
  RowReach (*collide[physics::kFrictionModels])(const CollideRow&);
  RowReach (*below_faces)(const FacesRow&);
};
extern const ColliderKernels kSphere, kPlane, kCapsule, kBox;

}  // namespace weft::WEFT_KERNELS
