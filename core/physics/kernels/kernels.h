// The kernels: everything that runs once per row of a lattice, built for each instruction set from
// one source (kernels.cmake) and chosen at run time. A kernel takes one plain struct of pointers and
// constants; it neither allocates nor knows which cloth it works on.
//
// Conventions: a row holds `columns` particles in component arrays; all arrays are 64-byte aligned
// at lane 0 and have at least 16 lanes of padding behind the last particle, which kernels may read
// and may overwrite with values of no meaning.
#pragma once

#include <cstdint>

#include "weft/simulation.h"

namespace weft::physics {

// Component arrays of one row.
struct Row3 {
  float* x;
  float* y;
  float* z;
};

struct ConstRow3 {
  const float* x;
  const float* y;
  const float* z;
  ConstRow3() = default;
  ConstRow3(const float* ax, const float* ay, const float* az) : x(ax), y(ay), z(az) {}
  ConstRow3(Row3 r) : x(r.x), y(r.y), z(r.z) {}
};

// Constants of one spring family in one row: force on the near end = e (k - kl/|e|), e = far - near.
struct SpringConstants {
  float k = 0;        // stiffness [N/m]
  float kl = 0;       // stiffness times rest length [N]
  float damping = 0;  // along the spring [N·s/m]
};

// v <- drag v + dt (f/m + g), x <- x + dt v, pinned particles (inverse mass 0) unmoved.
struct Advance {
  float dt;              // s
  float drag;            // factor on the velocity
  float gx, gy, gz;      // velocity gained from gravity in one substep [m/s]
};

// The six families of a plain cloth at once, and the leapfrog step. Row j is finished, the forces it
// exerts on rows j+1 and j+2 are carried to the calls for those.
struct SpringRow {
  int columns;
  Row3 x, v;             // row j
  const float* w;        // inverse mass of row j [1/kg]
  ConstRow3 below, below2;  // rows j+1 and j+2 (any row where there is none, with k = 0)
  Row3 carry;            // in: force row j-1 exerted on row j, negated; out: row j on row j+1
  Row3 carry2;           // the same from row j-2, to row j+2
  SpringConstants right, right2, down, down2, diagonal, antidiagonal;  // (1,0) (2,0) (0,1) (0,2) (1,1) (-1,1)
  Advance advance;
};

// One family between row j and row j+dj: constraint a joins lane a+near of row j and lane a+far of
// the other row, 0 <= a < count. For dj = 0 both rows are the same and near = 0.
struct FamilyRow {
  int count;
  int near, far;
  bool same_row;
  Row3 x, x_far;
  Row3 v, v_far;      // velocities (springs with damping; sweeps that keep velocity consistent)
  const float* w;
  const float* w_far;
  Row3 f, f_far;      // accumulated force or correction of both rows
  float* scratch;     // 3 rows of `stride` floats, zero in the 16 lanes before each (same_row only)
  int stride;
  SpringConstants spring;
};

// Constants of a projected family: C = |e| - rest, Δλ = -(C + compliance λ)/(w_a + w_b + compliance).
struct ProjectRow {
  FamilyRow rows;
  const std::int32_t* lanes;  // same_row: -1 in the lanes of this colour, 0 elsewhere
  float rest;                 // m
  float compliance;           // 1/(k dt²) [1/kg]; 0 = rigid
  float share;                // factor on the correction (2 positional_k, Jacobi's relaxation)
  float* lambda;              // multipliers of this row, null for a single sweep [kg·m]
  float limit;                // > 0: one-sided, nothing happens below this length [m]
  float inverse_dt;           // > 0: add the change of position over dt to the velocity
};

struct AdvanceRow {
  int columns;
  Row3 x, v;
  const float* w;
  Row3 f;         // force [N], negated never; unused by predict
  Row3 previous;  // predict: receives the positions before
  Advance advance;
  float inverse_dt;
};

// Constants of a collider's shape, about its place (colliders/).
struct ShapeConstants {
  float radius = 0;           // sphere, capsule; the box's rounding [m]
  float thin = 0;             // half of the least thickness; infinite for the plane [m]
  float axis[3] = {0, 1, 0};  // plane: unit normal; capsule: from a to b [m]
  float inverse_square = 0;   // capsule: 1/|axis|² [1/m²]
  float half[3] = {};         // box: half-sizes less the rounding [m]
  float turn[9] = {};         // box: its axes as rows
};

// One collider and one row: particles below the surface are put onto it, with friction.
struct CollideRow {
  int columns;
  Row3 x, v;
  const float* w;
  float dt, inverse_dt;
  float cx, cy, cz;        // where the shape is at the end of the substep [m]
  float ux, uy, uz;        // velocity of the surface [m/s]
  float offset;            // kept off the surface [m]
  float friction_static, friction_dynamic;
  ShapeConstants shape;
};

// The triangles between a row and the next, and one collider. bound[a] becomes a lower bound of the
// distance from the offset surface to the two triangles between lanes a and a+1 [m].
struct FacesRow {
  CollideRow row;
  ConstRow3 x_next, v_next;
  float* bound;
};

// How a row lies to a collider.
struct RowReach {
  float clearance;  // least distance of a free particle from the offset surface [m]
  float speed;      // greatest speed of a free particle, seen from the collider [m/s]
};

// Shapes and responses, in the order of weft::Shape and weft::FrictionModel.
inline constexpr int kShapes = 4, kFrictionModels = 2;

struct KernelTable {
  void (*spring_row)(const SpringRow&);
  void (*spring_family)(const FamilyRow&);          // f += spring force
  void (*damped_spring_family)(const FamilyRow&);   // f += spring force and damping along it
  void (*integrate)(const AdvanceRow&);             // leapfrog step from f, then f <- 0
  void (*predict)(const AdvanceRow&);               // previous <- x, v and x advanced by gravity
  void (*velocity)(const AdvanceRow&);              // v <- (x - previous)/dt
  void (*project)(const ProjectRow&);               // Gauss-Seidel: one family, one colour, in place
  void (*project_jacobi)(const ProjectRow&);        // Jacobi: corrections added up in f
  void (*apply_corrections)(const AdvanceRow&);     // x += f, f <- 0
  RowReach (*collide[kShapes][kFrictionModels])(const CollideRow&);
  RowReach (*below_faces[kShapes])(const FacesRow&);
};

// The kernels built for one instruction set (`best` is resolved by the caller).
const KernelTable& kernel_table(Simd simd);

}  // namespace weft::physics
