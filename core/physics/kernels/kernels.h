// The kernels: everything that runs once per row of a lattice, built for each instruction set from
// one source (kernels.cmake) and chosen at run time. A kernel takes one plain struct of pointers and
// constants; it neither allocates nor knows which cloth it works on.
//
// Conventions: a row holds `columns` particles in component arrays; all arrays are 64-byte aligned
// at lane 0 and have at least 16 lanes of padding behind the last particle, which kernels may read
// and may overwrite with finite values of no meaning.
#pragma once

#include <cstddef>
#include <cstdint>

#include "weft/simulation.h"

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

// Constants of one spring stencil in one row: force on the near end = e (k - kl/|e|), e = far - near.
struct SpringConstants {
  float k = 0;        // stiffness [N/m]
  float kl = 0;       // stiffness times rest length [N]
  float damping = 0;  // along the spring [N·s/m]
  float taut = 0;     // 1 over the length past which it may tear [1/m]
};

// v <- drag v + kick (f/m + g), x <- x + dt v, pinned particles (inverse mass 0) unmoved.
struct Advance {
  float dt, kick;    // s; the same but after the substep's length has changed
  float drag;        // factor on the velocity
  float gx, gy, gz;  // velocity gained from gravity [m/s]
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
  // What earlier rows do to later ones, 6 floats for every lane of a row, zero before row 0. How they lie
  // is the kernel's own affair.
  float* carry;
};

// Forces, and the leapfrog step.
struct LeapfrogRows : PlainRows {
  // Inverse mass of the inner particles of rows begin … end-1; 0: there is more than columns to their
  // masses [1/kg].
  float alike;
  Advance advance;
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
  float inverse_dt;                  // > 0: the velocity gains the correction times it [1/s]
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
  Row3 u;          // corrections of row 0, which compliant constraints change in place of x
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
  const std::int32_t* alive;  // of row 0: -1 for constraints, 0 for torn ones; null: cannot tear
  float dt, inverse_dt;       // strain limit: the change of position goes into the velocity too
};

// A Gauss-Seidel sweep over rows begin … end-1, stencil by stencil, of one rule and dj: along the rows both
// colours, between rows those with j/dj % 2 == colour.
struct Projection {
  const ProjectRows* stencils;
  int count;
  int begin, end;
  int colour;
};

struct AdvanceRow {
  int columns;
  Row3 x, v;
  const float* w;
  Row3 f;  // force [N]; corrections [m]: predict first does as apply_corrections would, if given
  Row3 predicted;  // where predict took particles, if given; what velocity compares with
  Advance advance;
  // 1/s; predict: > 0 where velocities still lack how far free particles are from `predicted`, or the
  // corrections `f`, times this.
  float inverse_dt;
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

// How a surface lies to the particles of a row, now and before the substep, seen from the collider (contact/body).
struct FoundSurface {
  const float* distance;  // m
  ConstRow3 normal;
  const float* distance_before;
  ConstRow3 normal_before;
  ConstRow3 velocity{};  // m/s; of the nearest point, beside the collider's; null: of none
};

// Constants of a collider's shape, about its place (colliders/).
struct ShapeConstants {
  const FoundSurface* found = nullptr;  // of a mesh
  float radius = 0;                     // sphere, capsule; the box's rounding [m]
  float thin = 0;                       // half of the least thickness; infinite for the plane [m]
  float axis[3] = {0, 1, 0};            // plane: unit normal; capsule: from a to b [m]
  float inverse_square = 0;             // capsule: 1/|axis|² [1/m²]
  float half[3] = {};                   // box: half-sizes less the rounding [m]
  float turn[9] = {};                   // box: its axes as rows
};

// One collider and one row: particles below the surface are put onto it, with friction.
struct CollideRow {
  int columns;
  Row3 x, v;
  const float* w;
  float dt, inverse_dt;
  float cx, cy, cz;  // where the shape is at the end of the substep [m]
  float ux, uy, uz;  // velocity of the surface [m/s]
  float offset;      // kept off the surface [m]
  bool resolved;     // the mesh is fine enough for its features
  float friction_static, friction_dynamic;
  float bias;    // m, off the offset surface: within it sliding is damped
  float damped;  // by this share
  ShapeConstants shape;
};

// The triangles between a row and the next, and one collider. bound[a] becomes a lower bound of the
// distance from the offset surface to the two triangles between lanes a and a+1 [m].
struct FacesRow {
  CollideRow row;
  ConstRow3 x_next, v_next;
  float edge;          // m, longest of a flat triangle
  float slack;         // m; bounds above -slack need not be sharp
  float* bound[2];     // of the first and the second triangle of every square
  std::int32_t* room;  // two for each lane of a row, and 16 more
};

// How a row lies to a collider.
struct RowReach {
  float clearance;  // least distance of a free particle from the offset surface [m]
  float speed;      // greatest speed of a free particle, seen from the collider [m/s]
};

// Shapes and responses, in the order of weft::Shape and weft::FrictionModel.
inline constexpr int kShapes = std::variant_size_v<Shape>, kFrictionModels = 2;

// A collider's kernels: its own file in contact/colliders defines them by WEFT_COLLIDER (collide.h).
struct ColliderKernels {
  RowReach (*collide[kFrictionModels])(const CollideRow&);
  RowReach (*below_faces)(const FacesRow&);     // null of a mesh
  RowReach (*damp_sliding)(const CollideRow&);  // clearance from the layer of the bias
};

// A run of particles that follow each other.
struct Run {
  std::int32_t first, last;
};

struct WindRow;  // kernels/wind.h
struct PushRow;
struct MembraneRows;  // kernels/membrane.h
struct MembraneSquares;
struct LineBatch;  // kernels/line.h
struct BlockRows;  // kernels/contact.h
struct NearBoxes;
struct CellKeys;
struct NearSearch;
struct BesideFound;
struct BesidePairs;
struct NearFound;
struct BodyBlock;
struct MeetingPairs;
template <int N>
struct ContactPackets;
// What is done with packets of contacts, one after another (contact_packets.cpp).
template <int N>
struct ContactKernels {
  void (*prepare)(const ContactPackets<N>&);
  float (*sweep)(const ContactPackets<N>&);     // returns the greatest correction [m]
  float (*separate)(const ContactPackets<N>&);  // returns the greatest depth [of the distance held]
};
struct SquaresWithin;
struct SquaresApart;
struct SurfacePairs;  // kernels/surface.h
struct TearRow;       // kernels/tear.h
struct TearEdges;
struct MeshRow;  // kernels/mesh.h
struct MeshWind;
struct MeshForces;
struct RecordRow;  // kernels/mesh_sweep.h
struct EdgeSweep;
struct HingeSweep;
struct StrainSweep;
struct TransposeRows;
struct SecondOrderRow;  // kernels/second_order.h
struct TetherRow;
struct BendRow;  // kernels/bending.h
struct BendLine;
struct TwistRow;

struct KernelTable {
  void (*spring_rows)(const SpringRows&);
  void (*membrane_rows)(const MembraneRows&);
  void (*spring_stencil)(const StencilRow&);         // f += spring force
  void (*damped_spring_stencil)(const StencilRow&);  // f += spring force and damping along it
  int (*tear)(const TearRow&);                       // returns how many have ended
  bool (*tear_edges)(const TearEdges&);              // returns whether any is too long
  void (*integrate)(const AdvanceRow&);              // leapfrog step from f, then f <- 0
  void (*predict)(const AdvanceRow&);                // predicted <- x; v and x advanced by gravity
  void (*velocity)(const AdvanceRow&);               // v <- v + (x - predicted)/dt
  void (*project)(const Projection&);                // Gauss-Seidel, in place
  void (*jacobi_rows)(const JacobiRows&);
  // Jacobi: corrections of one row's constraints, by unit inverse mass, added to rows j and j+dj
  void (*jacobi_stencil)(const ProjectRows&, int row, Row3 sum, Row3 sum_far);
  void (*apply_corrections)(const AdvanceRow&);   // x += w f, v += w f inverse_dt, f <- 0 (no w: 1)
  void (*line_batch)(const LineBatch&);           // a batch of lines, each solved as a whole
  void (*membrane_line_batch)(const LineBatch&);  // of squared lengths
  void (*membrane_squares)(const MembraneSquares&);  // which these are to have
  void (*rows_to_lanes)(const TransposeRows&);
  void (*lanes_to_rows)(const TransposeRows&);
  void (*predict_second_order)(const SecondOrderRow&);
  void (*velocity_second_order)(const SecondOrderRow&);
  void (*tethers)(const TetherRow&);
  void (*bend_row)(const BendRow&);     // v += dt force/mass of the bending energy
  void (*bend_line)(const BendLine&);   // implicit bending along a batch of lines
  void (*bend_twist)(const TwistRow&);  // and of every second cell between two rows
  const ColliderKernels* collider[kShapes];
  void (*wind)(const WindRow&);
  void (*mesh_wind)(const MeshWind&);  // of triangles, added to the sums of their corners
  void (*push)(const PushRow&);
  void (*block_bounds)(const BlockRows&);  // how a block lies and moves
  void (*block_edges)(const BlockRows&);   // and its edges
  int (*near_boxes)(const NearBoxes&);     // returns how many are near
  void (*cell_keys)(const CellKeys&);
  NearFound (*near_pairs)(const NearSearch&);  // who is in range of whom
  BesideFound (*beside_pairs)(const BesidePairs&);
  void (*gather_bodies)(const BodyBlock&);
  int (*meeting_pairs)(const MeetingPairs&);    // returns how many
  int (*squares_within)(const SquaresWithin&);  // returns how many are
  int (*squares_not_apart)(const SquaresApart&);
  int (*surface_pairs)(const SurfacePairs&);  // returns how many contacts there are
  ContactKernels<2> contacts_of_two;
  ContactKernels<4> contacts_of_four;
  // The greatest size of `count` values, a multiple of 16; infinite if one is not a number.
  float (*greatest)(const float* values, std::ptrdiff_t count);
  EnergySum (*energy_sum)(const EnergyRow&);
  float (*greatest_square)(const FarRows&);     // of a constraint's length
  double (*stretch_energy)(const StretchRow&);  // J
  void (*tangent)(const TangentRow&);
  void (*mesh_load)(const MeshRow&);        // positions and velocities into records, forces <- 0
  void (*mesh_forces)(const MeshForces&);   // of triangles, added to the records of their corners
  void (*mesh_move)(const MeshRow&);        // leapfrog step from the forces of the records
  void (*load_records)(const RecordRow&);   // positions and inverse masses, corrections <- 0
  void (*store_records)(const RecordRow&);  // positions, and velocities, gain the corrections
  void (*sweep_edges)(const EdgeSweep&);
  void (*sweep_hinges)(const HingeSweep&);
  void (*sweep_strains)(const StrainSweep&);
};

// The kernels built for one instruction set (`best` is resolved by the caller).
const KernelTable& kernel_table(Simd simd);

}  // namespace weft::physics
