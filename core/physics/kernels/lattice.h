// Kernels on the rows of a lattice and its stencils.
#pragma once

#include "physics/kernels/particles.h"

namespace weft::physics {

// Constants of one spring stencil in one row: force on the near end = e (k - kl/|e|), e = far - near.
struct SpringConstants {
  float k = 0;        // stiffness [N/m]
  float kl = 0;       // stiffness times rest length [N]
  float damping = 0;  // along the spring [N·s/m]
  float taut = 0;     // 1 over the length past which it may tear [1/m]
};

// The six stencils of a plain cloth at once for rows begin … end-1 (kernels/plain_rows.h). Row j is
// finished, and what its constraints do to rows j+1 and j+2 is carried to those; calls for successive
// ranges of rows carry on from each other. The component arrays of x and v lie equally far apart, and
// those of the carries.
inline constexpr int kPlainStencils = 6;
struct PlainRows {
  int begin, end, rows;
  int columns, stride;
  Row3 x, v;       // row 0
  const float* w;  // inverse mass of row 0 [1/kg]
  bool sides;      // whether the columns at both sides stand for half of an inner one
  // Width of cloth that each column stands for, of an inner one's, and its reciprocal: constraints along a
  // column have the one of their stiffness, particles the other of an inner one's inverse mass.
  const float *width, *inverse_width;
  // Of row 0 of each stencil: -1 in the lanes of constraints, 0 in those of torn ones. Null: cannot
  // tear.
  const std::int32_t* alive[kPlainStencils];
  // What earlier rows do to later ones, up to 7 floats for every lane of a row, zero before row 0. How they lie
  // is the kernel's own affair.
  float* carry;
};

// Forces, and the leapfrog step.
struct LeapfrogRows : PlainRows {
  // Inverse mass of the inner particles of rows begin … end-1; 0: there is more than columns to their
  // masses [1/kg].
  float alike;
  Advance advance;
  Left left{};  // of row 0
};

struct SpringRows : LeapfrogRows {
  // Six for each row: (1,0) (0,1) (1,1) (-1,1) (2,0) (0,2); zero where row j+dj does not exist.
  const SpringConstants* constants;
  bool damped;  // whether springs have damping
  // Of every row: set to 1 where a spring that is not torn is past its tear length at the start; null:
  // nobody asks.
  std::uint8_t* overlong;
};

// One stencil's constraints of one row in a Jacobi sweep.
struct JacobiConstants {
  float compliance = 0;  // 1/(k dt²) [1/kg], infinite where there is no constraint
  float k = 0, kl = 0;   // κ [kg] and κ times rest length [kg·m] between particles of one mass
  float one_side = 1, both_sides = 1;  // factors on κ where ends lie in columns of half the width
};

// A Jacobi sweep: the corrections of all constraints, added up.
struct JacobiRows : PlainRows {
  float alike;                       // as of springs, of rows begin … end+1
  const JacobiConstants* constants;  // six for each row, as the springs
  float rest[kPlainStencils];        // m
  float weight;                      // of w_a + w_b: 1/relaxation
  float inverse_dt;                  // velocities gain corrections times it [1/s]
  Left left{};                       // of row 0
};

// One stencil between row j and row j+dj: constraint a joins lane a+near of row j and lane a+far of
// the other row, 0 <= a < count. For dj = 0 both rows are the same and near = 0.
struct StencilRow {
  int count;
  int near, far;
  bool same_row;
  Row3 x, x_far;
  Row3 v, v_far;  // velocities (springs with damping; sweeps that keep velocity consistent)
  const float* w;
  const float* w_far;
  Row3 f, f_far;   // accumulated force or correction of both rows
  float* scratch;  // 3 rows of `stride` floats, zero in the 16 lanes before each (same_row only)
  int stride;
  SpringConstants spring;
  const float* factor;  // on each constraint's spring; null: all 1
  std::int32_t*
      alive;  // -1 in the lanes of constraints, 0 in those of torn ones; null: cannot tear
};

// What a sweep of a strain limit does: shortens at once what is too long; or, where the limit is to hold, one
// of three: `carry` pulls by the forces of the substep before, `hold` corrects these forces, `settle` moves
// positions alone.
enum class LimitSweep { none, once, carry, hold, settle };

// One stencil of projected constraints. Which of the optional parts are given picks the rule: a strain
// limit, compliance with multipliers, compliance alone, or rigid constraints. The component arrays of x,
// v and u lie equally far apart.
struct ProjectRows {
  int rows;
  int stride;
  Row3 x, v;       // row 0; v is used by strain limits alone
  Row3 u;          // corrections of row 0, which all but strain limits change in place of x
  const float* w;  // inverse mass of row 0 [1/kg]
  // Of the inner particles of each row, 0 where there is more than columns to their masses; or null.
  const float* row_w;
  int count;  // constraints in a row: a joins lane a+near of row j and lane a+far of row j+dj
  int near, far, dj;
  // Whether ends at the sides weigh half. Where constraints lie along columns, those at the sides have more
  // compliance instead: factors on it, or null.
  bool side_by_side;
  const float* inverse_width;
  const std::int32_t* lanes;  // along rows: -1 in the lanes of a colour, 0 elsewhere; both colours
  float rest;                 // m; a strain limit's greatest length, or the one that forces hold,
  float most;                 // and then the greatest [m];
  float strongest;            // a force that lasts to the next substep [N]
  float weight;               // of w_a + w_b (1/(2 positional_k), 1/Jacobi's relaxation)
  const float* compliance;    // 1/(k dt²) of every row [1/kg], or null
  float* lambda;              // multipliers of row 0 [kg·m], strain limit: forces [N]; or null
  LimitSweep limit;           // one-sided: nothing happens below the rest length
  std::int32_t* alive;        // of row 0: -1 for constraints, 0 for torn ones; null: cannot tear
  // m, squared, past which a constraint ends where the sweep finds it; 0: the sweep ends none. And how many ended,
  // added up by row.
  float longest_square;
  std::int32_t* ended;
  float dt, inverse_dt;  // strain limit: the change of position goes into the velocity too
};

// A Gauss-Seidel sweep over rows begin … end-1, stencil by stencil, of one rule and dj: along the rows both
// colours, between rows those with j/dj % 2 == colour.
struct Projection {
  const ProjectRows* stencils;
  int count;
  int begin, end;
  int colour;
};

// The constraints of one stencil and row: ends next to each other, and which are left.
struct FarRows {
  int count;
  ConstRow3 near, far;
  const std::int32_t* alive;      // -1 or 0 each; null: all
  const float* factor = nullptr;  // on the stiffness of each; null: all 1
};

// What such constraints hold: Σ ½ κ (||e| - l| + slack)², κ the lesser of their stiffness and a share
// of what takes a violation back in one substep, 1/((w_a + w_b) dt²).
struct StretchRow : FarRows {
  const float *w_near, *w_far;  // inverse masses of their ends [1/kg]; both 0: counts nothing
  float rest, slack;            // m
  float stiffness, share;       // N/m, 1; either may be infinite
  float inverse_dt2;            // 1/s²
  float give;  // m; what is beyond it is taken back in one substep besides; infinite: no limit
};

// Springs as they lie, and a small displacement u of their ends: what they pull by, S u with
//
//   S = Σ k [n nᵀ + t (I - n nᵀ)],   t = max(0, 1 - l/|e|), or none without `sideways`
//
// is added to `pull`, laid out as u; of the near end as it is, of the far end in the other direction.
struct TangentRow : FarRows {
  ConstRow3 u_near, u_far;
  Row3 pull_near, pull_far;
  float rest;       // m
  float stiffness;  // k
  bool sideways;
};

struct MembraneRows;  // kernels/membrane.h
struct MembraneSquares;
struct MembraneSweep;
struct TearRow;  // kernels/tear.h
struct BendRow;  // kernels/bending.h
struct BendLine;
struct TwistRow;
struct WindRow;  // kernels/wind.h

// spring_stencil: f += spring force; damped_spring_stencil: and damping along it. project: Gauss-Seidel, in place.
// jacobi_stencil: corrections of one row's constraints, by unit inverse mass, added to rows j and j+dj.
// membrane_squares: squared lengths that lines of a membrane are to have. sweep_membrane: Gauss-Seidel over its cells,
// in place. bend_row: v += dt force/mass of the
// bending energy; bend_line: implicit bending along a batch of lines; bend_twist: of every second cell between two
// rows. tear: returns how many have ended. greatest_square: of a constraint's length [m²]. stretch_energy [J].
#define WEFT_LATTICE_KERNELS(KERNEL)                                                  \
  KERNEL(void, spring_rows, (const SpringRows&))                                      \
  KERNEL(void, membrane_rows, (const MembraneRows&))                                  \
  KERNEL(void, spring_stencil, (const StencilRow&))                                   \
  KERNEL(void, damped_spring_stencil, (const StencilRow&))                            \
  KERNEL(void, project, (const Projection&))                                          \
  KERNEL(void, jacobi_rows, (const JacobiRows&))                                      \
  KERNEL(void, jacobi_stencil, (const ProjectRows&, int row, Row3 sum, Row3 sum_far)) \
  KERNEL(void, membrane_squares, (const MembraneSquares&))                            \
  KERNEL(void, sweep_membrane, (const MembraneSweep&))                                \
  KERNEL(void, bend_row, (const BendRow&))                                            \
  KERNEL(void, bend_line, (const BendLine&))                                          \
  KERNEL(void, bend_twist, (const TwistRow&))                                         \
  KERNEL(int, tear, (const TearRow&))                                                 \
  KERNEL(void, wind, (const WindRow&))                                                \
  KERNEL(float, greatest_square, (const FarRows&))                                    \
  KERNEL(double, stretch_energy, (const StretchRow&))                                 \
  KERNEL(void, tangent, (const TangentRow&))

struct LatticeKernels {
  WEFT_LATTICE_KERNELS(WEFT_KERNEL_MEMBER)
};

}  // namespace weft::physics
